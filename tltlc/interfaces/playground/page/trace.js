// The table of a trace: one row per step, with a control for each atom or signal, and the monitor's output.

import { byId, element, prose, shown } from "./dom.js";

const MOST_NAMES = 4;

let built = "";
let handlers = {};

/** Set the handlers: `changed()` is called after a letter has changed, `go(index)` to select a step, `remove(index)`. */
export function begin(given) {
  handlers = given;
}

/** Show the steps. Rebuild the table only if its shape changes, so that a slider keeps the focus while it is moved. */
export function show({ spec, letters, mode, current, rows }) {
  byId("trace").hidden = !spec;
  if (!spec) return;
  const columns = mode === "atoms" ? spec.atoms : spec.signals;
  const timed = spec.idle.dt !== null;
  const shape = JSON.stringify([mode, columns, timed, letters.length]);
  if (shape !== built) {
    build(mode, columns, timed, letters);
    built = shape;
  }
  [...byId("steps").querySelectorAll("tbody tr")].forEach((row, index) => {
    row.classList.toggle("current", index === current);
    row.querySelector(".go").setAttribute("aria-current", index === current ? "step" : "false");
    fill(row, letters[index], rows[index], mode, columns);
  });
  showStep(rows[current], letters.length);
  warn(strangers(spec, letters, mode), mode);
}

function build(mode, columns, timed, letters) {
  const heads = columns.map((column) =>
    element("th", { scope: "col", class: "column", title: column.doc || null }, column.name, column.unit ? ` (${column.unit})` : ""),
  );
  const titles = ["state", "verdict", "progress", "reward"].map((name) => element("th", { scope: "col" }, name));
  const times = timed ? element("th", { scope: "col", title: "at the first step it counts for nothing" }, "time since the last step (s)") : [];
  const head = element("thead", {}, element("tr", {}, element("th", { scope: "col" }, "step"), times, heads, titles, element("th", { scope: "col", "aria-label": "remove" })));
  const body = element("tbody", {}, letters.map((letter, index) => rowOf(mode, columns, timed, letter, index)));
  byId("steps").replaceChildren(head, body);
}

function rowOf(mode, columns, timed, letter, index) {
  const go = element("button", { type: "button", class: "go", click: () => handlers.go(index) }, String(index + 1));
  const cells = columns.map((column) => element("td", { class: "input" }, mode === "atoms" ? toggle(column, letter, index) : setter(column, letter, index)));
  const remove = element("button", { type: "button", class: "remove", "aria-label": `Remove step ${index + 1}`, click: () => handlers.remove(index) }, "×");
  return element(
    "tr",
    {
      click: (event) => event.target.closest("button, input") || handlers.go(index),
      focusin: () => handlers.go(index),
    },
    element("th", { scope: "row" }, go),
    timed ? element("td", { class: "length" }, clock(letter, index)) : [],
    cells,
    element("td", { class: "at" }),
    element("td", { class: "step-verdict" }),
    element("td", { class: "progress" }, element("meter", { min: 0, max: 1, "aria-hidden": "true" }), element("span")),
    element("td", { class: "reward" }),
    element("td", {}, remove),
  );
}

/** The input of the time since the step before. */
function clock(letter, index) {
  const read = ({ target }) => {
    if (target.value === "" || !Number.isFinite(target.valueAsNumber)) return;
    letter.dt = target.valueAsNumber;
    handlers.changed();
  };
  return element("input", { type: "number", min: 0, step: "any", "aria-label": `time since the last step at step ${index + 1}, in seconds`, input: read });
}

function toggle({ name, follows }, letter, index) {
  return element("input", {
    type: "checkbox",
    // The atoms of the steps so far decide whether this one holds.
    disabled: follows,
    "aria-label": `${name} at step ${index + 1}`,
    change: (event) => {
      letter.atoms = letter.atoms.filter((other) => other !== name).concat(event.target.checked ? [name] : []);
      handlers.changed();
    },
  });
}

