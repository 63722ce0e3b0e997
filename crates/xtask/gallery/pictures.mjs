// Takes the pictures of docs/gallery.md: stills of the viewer's pages, at the times and from the sides of views.json.
//
//     node pictures.mjs PROGRAM [NAME…]
//
// needs Node and a Chromium: the one that the environment variable CHROMIUM names, or the first of those on the path.

import { spawn, spawnSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const HERE = path.dirname(fileURLToPath(import.meta.url));
const ROOT = path.resolve(HERE, "../../..");
const MODELS = path.join(ROOT, "crates/pc-model/models");
const PICTURES = path.join(ROOT, "docs/pictures/gallery");

const BROWSERS = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
// Pixels of a page, and of a picture for each of them, so that it is sharp on a fine screen.
const [WIDTH, HEIGHT, FINENESS] = [320, 240, 1.25];
// Bytes of a picture, and the qualities that are tried, best first.
const LARGEST = 8000;
const QUALITIES = [0.9, 0.82, 0.74, 0.66, 0.58, 0.5, 0.4, 0.3];
// The part of the motion that has passed, where views.json does not say.
const PASSED = 0.4;
const PATIENCE = 60_000;

// The picture has this size, whatever the page leaves it.
const STYLE = `
  #player .stage { position: fixed; top: 0; left: 0; box-sizing: border-box; width: ${WIDTH}px; height: ${HEIGHT}px; min-height: 0; border: 0; }`;

function browser() {
  const named = process.env.CHROMIUM;
  const names = named ? [named] : BROWSERS;
  const found = names.find((name) => spawnSync(name, ["--version"], { stdio: "ignore" }).status === 0);
  if (!found) {
    throw new Error(`there is no ${names.join(", ")}; the environment variable CHROMIUM can name one`);
  }
  return found;
}

// A browser without a window, to which messages go by a pipe.
class Browser {
  constructor(profile) {
    const drawing = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
    const rest = ["--headless", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-pipe"];
    this.child = spawn(browser(), [...rest, ...drawing, `--user-data-dir=${profile}`, "about:blank"], {
      stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"],
    });
    this.ended = new Promise((resolve) => this.child.once("exit", resolve));
    this.waiting = new Map();
    this.last = 0;
    let rest_of_message = "";
    this.child.stdio[4].setEncoding("utf8").on("data", (piece) => {
      const messages = (rest_of_message + piece).split("\0");
      rest_of_message = messages.pop();
      messages.map((text) => JSON.parse(text)).forEach((message) => this.take(message));
    });
  }

  take({ id, result, error }) {
    const answer = this.waiting.get(id);
    if (answer) {
      this.waiting.delete(id);
      answer(error ? Promise.reject(new Error(error.message)) : result);
    }
  }

  send(method, params = {}) {
    this.last += 1;
    const message = { id: this.last, method, params, sessionId: this.session };
    this.child.stdio[3].write(`${JSON.stringify(message)}\0`);
    return new Promise((resolve) => this.waiting.set(message.id, resolve));
  }

  // Opens a page of a light screen, on which nothing moves by itself.
  async open() {
    const { targetInfos } = await this.send("Target.getTargets");
    const { targetId } = targetInfos.find(({ type }) => type === "page");
    this.session = (await this.send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    const [width, height, deviceScaleFactor] = [WIDTH, HEIGHT, FINENESS];
    await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor, mobile: false });
    const features = [["prefers-color-scheme", "light"], ["prefers-reduced-motion", "reduce"]];
    await this.send("Emulation.setEmulatedMedia", { features: features.map(([name, value]) => ({ name, value })) });
  }

  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", {
      expression, awaitPromise: true, returnByValue: true,
    });
    if (exceptionDetails) {
      throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    }
    return result.value;
  }

  async close() {
    this.child.kill("SIGKILL");
    await this.ended;
  }
}

// What runs in the page: it waits for the viewer, presses keys, shows the still, and returns its picture in WebP.
async function taken(style, { at, keys, follow }, { patience, qualities, largest }) {
  const picture = () => new Promise((resolve) => requestAnimationFrame(resolve));
  const root = () => document.getElementById("player");
  const end = Date.now() + patience;
  while (!root()?.player?.show) {
    if (Date.now() > end) {
      throw new Error("the viewer does not start");
    }
    await picture();
  }
  document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
  await picture();
  await picture();
  if (follow !== undefined) {
    const list = document.querySelector("[data-list=follow]");
    list.value = [...list.options].find(({ text }) => text === follow).value;
    list.dispatchEvent(new Event("change"));
  }
  for (const key of keys) {
    document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  }
  const drawn = root().querySelector("canvas");
  const copy = Object.assign(document.createElement("canvas"), { width: drawn.width, height: drawn.height });
  const pen = copy.getContext("2d");
  pen.fillStyle = getComputedStyle(document.body).backgroundColor;
  pen.fillRect(0, 0, copy.width, copy.height);
  root().player.show(Math.round(at * Number(root().querySelector("input[type=range]").max)));
  // Before the next picture of the screen, by which what is drawn is given away.
  pen.drawImage(drawn, 0, 0);
  let data;
  for (const quality of qualities) {
    data = copy.toDataURL("image/webp", quality).split(",")[1];
    if (data.length * 0.75 <= largest) {
      break;
    }
  }
  return data;
}

async function main([program, ...wanted]) {
  const views = JSON.parse(fs.readFileSync(path.join(HERE, "views.json"), "utf8"));
  const all = fs.readdirSync(MODELS).filter((file) => file.endsWith(".toml")).map((file) => path.basename(file, ".toml"));
  const unknown = [...wanted, ...Object.keys(views)].filter((name) => !all.includes(name));
  if (!program || unknown.length > 0) {
    throw new Error(program ? `there is no model ${unknown.join(", ")}` : "node pictures.mjs PROGRAM [NAME…]");
  }
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "gallery-"));
  const page = path.join(folder, "page.html");
  const screen = new Browser(path.join(folder, "profile"));
  let sum = 0;
  try {
    await screen.open();
    fs.mkdirSync(PICTURES, { recursive: true });
    for (const name of wanted.length > 0 ? wanted : all) {
      const made = spawnSync(program, ["animate", path.join(MODELS, `${name}.toml`), "-o", page], { encoding: "utf8" });
      if (made.status !== 0) {
        throw new Error(`${name}: ${made.error ?? made.stderr}`);
      }
      await screen.send("Page.navigate", { url: pathToFileURL(page).href });
      const view = { at: PASSED, keys: [], ...views[name] };
      const limits = { patience: PATIENCE, qualities: QUALITIES, largest: LARGEST };
      const given = [STYLE, view, limits].map((one) => JSON.stringify(one)).join(", ");
      const bytes = Buffer.from(await screen.evaluate(`(${taken})(${given})`), "base64");
      fs.writeFileSync(path.join(PICTURES, `${name}.webp`), bytes);
      sum += bytes.length;
      console.log(`${name}: ${bytes.length} bytes`);
    }
    console.log(`${sum} bytes in all`);
  } finally {
    await screen.close();
    fs.rmSync(folder, { recursive: true, force: true });
  }
}

await main(process.argv.slice(2));
