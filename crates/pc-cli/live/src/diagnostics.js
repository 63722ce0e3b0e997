// What pc says about places of the text.

// A diagnostic of the protocol, whose lines and columns count from 1 and in characters, as CodeMirror wants it.
export function placed({ line, column, length, message, help, severity }, text) {
  const all = text.split("\n");
  const row = Math.min(Math.max(line || 1, 1), all.length);
  const start = all.slice(0, row - 1).reduce((sum, other) => sum + other.length + 1, 0);
  // Characters beyond the first plane are two units of a string.
  const units = (count) => Array.from(all[row - 1]).slice(0, Math.max(0, count)).join("").length;
  const from = start + units((column || 1) - 1);
  const to = start + units((column || 1) - 1 + Math.max(1, length || 1));
  return {
    from: Math.min(from, text.length),
    to: Math.min(Math.max(to, from), text.length),
    severity: severity ?? "error",
    message,
    help: help ?? "",
  };
}

// How many there are, in words.
export function counted(list) {
  const count = (severity) => list.filter((one) => (one.severity ?? "error") === severity).length;
  const words = (n, word) => (n === 0 ? [] : [`${n} ${word}${n === 1 ? "" : "s"}`]);
  return [...words(count("error"), "error"), ...words(count("warning"), "warning")].join(", ") || "no errors";
}
