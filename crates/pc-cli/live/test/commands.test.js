import assert from "node:assert/strict";
import { test } from "node:test";
import { commandLine, quoted, stemOf } from "../src/commands.js";

const state = { model: "models/top.toml", set: { g: "9.5" }, form: "canonical", tEnd: "20", vary: { name: "m", low: "0", high: "2", count: 11 } };

test("a line does what a button does", () => {
  assert.equal(commandLine("run", state), "pc run models/top.toml --set g=9.5 --form canonical --t-end 20 -o top.csv");
  assert.equal(commandLine("check", state), "pc check models/top.toml --set g=9.5");
  assert.equal(commandLine("derive", { ...state, form: "kane" }), "pc derive models/top.toml --set g=9.5 --form kane");
  assert.equal(commandLine("sweep", { ...state, tEnd: undefined }), "pc sweep models/top.toml --set g=9.5 --vary m=0:2:11 --form canonical -o top.csv");
  assert.equal(commandLine("sweep", { ...state, set: { m: "3" }, form: "" }), "pc sweep models/top.toml --vary m=0:2:11 --t-end 20 -o top.csv");
  assert.equal(commandLine("latex", state), "pc derive models/top.toml --set g=9.5 --form canonical --format latex -o top.tex");
  assert.equal(commandLine("fmu", { model: "tilted-disk" }), "pc emit tilted-disk --fmu 3 -o tilted-disk.fmu");
  assert.equal(commandLine("notebook", state), undefined);
});

test("a form that cannot be integrated is left out", () => {
  assert.equal(commandLine("run", { model: "a", form: "kane" }), "pc run a -o a.csv");
  assert.equal(commandLine("c", { model: "a", form: "canonical" }), "pc emit a --lang c -o a-c");
});

test("a shell reads an argument as it is", () => {
  assert.equal(quoted("θ=0.1"), "θ=0.1");
  assert.equal(quoted("x'=1"), "'x'\\''=1'");
  assert.equal(quoted("my model.toml"), "'my model.toml'");
  assert.equal(quoted("$(rm)"), "'$(rm)'");
  assert.equal(quoted(""), "''");
  assert.equal(stemOf("a/b.c.toml"), "b.c");
});
