// SPDX-License-Identifier: MIT
// `embody serve` on a model database of real furniture, as a user has it.
import { spawn, spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../../", import.meta.url));
const CATALOGUES = "/usr/share/sweethome3d/furniture";

/** The program: $EMBODY_PROGRAM, or the newest of the build folders. */
export function findProgram() {
  if (process.env.EMBODY_PROGRAM) return process.env.EMBODY_PROGRAM;
  const builds = existsSync(join(root, "build")) ? readdirSync(join(root, "build")) : [];
  const programs = ["build", ...builds.map((build) => join("build", build))]
    .flatMap((build) => [join(root, build, "embody"), join(root, build, "src", "embody")])
    .filter((program) => existsSync(program) && statSync(program).isFile());
  return programs.sort((a, b) => statSync(b).mtimeMs - statSync(a).mtimeMs)[0] ?? null;
}

/**
 * The file of a database with the furniture catalogues: $EMBODY_TEST_DATABASE unchanged, or one in the build folder that the
 * first run fills. An import continues where it stopped, so later runs take little time.
 */
export function prepareDatabase(program) {
  if (process.env.EMBODY_TEST_DATABASE) return process.env.EMBODY_TEST_DATABASE;
  const folder = join(root, "build", "studio-test");
  const file = join(folder, "models.sqlite");
  mkdirSync(folder, { recursive: true });
  const catalogues = existsSync(CATALOGUES) ? readdirSync(CATALOGUES).map((name) => join(CATALOGUES, name)) : [];
  if (catalogues.length === 0) throw new Error("no furniture catalogues: install the package sweethome3d-furniture");
  const done = spawnSync(program, ["import", "--database", file, ...catalogues], { encoding: "utf8" });
  // Single models may be unreadable; only the database must exist.
  if (!existsSync(file)) throw new Error(`embody import failed: ${done.stderr || done.stdout}`);
  return file;
}

/** A running server with a home folder of its own. */
export class RealServer {
  constructor(program, database) {
    this.program = program;
    this.home = mkdtempSync(join(tmpdir(), "embody-studio-"));
    // Tests import and change models, so they work on a copy, including the write-ahead log.
    this.database = join(this.home, "models.sqlite");
    for (const suffix of ["", "-wal"]) if (existsSync(database + suffix)) copyFileSync(database + suffix, this.database + suffix);
  }

  /** Starts the server with a scene (the document itself) and more words; resolves with its address. A second start uses the same port. */
  async start(scene, more = []) {
    const file = join(this.home, "first.json");
    writeFileSync(file, JSON.stringify(scene));
    const words = ["serve", "--database", this.database, "--port", String(this.port ?? 0), "--scene", file, ...more];
    this.process = spawn(this.program, words, { env: { ...process.env, XDG_DATA_HOME: this.home } });
    let output = "";
    const address = await new Promise((resolve, reject) => {
      const read = (data) => {
        output += data;
        const printed = /^Studio: (http:\S+)/m.exec(output);
        if (printed) resolve(printed[1]);
      };
      this.process.stdout.on("data", read);
      this.process.stderr.on("data", read);
      this.process.on("error", reject);
      this.process.on("exit", (code) => reject(new Error(`embody serve ended with ${code}: ${output}`)));
    });
    this.port = Number(new URL(address).port);
    return address;
  }

  async stop() {
    if (!this.process || this.process.exitCode !== null) return;
    const ended = new Promise((resolve) => this.process.once("exit", resolve));
    this.process.kill("SIGTERM");
    await ended;
  }

  async discard() {
    await this.stop();
    rmSync(this.home, { recursive: true, force: true });
  }
}
