// Requests to the server, all below the address of the page itself.

import { lines } from "./ndjson.js";

export class Refusal extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
  }
}

async function post(path, body, signal) {
  const response = await fetch(path, {
    method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body), signal, cache: "no-store",
  });
  if (!response.ok) {
    throw new Refusal(response.status, (await response.text()).trim() || `The server answers ${response.status}.`);
  }
  return response;
}

// Results one after the other, from "compute" or "motion".
export async function* results(path, body, signal) {
  const response = await post(path, body, signal);
  yield* lines(response.body);
}

export async function schema() {
  return (await fetch("schema")).json();
}

// What a command prints.
export async function output(body) {
  return (await post("output", body)).text();
}

export async function save(body) {
  await post("save", body);
}

// A file, with its name.
export async function file(body) {
  const response = await post("export", body);
  const name = /filename\*=UTF-8''([^;]+)/.exec(response.headers.get("content-disposition") ?? "")?.[1];
  return { blob: await response.blob(), name: decodeURIComponent(name ?? body.what) };
}

// Hands a file to the reader.
export function hand(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
