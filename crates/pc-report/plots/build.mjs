// Writes dist/: one script and one style, to be put into pages, and the licence of what they contain.
import { readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";

const licence = (await readFile("node_modules/uplot/LICENSE", "utf8")).trim();
const notice = `uPlot 1.6.32\n\n${licence}`;

const options = {
  bundle: true,
  minify: true,
  target: "es2020",
  legalComments: "none",
  logLevel: "warning",
};
// Pages are copies of uPlot, whose licence asks for its text in each of them.
await build({ ...options, entryPoints: ["src/main.js"], outfile: "dist/plots.js", format: "iife", banner: { js: `/*\n${notice}\n*/` } });
await build({ ...options, entryPoints: ["src/plots.css"], outfile: "dist/plots.css" });
await writeFile("dist/plots.LICENSE.txt", `${notice}\n`);

// Pages are HTML and XML at once, and name no address elsewhere.
for (const [file, forbidden] of [
  ["dist/plots.js", ["]]>", "</script", "<!--", "http:", "https:"]],
  ["dist/plots.css", ["<", "&", "]]>", "http:", "https:"]],
]) {
  const text = await readFile(file, "utf8");
  for (const sign of forbidden) {
    if (text.toLowerCase().includes(sign)) {
      throw new Error(`${file} contains ${sign}, which a page must not`);
    }
  }
  console.log(`${file}: ${Buffer.byteLength(text)} bytes`);
}
