// A stand-in for the server of `pc live`, for work on the page: it answers as PROTOCOL.md says, by the commands of a program
// `pc` for each request, or, without one, by what a page of `pc report` contains.
//
//     node mock/server.js MODEL [--port N] [--pc PROGRAM] [--page REPORT.html] [--token T] [--delay MS]
import { execFile } from "node:child_process";
import { randomBytes } from "node:crypto";
import { createServer } from "node:http";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { parseArgs } from "node:util";
import { plots } from "./plots.js";
import { starts } from "./starts.js";

const { values: options, positionals } = parseArgs({
  allowPositionals: true,
  options: { port: { type: "string", default: "8420" }, pc: { type: "string" }, page: { type: "string" }, token: { type: "string" }, delay: { type: "string", default: "0" } },
});
const given = positionals[0] ?? "tilted-disk";
const TOKEN = options.token ?? randomBytes(16).toString("hex");
const HERE = new URL("../", import.meta.url);
const REPORT = new URL("../../pc-report/", HERE);
const FORMS = [
  ["", "that of the text"], ["poincare", "Poincaré"], ["canonical", "canonical"], ["lagrange", "Lagrange"], ["voronets", "Voronets"],
  ["reduced", "reduced"], ["lie-poisson", "Lie–Poisson"], ["orthonormal", "orthonormal"], ["maggi", "Maggi"], ["kane", "Kane"],
  ["gibbs-appell", "Gibbs–Appell"],
];

// Runs the program with the text as its input; the caller's signal ends it.
function pc(args, text, signal) {
  return new Promise((done) => {
    const child = execFile(options.pc, args, { signal, maxBuffer: 1 << 28, encoding: "buffer" }, (error, out, err) => {
      done({ code: error ? (error.code ?? 1) : 0, out, err: err.toString() });
    });
    child.stdin.on("error", () => {});
    child.on("error", () => {});
    child.stdin.end(text);
  });
}

// `pc: <stdin>:20:4: message`, the line, a line of ^, and perhaps `help: …`.
function diagnostics(err) {
  const list = [];
  for (const line of err.split("\n")) {
    const head = /^(?:pc|warning)?:? ?<stdin>:(\d+):(\d+): (.*)$/.exec(line);
    if (head) {
      list.push({ line: Number(head[1]), column: Number(head[2]), length: 1, message: head[3], severity: "error" });
    } else if (list.length > 0 && /^\s+\^+\s*$/.test(line)) {
      list.at(-1).length = line.trim().length;
    } else if (list.length > 0 && /^\s+help: /.test(line)) {
      list.at(-1).help = line.trim().slice(6);
    }
  }
  const other = /^pc: (?!<stdin>)(.*)/m.exec(err);
  return list.length === 0 && other ? [{ line: 1, column: 1, length: 1, message: other[1], severity: "error" }] : list;
}

const between = (page, id) => new RegExp(`<section id="${id}"[^>]*>\\s*<h2[^>]*>.*?</h2>([^]*?)</section>`).exec(page)?.[1] ?? "";
const script = (page, id) => JSON.parse(new RegExp(`id="${id}">([^]*?)</script>`).exec(page)?.[1] ?? "null");

const settings = (set = {}) => Object.entries(set).flatMap(([name, value]) => ["--set", `${name}=${value}`]);

// The equations of one form: those under its heading.
const HEADINGS = { poincare: "Poincaré&#39;s equations", canonical: "Canonical equations", lagrange: "Lagrange", voronets: "Voronets", reduced: "Poincaré&#39;s equations, reduced", "lie-poisson": "Canonical equations, reduced", orthonormal: "orthonormal", maggi: "Maggi", kane: "Kane", "gibbs-appell": "Gibbs" };
function ofForm(html, form) {
  const parts = html.split(/(?=<h3>)/).filter((part) => part.startsWith("<h3>"));
  const title = HEADINGS[form || "poincare"];
  const exact = parts.find((part) => part.startsWith(`<h3>${title}</h3>`));
  return exact ?? parts.find((part) => part.slice(0, 200).includes(title)) ?? `<p class="soft">The page of the mock has no equations in this form.</p>`;
}

