// The text editor: colours, line numbers, and underlines at the places of messages.

import { byId, element, prose } from "./dom.js";

const TOKEN = /\/\/\/[^\n]*|\/\/[^\n]*|"[^"\n]*"?|\d+(?:\.\d+)?|[A-Za-z_][A-Za-z0-9_]*|\s+|[^\s]/g;
/** Characters; colouring a longer text would take too long at each keystroke. */
const MOST_COLOURED = 50_000;
const BEFORE_BOUND = new Set(["eventually", "always", "next", "once", "historically"]);

let words = new Set();
let units = new Set();
let marks = [];

/** Start the editor; `typed` is called after each change of the text. */
export function begin(start, typed) {
  words = new Set(start.words);
  units = new Set(start.units);
  byId("text").readOnly = false;
  byId("text").addEventListener("input", () => {
    // The messages belong to the text before the change, so their places may be wrong now.
    byId("messages").inert = true;
    marks = [];
    paint();
    typed();
  });
}

export const text = () => byId("text").value;

export function setText(value) {
  byId("text").value = value;
  byId("text").setSelectionRange(0, 0);
  byId("editor").scrollTo(0, 0);
  marks = [];
  paint();
}

/** Show diagnostics: underlined in the text, and as a list below it. */
export function show(diagnostics) {
  const length = text().length;
  marks = diagnostics.flatMap(({ severity, labels }) =>
    labels
      .filter((label) => label.start !== null)
      .map((label, index) => {
        const end = Math.min(Math.max(label.end, label.start + 1), length);
        return { start: Math.min(label.start, end - 1), end, kind: index ? "also" : severity };
      }),
  );
  paint();
  byId("text").setAttribute("aria-invalid", String(diagnostics.some(({ severity }) => severity === "error")));
  byId("messages").inert = false;
  byId("messages").replaceChildren(...diagnostics.map(message));
}

function message({ code, severity, title, help, labels, fixes }) {
  const places = labels.map((label) =>
    element(
      "div",
      { class: "place" },
      label.start === null
        ? element("span", {}, `${label.file}:${label.line}:${label.column}`)
        : element("button", { type: "button", click: () => select(label) }, `line ${label.line}`),
      " ",
      ...prose(label.message),
    ),
  );
  return element(
    "li",
    { class: severity },
    element("strong", {}, severity),
    " ",
    ...prose(title),
    element("span", { class: "code quiet" }, ` ${code}`),
    places,
    help ? element("div", { class: "help" }, ...prose(help)) : null,
    fixes.map((fix) => element("button", { type: "button", class: "fix", click: () => mend(fix.edits) }, ...prose(fix.title))),
  );
}

/** Apply the edits of a fix as if the user typed them, so that they can be undone. */
function mend(edits) {
  const area = byId("text");
  area.focus();
  for (const { start, end, text: written } of edits.toReversed()) {
    area.setSelectionRange(start, end);
    document.execCommand(written ? "insertText" : "delete", false, written);
  }
}

function select({ start, end }) {
  const area = byId("text");
  area.focus();
  area.setSelectionRange(start, end);
}

function paint() {
  const value = text();
  const marked = stretches();
  const painted = [];
  let next = 0;
  for (const { start, piece, kind } of value.length > MOST_COLOURED ? [{ start: 0, piece: value, kind: "" }] : tokens(value)) {
    const end = start + piece.length;
    for (let from = start, to; from < end; from = to) {
      while (next < marked.length && marked[next].end <= from) next += 1;
      const stretch = marked[next];
      const over = stretch && stretch.start <= from ? `mark ${stretch.kind}` : "";
      to = Math.min(end, over ? stretch.end : (stretch?.start ?? end));
      const classes = [kind, over].filter(Boolean).join(" ");
      const slice = value.slice(from, to);
      painted.push(classes ? element("span", { class: classes }, slice) : slice);
    }
  }
  byId("backdrop").replaceChildren(...painted, "\n");
  byId("gutter").textContent = Array.from(value.split("\n"), (_, index) => index + 1).join("\n");
}

/** Return the marks as ranges that do not overlap, in order. Where marks overlap, the first one is used. */
function stretches() {
  const cuts = [...new Set(marks.flatMap(({ start, end }) => [start, end]))].sort((a, b) => a - b);
  return cuts.slice(1).flatMap((end, index) => {
    const start = cuts[index];
    const over = marks.find((mark) => mark.start <= start && end <= mark.end);
    return over ? [{ start, end, kind: over.kind }] : [];
  });
}

function* tokens(value) {
  let before = "";
  for (const { 0: piece, index } of value.matchAll(TOKEN)) {
    yield { start: index, piece, kind: kindOf(piece, before, value.slice(index + piece.length, index + piece.length + 3), value, index) };
    if (piece.trim()) before = piece;
  }
}

function kindOf(piece, before, after, value, index) {
  if (piece.startsWith("///")) return "doc";
  if (piece.startsWith("//")) return "comment";
  if (piece.startsWith('"')) return "string";
  if (/^\d/.test(piece)) return "number";
  if (/^\d/.test(before) && units.has(piece)) return "unit";
  if (words.has(piece)) return "word";
  if (/^(within|for|after)$/.test(piece) && BEFORE_BOUND.has(before)) return "word";
  if (piece === "for" && before.startsWith('"')) return "word";
  if (piece === "is" && /[\w)]$/.test(before) && !words.has(before) && /^\s+\w/.test(after)) return "word";
  if (piece === "in" && /^\s*[[(]/.test(after)) return "word";
  if (/^(step|expect)$/.test(piece) && /(^|\n)[ \t]*$/.test(value.slice(Math.max(0, index - 40), index))) return "word";
  return "";
}
