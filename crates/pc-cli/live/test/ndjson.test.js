import assert from "node:assert/strict";
import { test } from "node:test";
import { lines } from "../src/ndjson.js";

function stream(chunks) {
  const bytes = chunks.map((chunk) => (typeof chunk === "string" ? new TextEncoder().encode(chunk) : chunk));
  return new ReadableStream({
    start(control) {
      bytes.forEach((chunk) => control.enqueue(chunk));
      control.close();
    },
  });
}

async function all(chunks) {
  const found = [];
  for await (const line of lines(stream(chunks))) {
    found.push(line);
  }
  return found;
}

test("lines are read however they are cut", async () => {
  assert.deepEqual(await all(['{"a":1}\n{"b"', ":2}\n", '\n{"c":3}']), [{ a: 1 }, { b: 2 }, { c: 3 }]);
});

test("a character may be cut too", async () => {
  const bytes = new TextEncoder().encode('{"name":"θ"}\n');
  assert.deepEqual(await all([bytes.slice(0, 10), bytes.slice(10)]), [{ name: "θ" }]);
});

test("who stops reading cancels the stream", async () => {
  let isCancelled = false;
  const endless = new ReadableStream({
    pull: (control) => control.enqueue(new TextEncoder().encode("1\n")),
    cancel: () => {
      isCancelled = true;
    },
  });
  for await (const line of lines(endless)) {
    assert.equal(line, 1);
    break;
  }
  assert.ok(isCancelled);
});
