// SPDX-License-Identifier: MIT
// Reads the texts out of the Studio's sources: the keys of t(), and literals where a user would see them.
import { createRequire } from "node:module";
import { readdirSync, readFileSync } from "node:fs";
import { join, relative } from "node:path";
import { fileURLToPath } from "node:url";

const STUDIO = fileURLToPath(new URL("../../studio", import.meta.url));
export const SOURCES = join(STUDIO, "src");
const ts = createRequire(join(STUDIO, "package.json"))("typescript");

/** Attributes that a user sees or a screen reader says. */
const VISIBLE_ATTRIBUTES = new Set(["title", "aria-label", "placeholder", "alt", "aria-description", "aria-valuetext"]);
/** Fields of objects that are shown: actions, notices, menus, choices. */
const VISIBLE_FIELDS = new Set([...VISIBLE_ATTRIBUTES, "label", "text", "remedy", "help", "note", "group", "short"]);
/** Functions with the places of the arguments that they show. */
const SHOWING = new Map(Object.entries({
  setText: [1], row: [0, 2], labelled: [0, 2], numberField: [0], textField: [0, 2], truthField: [0], wordField: [0],
  openDialog: [0], openTextDialog: [0], cell: [1], foldingGroup: [2], legendLine: [1], section: [0], list: [0, 2],
}));
/** What is the same in every language: names, units, file names, commands. */
const SAME = /^(Embody|embody serve [-\w .]*|[xyzXYZ]+|[XYZABWSDQE](, [XYZAB])*|\d.*|[a-z]*\/[a-z²³]+|kg|lm|rad|Pa|mm?|Ctrl\+\w|Space|Esc|\(Space\)|– Embody Studio)$/;

function sourceFiles(folder = SOURCES) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    return entry.isDirectory() ? sourceFiles(path) : path.endsWith(".ts") ? [path] : [];
  });
}

function parse(path) {
  return ts.createSourceFile(path, readFileSync(path, "utf8"), ts.ScriptTarget.Latest, true);
}

function placeOf(node) {
  const source = node.getSourceFile();
  return `${relative(SOURCES, source.fileName)}:${source.getLineAndCharacterOfPosition(node.getStart()).line + 1}`;
}

function isText(node) {
  return ts.isStringLiteral(node) || ts.isNoSubstitutionTemplateLiteral(node);
}

function isCall(node, name) {
  return ts.isCallExpression(node) && node.expression.getText() === name;
}

/** Fields of the object that is the second argument of t(). */
function fieldsOf(call) {
  const [, values] = call.arguments;
  if (!values || !ts.isObjectLiteralExpression(values)) return new Map();
  return new Map(values.properties.map((each) => [each.name.getText(), each.initializer ?? null]));
}

/** All uses of t(): `{ text, key, hasCount, fields, where }`; `faults` are calls whose text is no literal. */
export function usesOfT() {
  const uses = [];
  const faults = [];
  const visit = (node) => {
    if (isCall(node, "t") && !node.getSourceFile().fileName.includes("/language/")) {
      const [text] = node.arguments;
      if (!isText(text)) faults.push(`${placeOf(node)}: the text of t() has to be a literal`);
      else {
        const fields = fieldsOf(node);
        const context = fields.get("context");
        uses.push({ text: text.text, key: context ? `${text.text}_${context.text}` : text.text, hasCount: fields.has("count"), fields: [...fields.keys()], where: placeOf(node) });
      }
    }
    ts.forEachChild(node, visit);
  };
  for (const path of sourceFiles()) visit(parse(path));
  return { uses, faults };
}

/** Names of the placeholders of a text. */
export function placeholders(text) {
  return [...text.matchAll(/\{\{(\w+)(?:, number)?\}\}/g)].map(([, name]) => name);
}

function hasWords(text) {
  return /\p{L}{2}/u.test(text) && !SAME.test(text.trim());
}

/** Literals below a node that would be shown as they are: not those inside of t() or of other calls. */
function shownLiterals(node) {
  if (isText(node)) return hasWords(node.text) ? [node] : [];
  if (ts.isTemplateExpression(node)) {
    const fixed = [node.head, ...node.templateSpans.map(({ literal }) => literal)].some(({ text }) => hasWords(text));
    return [...(fixed ? [node] : []), ...node.templateSpans.flatMap(({ expression }) => shownLiterals(expression))];
  }
  if (ts.isConditionalExpression(node)) return [...shownLiterals(node.whenTrue), ...shownLiterals(node.whenFalse)];
  if (ts.isParenthesizedExpression(node) || ts.isSpreadElement(node)) return shownLiterals(node.expression);
  if (ts.isArrayLiteralExpression(node)) return node.elements.flatMap(shownLiterals);
  if (ts.isBinaryExpression(node) && ["??", "||", "&&", "+"].includes(node.operatorToken.getText()))
    return node.operatorToken.getText() === "&&" ? shownLiterals(node.right) : [...shownLiterals(node.left), ...shownLiterals(node.right)];
  return [];
}

function literalsAt(node) {
  if (ts.isCallExpression(node)) {
    const name = node.expression.getText().replace(/^this\./, "");
    if (name === "element") {
      const isCode = node.arguments[0]?.text === "code";
      return isCode ? [] : node.arguments.slice(2).flatMap(shownLiterals);
    }
    if (name.endsWith(".setAttribute") && VISIBLE_ATTRIBUTES.has(node.arguments[0]?.text)) return shownLiterals(node.arguments[1]);
    return (SHOWING.get(name) ?? []).flatMap((at) => (node.arguments[at] ? shownLiterals(node.arguments[at]) : []));
  }
  if (ts.isPropertyAssignment(node)) {
    const name = node.name.text ?? node.name.getText();
    return VISIBLE_FIELDS.has(name) ? shownLiterals(node.initializer) : [];
  }
  if (ts.isBinaryExpression(node) && node.operatorToken.getText() === "=" && /\.(textContent|title|placeholder|innerText)$/.test(node.left.getText())) return shownLiterals(node.right);
  return [];
}

/** Texts that stand where a user sees them without going through t(). */
export function untranslated() {
  const found = [];
  const visit = (node) => {
    if (ts.isImportDeclaration(node) || ts.isTypeNode(node)) return;
    for (const literal of literalsAt(node)) found.push(`${placeOf(literal)}: ${literal.getText()}`);
    ts.forEachChild(node, visit);
  };
  for (const path of sourceFiles()) if (!/\/(language|connection)\/|test_hook|icons/.test(path)) visit(parse(path));
  return [...new Set(found)];
}
