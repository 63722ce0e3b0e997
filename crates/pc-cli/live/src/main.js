// The page of pc live: what is typed on the left is computed on the right.

import { Actions, offerNames } from "./actions.js";
import { file, hand, output, Refusal, results, save, schema } from "./client.js";
import { Divider } from "./divider.js";
import { Editor } from "./editor.js";
import { byId } from "./elements.js";
import { Freshness } from "./freshness.js";
import { Latest, Newest } from "./latest.js";
import { put } from "./markup.js";
import { showPlots, showScene } from "./motion.js";
import { read, written } from "./numbers.js";
import { changed, comments } from "./outline.js";
import { Sliders } from "./sliders.js";
import { Status } from "./status.js";
import { Tabs } from "./tabs.js";

// After the last key, before the text is computed; and after the last move of a slider, before all else is.
const [TYPED, SLID] = [60, 250];
const PER_SECOND = 30;
const AGAIN = 1500;
// The members of a sweep.
const MEMBERS = 101;

// What each result is shown in.
const PARTS = { scene: "motion", plots: "plots", equations: "equations", verdicts: "verdicts" };

const given = JSON.parse(byId("live-data").textContent);
let id = 0;
let saved = given.text;
let time;

const editor = new Editor(byId("editor"), given.text, { changed: typed, save: keep, compute: computeNow });
const status = new Status(byId("status"), (diagnostic) => editor.show(diagnostic));
const sliders = new Sliders(byId("sliders"), { changed: slid, write });
const tabs = new Tabs(byId("tabs"), document.body);
const freshness = new Freshness((part, isOld) => byId(part)?.classList.toggle("old", isOld));
const actions = new Actions(byId("commands"), { tab: computeAndShow, output: print, file: give }, commandState);
const compute = new Newest((job, signal) => request("compute", job, signal));
const motion = new Latest((job) => request("motion", job), 1000 / PER_SECOND);
new Divider(byId("columns-line"), byId("work"), "--columns", true, 0.4);
new Divider(byId("rows-line"), byId("results"), "--rows", false, 0.54);

// What requests say besides the text.
function choices() {
  return { set: sliders.values(), form: byId("form").value || undefined, t_end: read(byId("t-end").value) };
}

function job() {
  return { id: ++id, text: editor.text, ...choices() };
}

// What command lines say.
function commandState() {
  const { set, form, t_end: tEnd } = choices();
  const chosen = sliders.find(byId("vary").value);
  const vary = chosen && { name: chosen.name, low: written(chosen.range.low), high: written(chosen.range.high), count: MEMBERS };
  const words = (number, digits) => (number === undefined ? undefined : written(Number(number.toPrecision(digits))));
  return { model: given.model, set, form, tEnd: words(tEnd, 15), vary, at: words(time, 4) };
}

// Sends a job and shows results as they come, unless something newer is on its way.
async function request(path, sent, signal) {
  const parts = path === "motion" ? ["motion", "plots"] : Object.values(PARTS);
  freshness.expect(parts, sent.id);
  status.begin();
  try {
    for await (const result of results(path, sent, signal)) {
      if (signal?.aborted) {
        return;
      }
      if (freshness.isNews(PARTS[result.kind] ?? result.kind, sent.id)) {
        show(result, sent);
      }
    }
  } catch (error) {
    if (error.name === "AbortError") {
      return;
    }
    status.lost(error instanceof Refusal ? error.message : "The server does not answer.");
    if (!(error instanceof Refusal)) {
      clearTimeout(again);
      again = setTimeout(computeNow, AGAIN);
    }
  }
}
let again;

function show(result, sent) {
  const { kind } = result;
  if (kind === "diagnostics") {
    status.diagnose(result.list);
    editor.report(result.list, sent.text);
  } else if (kind === "names") {
    sliders.give(result.parameters, result.starts, comments(sent.text));
    offerNames(sliders.names());
    showChoices();
  } else if (kind === "scene") {
    showScene(result.data);
  } else if (kind === "plots") {
    showPlots(result.data);
  } else if (kind === "equations" || kind === "verdicts") {
    put(byId(`${kind}-markup`), result.html);
  } else if (kind === "summary") {
    byId("summary").textContent = result.text;
    byId("model-name").textContent = result.name || given.model;
    byId("t-end").placeholder = result.t_end === undefined ? "" : written(result.t_end);
  } else if (kind === "done") {
    status.done(result.milliseconds);
  }
  freshness.got(PARTS[kind] ?? kind, sent.id);
}

