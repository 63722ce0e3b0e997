import assert from "node:assert/strict";
import { test } from "node:test";
import { complete } from "../src/completion.js";

const schema = {
  properties: {
    parameters: { description: "Numbers.", additionalProperties: { $ref: "#/definitions/expression" } },
    lagrangian: { properties: { kinetic: { description: "Kinetic energy.", allOf: [{ $ref: "#/definitions/expression" }] }, potential: { $ref: "#/definitions/expression" } } },
    bodies: { additionalProperties: { anyOf: [{ $ref: "#/definitions/expression" }, { properties: { mass: {}, joint: { properties: { kind: { enum: ["revolute", "fixed"] } } } } }] } },
    draw: { type: "array", items: { oneOf: [{ properties: { kind: { enum: ["point"] }, at: {} } }, { properties: { kind: { enum: ["disc"] }, radius: {} } }] } },
    model: { properties: { name: { type: "string" } } },
  },
  definitions: { expression: { type: ["string", "number"] } },
};

// The labels at the sign | of a text.
function at(marked, isAsked = false) {
  const place = marked.indexOf("|");
  const found = complete(marked.replace("|", ""), place, schema, isAsked);
  return found && { from: found.from, labels: found.options.map(({ label }) => label), options: found.options };
}

test("sections that are not there yet", () => {
  const found = at("[parameters]\nm = 1\n[|");
  assert.deepEqual(found.labels, ["lagrangian", "bodies", "draw", "model"]);
  assert.equal(found.options[0].apply, "lagrangian]");
  assert.equal(found.options[2].apply, "[draw]]");
  assert.equal(at("[[|]]").options.find(({ label }) => label === "draw").apply, "draw");
});

test("keys of the section", () => {
  assert.deepEqual(at("[lagrangian]\nkinetic = \"1\"\np|").labels, ["potential"]);
  assert.deepEqual(at("[bodies.rod]\n|", true).labels, ["mass", "joint"]);
  assert.deepEqual(at("[[draw]]\n|", true).labels, ["kind", "at", "radius"]);
  assert.equal(at("[bodies.rod]\n|"), null);
});

test("names of the model in expressions, and functions", () => {
  const text = "[parameters]\nmass = 1\nmu = 2\n[coordinates]\n\"θ\" = 0\n[lagrangian]\nkinetic = \"m|";
  const { labels, from } = at(text);
  assert.deepEqual(labels.slice(0, 4), ["mass", "mu", "θ", "θ'"]);
  assert.ok(labels.includes("cos") && from === text.indexOf("|") - 1);
  assert.equal(at("[lagrangian]\nkinetic = \"1 + |\""), null);
});

test("words from a list, and nothing in prose or comments", () => {
  assert.deepEqual(at('[[draw]]\nkind = "d|"').labels, ["point", "disc"]);
  assert.equal(at('[model]\nname = "m|"'), null);
  assert.equal(at("[lagrangian]\n# a \"m|"), null);
});