function setter({ name, type, values, slider, low, high }, letter, index) {
  const label = `${name} at step ${index + 1}`;
  const set = (value) => {
    letter.signals = { ...letter.signals, [name]: value };
    handlers.changed();
  };
  if (type === "bool") return element("input", { type: "checkbox", "aria-label": label, change: (event) => set(Number(event.target.checked)) });
  if (values.length) {
    const options = values.map((value, number) => element("option", { value: number }, value));
    return element("select", { "aria-label": label, change: (event) => set(Number(event.target.value)) }, options);
  }
  const read = (event) => event.target.value !== "" && Number.isFinite(event.target.valueAsNumber) && set(event.target.valueAsNumber);
  const step = type === "int" ? 1 : (slider[1] - slider[0]) / 200;
  return [
    element("input", { type: "range", min: slider[0], max: slider[1], step, "aria-label": label, input: read }),
    element("input", { type: "number", min: low, max: high, step: type === "int" ? 1 : "any", "aria-label": `${label}, as a number`, input: read }),
  ];
}

function fill(row, letter, step, mode, columns) {
  row.querySelectorAll("td.input").forEach((cell, index) => {
    const { name, follows } = columns[index];
    const holds = follows ? step?.values?.[index] > 0 : letter.atoms.includes(name);
    const value = mode === "atoms" ? holds : (letter.signals?.[name] ?? 0);
    for (const input of cell.querySelectorAll("input, select")) {
      if (input.type === "checkbox") input.checked = Boolean(value);
      else if (input !== document.activeElement) input.value = input.type === "number" ? shown(value) : value;
    }
  });
  const length = row.querySelector("td.length input");
  if (length && length !== document.activeElement) length.value = letter.dt ?? "";
  const known = step && !step.error;
  row.classList.toggle("wrong", Boolean(step?.error));
  row.querySelector(".at").textContent = known ? step.state : "";
  const failure = step?.failure ? sentence(step.failure.replaceAll("`", "")) : null;
  const verdict = known ? element("span", { class: `verdict ${step.verdict}`, title: failure }, step.verdict) : "";
  row.querySelector(".step-verdict").replaceChildren(step?.error ? element("span", { class: "refused" }, "refused") : verdict);
  row.querySelector("meter").hidden = !known;
  row.querySelector("meter").value = known ? step.progress : 0;
  row.querySelector(".progress span").textContent = known ? shown(step.progress) : "";
  row.querySelector(".reward").textContent = known ? shown(step.reward) : "";
}

/** Return the names in the letters that this spec does not have. */
function strangers(spec, letters, mode) {
  const known = new Set(spec[mode].map(({ name }) => name));
  const used = letters.flatMap((letter) => (mode === "atoms" ? letter.atoms : Object.keys(letter.signals ?? {})));
  return [...new Set(used)].filter((name) => !known.has(name));
}

/** Warn if the trace was made for an earlier text. */
function warn(names, mode) {
  const place = byId("strange");
  place.hidden = !names.length;
  const shown = names.slice(0, MOST_NAMES).map((name) => `\`${name}\``);
  const more = names.length > shown.length ? ", …" : "";
  const text = `These steps were made for another text. They set ${shown.join(", ")}${more}, which has no effect, because the spec has no such ${mode}. Set the boxes again, or press \`Clear\`.`;
  if (names.length && place.dataset.text !== text) place.replaceChildren(...prose(text));
  place.dataset.text = text;
}

/** Return a phrase as a sentence. */
function sentence(text) {
  return `${text[0].toUpperCase()}${text.slice(1)}.`;
}

function showStep(step, length) {
  const place = byId("moment");
  if (!length) place.textContent = "There is no step yet: add one, and set what holds at it.";
  else if (!step) place.textContent = "";
  else if (step.error) place.replaceChildren(...prose(`${step.error}: ${step.help}`));
  else {
    const end = step.done ? (step.accepting ? "  An episode ends here, in success." : "  An episode ends here, in failure.") : "";
    const near = step.limiting ? `  The nearest edge towards the goal is held back by ${step.limiting}.` : "";
    place.replaceChildren(...(step.failure ? prose(sentence(step.failure)) : [step.label, near]), end);
  }
}