async function* motionOf({ text, set, t_end: end }, signal) {
  const more = [...settings(set), ...(end ? ["--t-end", String(end)] : [])];
  const [page, table] = await Promise.all([
    pc(["animate", "-", ...more, "--samples", "301"], text, signal),
    pc(["run", "-", ...more, "--samples", "301", "--no-verify"], text, signal),
  ]);
  if (signal.aborted) {
    return;
  }
  if (table.code !== 0) {
    yield { kind: "diagnostics", list: diagnostics(table.err) };
    return;
  }
  yield { kind: "scene", data: page.code === 0 ? script(page.out.toString(), "player-data") : null };
  const rows = table.out.toString();
  const charts = plots(rows);
  yield { kind: "plots", data: charts };
  yield { kind: "summary", name: table.err.split("\n")[0], text: table.err.trim(), t_end: Number(rows.trim().split("\n").at(-1).split(",")[0]) };
}

async function* computed(job, signal) {
  const check = await pc(["check", "-", "--format", "json", ...settings(job.set)], job.text, signal);
  if (signal.aborted) {
    return;
  }
  yield { kind: "diagnostics", list: check.code === 0 ? [] : diagnostics(check.err) };
  if (check.code === 3) {
    return;
  }
  yield { kind: "names", ...starts(job.text) };
  yield* motionOf(job, signal);
  // Of the text as it was given, a page may be newer than the program.
  const isGiven = options.page && job.text === first && Object.keys(job.set).length === 0;
  const report = isGiven ? { code: 0, out: asset(options.page) } : await pc(["report", "-", "--no-run", ...settings(job.set)], job.text, signal);
  if (report.code === 0) {
    const page = report.out.toString();
    yield { kind: "equations", html: ofForm(between(page, "equations"), job.form) };
    yield { kind: "verdicts", html: between(page, "verdicts") };
  }
}

// What a page contains, whatever the text is.
async function* canned(job, isMotion) {
  const page = readFileSync(options.page, "utf8");
  if (!isMotion) {
    yield { kind: "diagnostics", list: [] };
    yield { kind: "names", ...starts(job.text) };
  }
  yield { kind: "scene", data: script(page, "player-data") };
  yield { kind: "plots", data: script(page, "plots-data") };
  if (!isMotion) {
    yield { kind: "equations", html: ofForm(between(page, "equations"), job.form) };
    yield { kind: "verdicts", html: between(page, "verdicts") };
  }
}

async function stream(job, response, isMotion) {
  const control = new AbortController();
  response.on("close", () => control.abort());
  response.writeHead(200, { "content-type": "application/x-ndjson", "cache-control": "no-store" });
  const start = performance.now();
  await sleep(Number(options.delay));
  const results = !options.pc ? canned(job, isMotion) : isMotion ? motionOf(job, control.signal) : computed(job, control.signal);
  for await (const result of results) {
    if (control.signal.aborted) {
      return;
    }
    response.write(`${JSON.stringify(result)}\n`);
  }
  response.end(`${JSON.stringify({ kind: "done", milliseconds: Math.round(performance.now() - start) })}\n`);
}

const form = (job) => (job.form ? ["--form", job.form] : []);
const end = (job) => (job.t_end ? ["--t-end", String(job.t_end)] : []);
const FILES = {
  report: (job) => ["html", ["report", "-", ...settings(job.set), ...end(job)]],
  animate: (job) => ["html", ["animate", "-", ...settings(job.set), ...end(job)]],
  csv: (job) => ["csv", ["run", "-", ...settings(job.set), ...end(job)]],
  latex: (job) => ["tex", ["derive", "-", ...settings(job.set), ...form(job), "--format", "latex"]],
  rust: (job) => ["rs", ["emit", "-", ...settings(job.set), "--lang", "rust", "-o", "-"]],
  png: (job) => ["png", ["animate", "-", ...settings(job.set), ...end(job), ...(job.at ? ["--at", job.at] : [])], true],
  sweep: (job) => ["csv", ["sweep", "-", ...settings(job.set), "--vary", job.vary, ...end(job)], true],
};

