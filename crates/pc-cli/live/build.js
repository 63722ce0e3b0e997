// Bundles the page's own script, with the licences of what it contains at its head.
import { build } from "esbuild";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const LARGEST = 600_000;

const result = await build({
  entryPoints: ["src/main.js"],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "ascii",
  legalComments: "none",
  metafile: true,
  write: false,
});
// The packages that are in the bundle, each with its licence; most have the same text.
const inputs = Object.keys(result.metafile.inputs);
const packages = [...new Set(inputs.flatMap((path) => /^node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1] ?? []))].sort();
const licences = new Map();
for (const name of packages) {
  const { version, license } = JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8"));
  if (license !== "MIT") {
    throw new Error(`${name} has the licence ${license}, which nobody has looked at`);
  }
  const text = readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim();
  licences.set(text, [...(licences.get(text) ?? []), `${name} ${version}`]);
}
const notice = [...licences].map(([text, names]) => `${names.join(", ")}\n\n${text}`).join("\n\n----\n\n");
// XML has no control characters; in a string, where esbuild leaves some, an escape means the same.
const escape = (sign) => `\\x${sign.charCodeAt(0).toString(16).padStart(2, "0")}`;
const bundle = result.outputFiles[0].text.replace(/[^\P{Cc}\t\n]/gu, escape);
const script = `/* With CodeMirror:\n\n${notice}\n*/\n${bundle}`;

// What would end the script element, or the CDATA section around its text, too early.
for (const end of ["]]>", "</script", "<!--"]) {
  if (script.includes(end)) {
    throw new Error(`the bundle contains ${end}`);
  }
}
if (/[^\P{Cc}\t\n]/u.test(script)) {
  throw new Error("the bundle contains control characters, which XML has not");
}
// Names of namespaces are no requests; anything else that looks like an address could be one.
const addresses = script.match(/\b(?:https?|wss?):\/\/[^\s"'`)]*/g) ?? [];
const namespaces = ["http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"];
const strange = addresses.filter((address) => !namespaces.includes(address));
if (strange.length > 0) {
  throw new Error(`the bundle contains ${[...new Set(strange)].join(", ")}`);
}
const size = Buffer.byteLength(script);
if (size > LARGEST) {
  throw new Error(`the bundle has ${size} bytes, more than ${LARGEST}`);
}
mkdirSync("dist", { recursive: true });
writeFileSync("dist/live.js", script);
writeFileSync("dist/live.LICENSE.txt", `live.js contains these packages:\n\n${notice}\n`);
console.log(`dist/live.js: ${size} bytes, ${gzipSync(script, { level: 9 }).length} with gzip`);
console.log(packages.join(", "));
