// The page: `page` holds its state, and everything on the page is drawn from it.

import { compiler } from "./compiler.js";
import { byId } from "./dom.js";
import * as editor from "./editor.js";
import * as meaning from "./meaning.js";
import { packed, unpacked } from "./share.js";
import { takeToken } from "./token.js";
import * as trace from "./trace.js";

const TYPING_MS = 250;
const MOST_STEPS = 1000;
const LONG_LINK = 4000;
/** Characters; browsers allow at most two million. */
const MOST_IN_LINK = 500_000;

const asking = compiler();
const page = { notation: kept("notation") === "unicode" ? "unicode" : "english", spec: "", mode: "atoms", letters: [], current: 0, picked: null, view: null, rows: [] };
let startData = null;
let timer = 0;
let asked = 0;
let remembering = 0;
let written = "";

async function begin() {
  theme();
  takeToken();
  window.addEventListener("hashchange", moved);
  startData = await asking.ask({});
  editor.begin(startData, () => {
    named();
    later(TYPING_MS);
  });
  trace.begin({ changed: () => later(20), go, remove });
  startData.examples.forEach(({ title }, index) => byId("examples").append(new Option(title, index)));
  byId("examples").addEventListener("change", ({ target }) => {
    if (target.value !== "") example(Number(target.value));
  });
  byId("share").addEventListener("click", share);
  byId("add").addEventListener("click", add);
  byId("clear").addEventListener("click", () => replace([]));
  byId("back").addEventListener("click", () => go(page.current - 1));
  byId("forth").addEventListener("click", () => go(page.current + 1));
  for (const id of ["succeed", "fail"]) byId(id).addEventListener("click", () => replace(structuredClone(page.view[id])));
  for (const input of document.getElementsByName("mode")) input.addEventListener("change", () => choose(input.value));
  for (const input of document.getElementsByName("notation")) input.addEventListener("change", () => write(input.value));
  byId("steps").addEventListener("keydown", arrows);
  if (!(await restore())) example(0);
}

/** The fragment of the address has changed: to a token, with which to repeat the failed request, or to another text. */
function moved() {
  if (takeToken()) startData ? later(0) : location.reload();
  else if (startData && location.hash !== written) restore();
}

/** Send a request after a delay; a later call replaces it. Answers to earlier requests are ignored from now on. */
function later(milliseconds) {
  clearTimeout(timer);
  asked += 1;
  timer = setTimeout(ask, milliseconds);
}

async function ask() {
  const number = ++asked;
  const busy = setTimeout(() => number === asked && showSummary("Compiling…"), 400);
  try {
    const letters = page.letters.map((letter) => (page.mode === "atoms" ? letter.atoms : (letter.signals ?? {})));
    const lengths = page.letters.map(({ dt }) => dt ?? null);
    const answer = await asking.ask({ text: editor.text(), spec: page.spec, letters, notation: page.notation, lengths });
    if (number === asked) take(answer);
  } catch (error) {
    if (number === asked) showSummary(`No answer: ${error.message}`);
  } finally {
    clearTimeout(busy);
  }
}

/** Show an answer. */
function take({ diagnostics, more, specs, tests, spec }) {
  editor.show(diagnostics);
  showSummary(summary(diagnostics, more, specs, tests));
  meaning.stale(!spec);
  if (spec) {
    const isNew = page.view?.name !== spec.name;
    if (isNew || !spec.states[page.picked]) page.picked = null;
    page.view = spec;
    page.spec = spec.name;
    page.rows = spec.rows;
    meaning.show(spec, specs, (name) => pickSpec(name), (state) => pick(state));
    if (complete(spec)) return ask();
    follow(spec);
    byId("succeed").disabled = !spec.succeed;
    byId("fail").disabled = !spec.fail;
    byId("add").disabled = !spec.atoms.length || page.letters.length >= MOST_STEPS;
  }
  render();
  remember();
}

