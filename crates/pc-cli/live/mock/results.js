// Results, line by line. `given` is { program, page, text }: the program, a page of a report, and the text to which that belongs.
import { readFileSync } from "node:fs";
import { plots } from "./plots.js";
import { diagnostics, end, pc, settings } from "./program.js";
import { starts } from "./starts.js";

const between = (page, id) => new RegExp(`<section id="${id}"[^>]*>\\s*<h2[^>]*>.*?</h2>([^]*?)</section>`).exec(page)?.[1] ?? "";
const script = (page, id) => JSON.parse(new RegExp(`id="${id}">([^]*?)</script>`).exec(page)?.[1] ?? "null");

// The equations of one form: those under its heading.
const HEADINGS = {
  poincare: "Poincaré&#39;s equations", canonical: "Canonical equations", lagrange: "Lagrange", voronets: "Voronets",
  reduced: "Poincaré&#39;s equations, reduced", "lie-poisson": "Canonical equations, reduced", orthonormal: "orthonormal",
  maggi: "Maggi", kane: "Kane", "gibbs-appell": "Gibbs",
};
const NONE = "<p class=\"soft\">The page of the mock has no equations in this form.</p>";

function ofForm(html, form) {
  const parts = html.split(/(?=<h3>)/).filter((part) => part.startsWith("<h3>"));
  const title = HEADINGS[form || "poincare"];
  const exact = parts.find((part) => part.startsWith(`<h3>${title}</h3>`));
  return exact ?? parts.find((part) => part.slice(0, 200).includes(title)) ?? NONE;
}

export async function* motion(job, { program }, signal) {
  const { text } = job;
  const more = [...settings(job.set), ...end(job)];
  const [page, table] = await Promise.all([
    pc(program, ["animate", "-", ...more, "--samples", "301"], text, signal),
    pc(program, ["run", "-", ...more, "--samples", "301", "--no-verify"], text, signal),
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
  const last = Number(rows.trim().split("\n").at(-1).split(",")[0]);
  yield { kind: "summary", name: table.err.split("\n")[0], text: table.err.trim(), t_end: last };
}

export async function* computed(job, given, signal) {
  const { program } = given;
  const check = await pc(program, ["check", "-", "--format", "json", ...settings(job.set)], job.text, signal);
  if (signal.aborted) {
    return;
  }
  yield { kind: "diagnostics", list: check.code === 0 ? [] : diagnostics(check.err) };
  if (check.code === 3) {
    return;
  }
  yield { kind: "names", ...starts(job.text) };
  yield* motion(job, given, signal);
  // Of the text as it was given, a page may be newer than the program.
  const isGiven = given.page && job.text === given.text && Object.keys(job.set).length === 0;
  const report = isGiven
    ? { code: 0, out: readFileSync(given.page) }
    : await pc(program, ["report", "-", "--no-run", ...settings(job.set)], job.text, signal);
  if (report.code === 0) {
    const page = report.out.toString();
    yield { kind: "equations", html: ofForm(between(page, "equations"), job.form) };
    yield { kind: "verdicts", html: between(page, "verdicts") };
  }
}

// What a page contains, whatever the text is.
export async function* canned(job, given, isMotion) {
  const page = readFileSync(given.page, "utf8");
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