let typing;
function typed() {
  clearTimeout(typing);
  typing = setTimeout(computeNow, TYPED);
  showSaved();
}

function computeNow() {
  clearTimeout(typing);
  motion.clear();
  compute.start(job());
}

function computeAndShow(tab) {
  computeNow();
  tabs.show(tab);
}

// The command lines contain what is chosen.
function showChoices() {
  actions.update();
  byId("reset-all").disabled = Object.keys(sliders.values()).length === 0;
}

function slid() {
  showChoices();
  // What is at work has other values. The motion comes first, all else when the slider rests.
  compute.abort();
  motion.offer(job());
  clearTimeout(typing);
  typing = setTimeout(computeNow, SLID);
}

// Writes the value of a slider into the text, where it is computed from then on.
function write(name, value) {
  const change = changed(editor.text, name, value);
  if (change) {
    editor.change(change);
  } else {
    status.tell(`${name} stands in no single place of the text.`, true);
  }
}

function showSaved() {
  const isSaved = editor.text === saved;
  byId("save").disabled = isSaved && given.file;
  document.title = `${isSaved ? "" : "• "}${given.model} – pc live`;
}

// Into its file, or, where the model came from none, into a file of the reader.
async function keep(isForced = false) {
  const { text } = editor;
  if (!given.file) {
    hand(new Blob([text], { type: "application/toml" }), `${given.model}.toml`);
    saved = text;
    showSaved();
    return;
  }
  try {
    await save(isForced === true ? { text, force: true } : { text });
    saved = text;
    status.tell("saved");
    byId("conflict").hidden = true;
  } catch (error) {
    if (error instanceof Refusal && error.status === 409) {
      byId("conflict-words").textContent = error.message;
      byId("conflict").hidden = false;
      byId("conflict-force").focus();
    } else {
      status.tell(error.message, true);
    }
  }
  showSaved();
}

// The body of a request for what a command prints or writes.
function order(what) {
  const { vary, at } = commandState();
  const more = {
    sweep: vary && { vary: `${vary.name}=${vary.low}:${vary.high}:${vary.count}` },
    png: { at },
  };
  return { what, text: editor.text, ...choices(), ...more[what] };
}

async function print(what, words) {
  const place = byId("output");
  byId("output-box").hidden = false;
  byId("output-title").textContent = words;
  place.textContent = "computing…";
  try {
    place.textContent = await output(order(what));
  } catch (error) {
    place.textContent = error.message;
  }
  byId("output-box").scrollIntoView({ block: "nearest" });
}

async function give(what, words) {
  status.tell(`${words}: computing…`);
  try {
    const { blob, name } = await file(order(what));
    hand(blob, name);
    status.tell(name);
  } catch (error) {
    status.tell(error.message, true);
  }
}

document.addEventListener("pc:time", ({ detail }) => (time = detail));
document.addEventListener("keydown", (event) => {
  if ((event.ctrlKey || event.metaKey) && !event.defaultPrevented) {
    const action = { s: keep, Enter: computeNow }[event.key];
    if (action) {
      event.preventDefault();
      action();
    }
  }
});
byId("save").addEventListener("click", keep);
byId("reset-all").addEventListener("click", () => sliders.reset());
byId("conflict-force").addEventListener("click", () => keep(true));
byId("conflict").addEventListener("keydown", (event) => event.key === "Escape" && (byId("conflict").hidden = true));
byId("conflict-cancel").addEventListener("click", () => (byId("conflict").hidden = true));
byId("output-close").addEventListener("click", () => (byId("output-box").hidden = true));
for (const choice of ["form", "t-end"]) {
  byId(choice).addEventListener("change", () => {
    showChoices();
    computeNow();
  });
}
byId("vary").addEventListener("change", () => actions.update());
window.addEventListener("beforeunload", (event) => editor.text !== saved && event.preventDefault());

byId("form").append(...given.forms.map(([value, words]) => new Option(words, value)));
byId("file").textContent = given.file ?? given.model;
byId("save").textContent = given.file ? "Save" : "Save as…";
tabs.show("plots");
showSaved();
schema().then((found) => (editor.schema = found), () => {});
computeNow();