/** Give each letter the signals of this spec, and the time, that it lacks; return whether any lacked one. */
function complete({ signals, idle }) {
  let changed = false;
  for (const letter of idle.dt === null ? [] : page.letters) {
    changed ||= typeof letter.dt !== "number";
    letter.dt ??= idle.dt;
  }
  if (page.mode !== "signals") return changed;
  for (const letter of page.letters) {
    letter.signals ??= {};
    for (const { name, slider } of signals) {
      if (name in letter.signals) continue;
      letter.signals[name] = idle.signals?.[name] ?? slider[0];
      changed = true;
    }
  }
  return changed;
}

/** Update the letters of the other mode, atoms or signals, from the answer. */
function follow({ atoms, rows }) {
  rows.forEach((row, index) => {
    const letter = page.letters[index];
    if (!letter || row.error) return;
    if (page.mode === "signals") letter.atoms = atoms.filter((_, atom) => row.values[atom] > 0).map(({ name }) => name);
    else letter.signals = row.signals ?? letter.signals;
  });
}

function render() {
  const { view: spec, letters, mode, notation, current, rows, picked } = page;
  for (const input of document.getElementsByName("mode")) input.checked = input.value === mode;
  for (const input of document.getElementsByName("notation")) input.checked = input.value === notation;
  trace.show({ spec, letters, mode, current, rows });
  // `disabled` would take the focus away from a button, and a keyboard user would lose the place.
  byId("back").setAttribute("aria-disabled", current <= 0);
  byId("forth").setAttribute("aria-disabled", current >= letters.length - 1);
  if (!spec) return;
  const row = rows[current];
  const state = row ? (row.error ? null : row.state) : 0;
  meaning.light(state, row && !row.error ? [row.from, row.state] : null, picked);
  meaning.showState(spec.states[picked ?? state], notation);
}

function summary(diagnostics, more, specs, tests) {
  const count = (severity, word) => {
    const number = diagnostics.filter((diagnostic) => diagnostic.severity === severity).length;
    return number ? [`${number} ${word}${number === 1 ? "" : "s"}`] : [];
  };
  const parts = [...count("error", "error"), ...count("warning", "warning"), ...count("note", "note")];
  if (more) parts.push(`${more} more message${more === 1 ? "" : "s"}`);
  if (tests.length) parts.push(`${tests.filter((test) => test.passed).length} of ${tests.length} tests passed`);
  if (!specs.length && !parts.length) return "There is no spec yet. Write one: spec NAME { reach … keep … }";
  if (specs.length) return ["It compiles", ...parts].join("; ");
  return `${parts.join("; ")}${page.view ? "; the rest of the page shows an earlier text" : ""}`;
}

function showSummary(text) {
  if (byId("summary").textContent !== text) byId("summary").textContent = text;
}

function example(index) {
  editor.setText(startData.examples[index].text);
  named();
  Object.assign(page, { spec: "", letters: [], current: 0, picked: null, mode: "atoms" });
  later(0);
}

/** Show in the menu which example the text is, if it is one. */
function named() {
  const open = startData.examples.findIndex((example) => example.text === editor.text());
  byId("examples").value = open < 0 ? "" : open;
}

function pickSpec(name) {
  Object.assign(page, { spec: name, letters: [], current: 0, picked: null });
  later(0);
}

/** Show what remains in a state; after a second click, show the current state again. */
function pick(state) {
  page.picked = page.picked === state ? null : state;
  render();
}

function go(index) {
  if (index === page.current || index < 0 || index >= page.letters.length) return;
  Object.assign(page, { current: index, picked: null });
  render();
  remember();
}

function arrows(event) {
  const move = { ArrowUp: -1, ArrowDown: 1 }[event.key];
  if (!move || !event.target.matches("button, input[type=checkbox]")) return;
  event.preventDefault();
  const rows = [...byId("steps").querySelectorAll("tbody tr")];
  const row = event.target.closest("tr");
  const place = [...row.querySelectorAll("button, input")].indexOf(event.target);
  rows[rows.indexOf(row) + move]?.querySelectorAll("button, input")[place]?.focus();
}

