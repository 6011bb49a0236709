// SPDX-License-Identifier: MIT
// The texts of the Studio and its dictionaries: nothing is missing, nothing is left over. No browser.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, it } from "node:test";
import { fileURLToPath } from "node:url";
import { placeholders, SOURCES, untranslated, usesOfT } from "./language_sources.mjs";

const ROOT = fileURLToPath(new URL("../../", import.meta.url));
const readJson = (path) => JSON.parse(readFileSync(path, "utf8"));
const dictionary = (name) => readJson(join(SOURCES, "language", `${name}.json`));
const sorted = (list) => [...list].sort();

function filesBelow(folder, ends) {
  return readdirSync(join(ROOT, folder), { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    return entry.isDirectory() ? filesBelow(path, ends) : ends.some((end) => path.endsWith(end)) ? [path] : [];
  });
}

/** C++ joins string literals that follow each other. */
const joined = (text) => text.replaceAll(/"\s*\n\s*"/g, "").replaceAll('\\"', '"');
const readCpp = (path) => joined(readFileSync(join(ROOT, path), "utf8"));

/** Names of all categories, subcategories and materials of the taxonomy. */
function taxonomyNames() {
  const folder = join(ROOT, "data/taxonomy");
  const files = readdirSync(join(folder, "categories")).map((name) => readJson(join(folder, "categories", name)));
  const categories = files.flatMap((file) => (Array.isArray(file) ? file : file.categories));
  const names = categories.flatMap(({ name, subcategories = [] }) => [name, ...subcategories.map((each) => each.name)]);
  return { categories: new Set(names), materials: readJson(join(folder, "materials.json")).materials.map(({ name }) => name.replaceAll("_", " ")) };
}

/** Labels, helps and groups of the attributes' registry. */
function registryTexts() {
  const source = readCpp("src/attributes/registry_table.cpp");
  const rows = [...source.matchAll(/\{"\w+",\s*(?:all_kinds|"[A-Z]+"),\s*"([^"]*)",\s*"((?:[^"\\]|"[^",]*"[^",])*?)"\}/g)];
  const groups = [...source.matchAll(/Group \w+\{rows, "\w+", "([^"]+)"\}/g)].map(([, group]) => group);
  return { labels: rows.map(([, label]) => label), helps: rows.map(([, , help]) => help), groups };
}

describe("the Studio's texts", () => {
  const { uses, faults } = usesOfT();
  const zh = dictionary("zh");
  const en = dictionary("en");

  it("gives t() literals, with a value for each placeholder", () => {
    assert.deepEqual(faults, []);
    const wrong = uses.filter(({ text, fields }) => {
      const given = fields.filter((name) => name !== "context" && name !== "count");
      return sorted(new Set(placeholders(text))).filter((name) => name !== "count").join() !== sorted(given).join();
    });
    assert.deepEqual(wrong.map(({ where, text }) => `${where}: ${text}`), []);
  });

  it("shows no English literal without t()", () => assert.deepEqual(untranslated(), []));

  it("has each text in Chinese, and no Chinese text that nobody uses", () => {
    const needed = new Map(uses.map((use) => [use.hasCount ? `${use.key}_other` : use.key, use.where]));
    assert.deepEqual([...needed].filter(([key]) => !(key in zh)).map(([key, where]) => `${where}: ${key}`), [], "without a Chinese text");
    assert.deepEqual(Object.keys(zh).filter((key) => !needed.has(key)), [], "not used any more");
  });

  it("has both English forms of each text with a number, and no others", () => {
    const needed = new Set(uses.filter(({ hasCount }) => hasCount).flatMap(({ key }) => [`${key}_one`, `${key}_other`]));
    assert.deepEqual(sorted(Object.keys(en)), sorted(needed));
  });

  it("keeps the placeholders in the translations", () => {
    const different = ([key, text]) => sorted(new Set(placeholders(key))).join() !== sorted(new Set(placeholders(text))).join();
    const all = [zh, dictionary("zh_server"), dictionary("zh_categories")].flatMap((each) => Object.entries(each));
    assert.deepEqual(all.filter(different), []);
    const lost = Object.entries(en).filter(([key, text]) => placeholders(key).some((name) => name !== "count" && !placeholders(text).includes(name)));
    assert.deepEqual(lost, []);
  });

  it("has Chinese in the Chinese texts", () => {
    const same = Object.entries({ ...zh, ...dictionary("zh_server"), ...dictionary("zh_categories") }).filter(([, text]) => !/[\p{Script=Han}。、，；：／/（–]/u.test(text));
    // An empty form and names that everybody writes so.
    assert.deepEqual(same.map(([, text]) => text).filter((text) => !["SUV", "studio {{client}}"].includes(text)), []);
  });
});

describe("the server's texts in Chinese", () => {
  const server = dictionary("zh_server");
  const categories = dictionary("zh_categories");
  const known = (text) => text in server || text in categories;

  it("covers labels, helps and groups of all attributes", () => {
    const { labels, helps, groups } = registryTexts();
    assert.ok(labels.length > 70 && groups.length >= 10, "the registry was read");
    assert.deepEqual([...labels, ...helps, ...groups].filter((text) => !known(text)), []);
  });

  it("covers categories and materials, and nothing that is no category", () => {
    const names = taxonomyNames();
    assert.deepEqual([...names.categories, ...names.materials].filter((name) => !known(name)), []);
    assert.deepEqual(Object.keys(categories).filter((name) => !names.categories.has(name)), []);
  });

  it("covers titles and descriptions of the examples", () => {
    const scenes = filesBelow("data/scenes", [".json"]).map((path) => readJson(join(ROOT, path)));
    assert.deepEqual(scenes.flatMap(({ title, description }) => [title, description]).filter((text) => !known(text)), []);
  });

  it("has only texts that the sources still have", () => {
    const sources = [...filesBelow("src", [".cpp", ".h"]).map(readCpp), ...filesBelow("data/scenes", [".json"]).map(readCpp), ...filesBelow("data/taxonomy", [".json"]).map(readCpp), ...filesBelow("studio/src", [".ts"]).map(readCpp)].join("\n");
    // Labels are made of names: friction_static is shown as "friction static", "wood" as "Wood".
    const isThere = (text) => [text, text.toLowerCase().replaceAll(" ", "_"), text.toLowerCase()].some((form) => sources.includes(form));
    // A sentence may be put together of several literals.
    const isMade = (text, parts) => {
      if (text === "" || isThere(text)) return true;
      if (parts === 1) return false;
      const ends = [...text.matchAll(/(?<!^)\b|(?<= )/g)].map(({ index }) => index).reverse();
      return ends.some((end) => isThere(text.slice(0, end)) && isMade(text.slice(end), parts - 1));
    };
    const kinds = "What the thing is for physics: ";
    const gone = Object.keys(server).filter((key) => !key.startsWith(kinds) && !key.split(/\{\{\w+\}\}/).every((piece) => isMade(piece.trim(), 4)));
    assert.deepEqual(gone, []);
  });
});
