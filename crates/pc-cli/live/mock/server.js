// A stand-in for the server of `pc live`, for work on the page: it answers as PROTOCOL.md says, by the commands of a program
// `pc` for each request, or, without one, by what a page of `pc report` contains.
//
//     node mock/server.js MODEL [--port N] [--pc PROGRAM] [--page REPORT.html] [--token T] [--delay MS]
import { randomBytes } from "node:crypto";
import { createServer } from "node:http";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { parseArgs } from "node:util";
import { end, form, pc, settings } from "./program.js";
import { canned, computed, motion } from "./results.js";

const { values: options, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    port: { type: "string", default: "8420" }, pc: { type: "string" }, page: { type: "string" }, token: { type: "string" },
    delay: { type: "string", default: "0" },
  },
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

async function stream(job, response, isMotion) {
  const control = new AbortController();
  response.on("close", () => control.abort());
  response.writeHead(200, { "content-type": "application/x-ndjson", "cache-control": "no-store" });
  const start = performance.now();
  await sleep(Number(options.delay));
  const from = { program: options.pc, page: options.page, text: first };
  const work = isMotion ? motion : computed;
  const results = options.pc ? work(job, from, control.signal) : canned(job, from, isMotion);
  for await (const result of results) {
    if (control.signal.aborted) {
      return;
    }
    response.write(`${JSON.stringify(result)}\n`);
  }
  response.end(`${JSON.stringify({ kind: "done", milliseconds: Math.round(performance.now() - start) })}\n`);
}

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
  const result = await pc(options.pc, isWritten ? [...args, "-o", path] : args, job.text);
  const file = isWritten && existsSync(path) ? readFileSync(path) : result.out;
  rmSync(folder, { recursive: true });
  if (result.code !== 0) {
    return refuse(response, 422, result.err);
  }
  const name = encodeURIComponent(`${model}.${ending}`);
  response.writeHead(200, {
    "content-type": "application/octet-stream", "content-disposition": `attachment; filename*=UTF-8''${name}`,
  });
  response.end(file);
}

function refuse(response, status, message) {
  response.writeHead(status, { "content-type": "text/plain; charset=utf-8" });
  response.end(message);
}

const isFile = existsSync(given);
const model = basename(given).replace(/\.toml$/, "");
let known = isFile ? readFileSync(given, "utf8") : (await pc(options.pc, ["models", given], "")).out.toString();
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
  const own = ["src/page/style.css", "src/page/formulas.css", "plots/dist/plots.css", "src/page/viewer.css"]
    .map((path) => asset(new URL(path, REPORT)));
  return [font, ...own, asset(new URL("live.css", HERE))].join("\n");
};

function page(response) {
  const nonce = randomBytes(16).toString("base64");
  const parts = {
    title: model, nonce, style: styles(),
    data: inScript({ model: isFile ? basename(given) : given, file: isFile ? basename(given) : null, text: known, forms: FORMS }),
    viewer: asset(new URL("viewer/dist/viewer.js", REPORT)),
    plots: asset(new URL("plots/dist/plots.js", REPORT)),
    live: asset(new URL("dist/live.js", HERE)),
  };
  response.writeHead(200, {
    "content-type": "text/html; charset=utf-8", "cache-control": "no-store", "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "content-security-policy": [
      "default-src 'none'", `script-src 'nonce-${nonce}'`, "style-src 'unsafe-inline'", "img-src data: blob:", "font-src data:",
      "connect-src 'self'",
    ].join("; "),
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
      const schema = async () => response.end((await pc(options.pc, ["schema"], "")).out);
      return path === "" ? page(response) : path === "schema" ? await schema() : refuse(response, 404, "not found");
    }
    const job = await body(request);
    if (path === "compute" || path === "motion") {
      return await stream(job, response, path === "motion");
    }
    if (path === "output") {
      const args = [job.what, "-", ...settings(job.set), ...(job.what === "derive" ? form(job) : [])];
      const { out, err, code } = await pc(options.pc, args, job.text);
      return code === 0 ? response.end(out.toString() || err) : refuse(response, 422, err);
    }
    if (path === "export") {
      return await exported(job, response);
    }
    return path === "save" && isFile ? save(job, response) : refuse(response, 404, "not found");
  } catch (error) {
    return response.headersSent ? response.end() : refuse(response, 500, String(error));
  }
});
server.listen(Number(options.port), "127.0.0.1", () => console.log(`http://127.0.0.1:${options.port}/${TOKEN}/`));

