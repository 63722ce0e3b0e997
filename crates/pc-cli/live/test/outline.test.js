import assert from "node:assert/strict";
import { test } from "node:test";
import { changed, comments, names, outline, pathOf, sectionAt } from "../src/outline.js";
import { counted, placed } from "../src/diagnostics.js";

const TEXT = `# g = 1
[model]
description = """
g = 3
"""
[parameters]
m = 1.0         # mass # of all
g = 10
k = "2*m" # "stiff"
[coordinates]
"θ" = 1.2
[quasi_velocities]
"θ'" = 0
w = { is = "θ'", start = 0.5 }
[states.u]
start = 2
rate = "-u"
[[draw]]
through = [
    ["g", "0"],
]
`;

function with_(name, value) {
  const { from, to, insert } = changed(TEXT, name, value);
  const text = TEXT.slice(0, from) + insert + TEXT.slice(to);
  return text.split("\n").find((line, i) => line !== TEXT.split("\n")[i]);
}

test("a value is written where it stands", () => {
  assert.equal(with_("g", "9.5"), "g = 9.5");
  assert.equal(with_("m", "2"), "m = 2.0         # mass # of all");
  assert.equal(with_("k", "3.5"), 'k = 3.5 # "stiff"');
  assert.equal(with_("θ", "-0.1"), '"θ" = -0.1');
  assert.equal(with_("θ'", "1"), '"θ\'" = 1.0');
  assert.equal(with_("w", "1e-3"), 'w = { is = "θ\'", start = 1e-3 }');
  assert.equal(with_("u", "3.5"), "start = 3.5");
  assert.equal(changed(TEXT, "none", "1"), undefined);
});

test("names and their comments", () => {
  assert.deepEqual(names(TEXT).map(({ name }) => name), ["m", "g", "k", "θ", "θ'", "w", "u"]);
  assert.equal(comments(TEXT).get("m"), "mass # of all");
  assert.equal(outline(TEXT).filter(({ isHeader }) => isHeader).length, 6);
  assert.deepEqual(pathOf('bodies."rod 1"'), ["bodies", "rod 1"]);
});

test("the section of a place", () => {
  const { path, keys } = sectionAt(TEXT, TEXT.indexOf("g = 10"));
  assert.deepEqual(path, ["parameters"]);
  assert.deepEqual(keys, ["m", "g", "k"]);
});

test("places are counted in characters from 1", () => {
  const text = "a\n𝑥 = zz\n";
  assert.deepEqual(placed({ line: 2, column: 5, length: 2, message: "?", help: "!" }, text), { from: 7, to: 9, severity: "error", message: "?", help: "!" });
  assert.deepEqual(placed({ line: 9, column: 1, length: 5, message: "?" }, "ab"), { from: 0, to: 2, severity: "error", message: "?", help: "" });
  assert.equal(counted([]), "no errors");
  assert.equal(counted([{}, {}, { severity: "warning" }]), "2 errors, 1 warning");
});