async function exported(job, response) {
  if (!(job.what in FILES) || !options.pc) {
    return refuse(response, 501, `The mock writes no ${job.what}.`);
  }
  const [ending, args, isWritten] = FILES[job.what](job);
  const folder = mkdtempSync(join(tmpdir(), "pc-live-"));
  const path = join(folder, `result.${ending}`);
  const result = await pc(isWritten ? [...args, "-o", path] : args, job.text);
  const file = isWritten && existsSync(path) ? readFileSync(path) : result.out;
  rmSync(folder, { recursive: true });
  if (result.code !== 0) {
    return refuse(response, 422, result.err);
  }
  response.writeHead(200, { "content-type": "application/octet-stream", "content-disposition": `attachment; filename*=UTF-8''${encodeURIComponent(`${model}.${ending}`)}` });
  response.end(file);
}

function refuse(response, status, message) {
  response.writeHead(status, { "content-type": "text/plain; charset=utf-8" });
  response.end(message);
}

const isFile = existsSync(given);
const model = basename(given).replace(/\.toml$/, "");
let known = isFile ? readFileSync(given, "utf8") : (await pc(["models", given], "")).out.toString();
const first = known;

function save({ text, force }, response) {
  if (!force && readFileSync(given, "utf8") !== known) {
    return refuse(response, 409, `${basename(given)} has changed on disk since it was read.`);
  }
  writeFileSync(given, text);
  known = text;
  response.writeHead(204).end();
}

const asset = (path) => readFileSync(path, "utf8");
const inScript = (value) => JSON.stringify(value).replace(/</g, "\\u003c").replace(/>/g, "\\u003e").replace(/&/g, "\\u0026");
const styles = () => {
  // The font of formulas is embedded by the build of pc-report; a page of it has it.
  const font = options.page ? (/@font-face[^}]*}/.exec(asset(options.page))?.[0] ?? "") : "";
  const own = ["src/page/style.css", "src/page/formulas.css", "plots/dist/plots.css", "src/page/viewer.css"].map((path) => asset(new URL(path, REPORT)));
  return [font, ...own, asset(new URL("live.css", HERE))].join("\n");
};

function page(response) {
  const nonce = randomBytes(16).toString("base64");
  const parts = {
    title: model, nonce, style: styles(),
    data: inScript({ model: isFile ? basename(given) : given, file: isFile ? basename(given) : null, text: known, forms: FORMS }),
    viewer: asset(new URL("viewer/dist/viewer.js", REPORT)), plots: asset(new URL("plots/dist/plots.js", REPORT)), live: asset(new URL("dist/live.js", HERE)),
  };
  response.writeHead(200, {
    "content-type": "text/html; charset=utf-8", "cache-control": "no-store", "referrer-policy": "no-referrer", "x-content-type-options": "nosniff",
    "content-security-policy": `default-src 'none'; script-src 'nonce-${nonce}'; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; connect-src 'self'`,
  });
  response.end(asset(new URL("page.html", HERE)).replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]));
}

async function body(request) {
  const chunks = [];
  for await (const chunk of request) {
    chunks.push(chunk);
  }
  return JSON.parse(Buffer.concat(chunks).toString());
}

const server = createServer(async (request, response) => {
  const path = request.url.startsWith(`/${TOKEN}/`) ? request.url.slice(TOKEN.length + 2).split("?")[0] : undefined;
  const isOwn = request.headers.host === `127.0.0.1:${options.port}` || request.headers.host === `localhost:${options.port}`;
  if (path === undefined || !isOwn) {
    return refuse(response, 404, "not found");
  }
  try {
    if (request.method === "GET") {
      return path === "" ? page(response) : path === "schema" ? response.end((await pc(["schema"], "")).out) : refuse(response, 404, "not found");
    }
    const job = await body(request);
    if (path === "compute" || path === "motion") {
      return await stream(job, response, path === "motion");
    }
    if (path === "output") {
      const args = [job.what, "-", ...settings(job.set), ...(job.what === "derive" ? form(job) : [])];
      const { out, err, code } = await pc(args, job.text);
      return code === 0 ? response.end(out.toString() || err) : refuse(response, 422, err);
    }
    return path === "export" ? await exported(job, response) : path === "save" && isFile ? save(job, response) : refuse(response, 404, "not found");
  } catch (error) {
    return response.headersSent ? response.end() : refuse(response, 500, String(error));
  }
});
server.listen(Number(options.port), "127.0.0.1", () => console.log(`http://127.0.0.1:${options.port}/${TOKEN}/`));