function add() {
  const before = page.letters.at(-1);
  const copied = page.mode === "signals" && before ? before : page.view.idle;
  page.letters.push(structuredClone({ ...copied, dt: before?.dt ?? page.view.idle.dt }));
  page.current = page.letters.length - 1;
  page.picked = null;
  render();
  later(0);
}

function remove(index) {
  page.letters.splice(index, 1);
  page.rows = page.rows.slice(0, index);
  page.current = Math.max(0, Math.min(page.current, page.letters.length - 1));
  render();
  byId("add").focus();
  later(0);
}

function replace(letters) {
  Object.assign(page, { letters, rows: [], current: 0, picked: null });
  render();
  later(0);
}

function choose(mode) {
  page.mode = mode;
  later(0);
}

/** Write the picture in words or in symbols. */
function write(notation) {
  page.notation = kept("notation", notation);
  later(0);
}

/** Update the fragment of the address after a delay: browsers allow few changes of it per second. */
function remember() {
  clearTimeout(remembering);
  remembering = setTimeout(keep, 300);
}

/** Store the state in the fragment, for reloads and copied links. Return whether it fits; if not, clear the fragment. */
async function keep() {
  clearTimeout(remembering);
  const letters = page.letters.map((letter) => letter[page.mode]);
  const saved = { text: editor.text(), spec: page.spec, mode: page.mode, letters, current: page.current };
  if (page.view?.idle.dt) saved.lengths = page.letters.map(({ dt }) => dt);
  const fragment = await packed(saved);
  const fits = fragment.length <= MOST_IN_LINK;
  written = fits ? fragment : "";
  history.replaceState(null, "", written || location.pathname);
  return fits;
}

/** Restore the state from the fragment. Anybody may have written it, so every value is checked. */
async function restore() {
  const saved = await unpacked(location.hash);
  if (typeof saved?.text !== "string") return false;
  const mode = saved.mode === "signals" ? "signals" : "atoms";
  const given = Array.isArray(saved.letters) ? saved.letters.filter((letter) => letter && typeof letter === "object") : [];
  const lengths = Array.isArray(saved.lengths) ? saved.lengths.map((dt) => (typeof dt === "number" ? dt : null)) : [];
  const letters = given.slice(0, MOST_STEPS).map((letter, index) => {
    return { atoms: [], signals: null, dt: lengths[index] ?? null, [mode]: LETTERS[mode](letter) };
  });
  const current = Math.min(Math.max(Math.trunc(Number(saved.current)) || 0, 0), Math.max(letters.length - 1, 0));
  editor.setText(saved.text);
  named();
  Object.assign(page, { mode, spec: String(saved.spec ?? ""), letters, current, picked: null });
  later(0);
  return true;
}

const LETTERS = {
  atoms: (letter) => Object.values(letter).filter((name) => typeof name === "string"),
  signals: (letter) => Object.fromEntries(Object.entries(letter).filter(([, value]) => typeof value === "number")),
};

async function share() {
  if (!(await keep())) return showSummary("The text is too long for a link: save it as a file.");
  const { length } = location.href;
  const long = length > LONG_LINK ? ` It has ${length} characters, and some programs cut long links.` : "";
  try {
    await navigator.clipboard.writeText(location.href);
    showSummary(`The link is in the clipboard; it contains the text.${long}`);
  } catch {
    showSummary(`Copy the address of this page: it contains the text.${long}`);
  }
}

function theme() {
  const root = document.documentElement;
  const chosen = kept("theme");
  if (chosen) root.dataset.theme = chosen;
  byId("theme").addEventListener("click", () => {
    const isDark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = isDark ? "light" : "dark";
    kept("theme", root.dataset.theme);
  });
}

/** Store a choice of the user, if `value` is given; return the stored choice. */
function kept(name, value) {
  // Storage may be forbidden.
  try {
    if (value) localStorage.setItem(name, value);
    return localStorage.getItem(name);
  } catch {
    return value;
  }
}

begin().catch((error) => showSummary(`The page could not start: ${error.message}`));
