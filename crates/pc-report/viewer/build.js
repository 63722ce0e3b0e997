// Bundles the viewer into one script for a page, with the licence of three.js at its head.
import { build } from "esbuild";
import { readFileSync, writeFileSync, mkdirSync } from "node:fs";
import { gzipSync } from "node:zlib";

const LARGEST = 700_000;

const licence = readFileSync("node_modules/three/LICENSE", "utf8").trim();
const result = await build({
  entryPoints: ["src/main.js"],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "ascii",
  legalComments: "none",
  banner: { js: `/* With three.js:\n\n${licence}\n*/` },
  write: false,
});
const script = result.outputFiles[0].text;
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
writeFileSync("dist/viewer.js", script);
writeFileSync("dist/viewer.LICENSE.txt", `viewer.js contains three.js, under this licence:\n\n${licence}\n`);
console.log(`dist/viewer.js: ${size} bytes, ${gzipSync(script, { level: 9 }).length} with gzip`);
