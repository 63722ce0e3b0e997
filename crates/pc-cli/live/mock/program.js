// The program, and what it says.
import { execFile } from "node:child_process";

// Runs the program with the text as its input; the caller's signal ends it.
export function pc(program, args, text, signal) {
  return new Promise((done) => {
    const child = execFile(program, args, { signal, maxBuffer: 1 << 28, encoding: "buffer" }, (error, out, err) => {
      done({ code: error ? (error.code ?? 1) : 0, out, err: err.toString() });
    });
    child.stdin.on("error", () => {});
    child.on("error", () => {});
    child.stdin.end(text);
  });
}

// `pc: <stdin>:20:4: message`, the line, a line of ^, and perhaps `help: …`.
export function diagnostics(err) {
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

export const settings = (set = {}) => Object.entries(set).flatMap(([name, value]) => ["--set", `${name}=${value}`]);
export const form = (job) => (job.form ? ["--form", job.form] : []);
export const end = (job) => (job.t_end ? ["--t-end", String(job.t_end)] : []);
