// Show what a spec asks for in words, and its automaton as a picture.

import { byId, element } from "./dom.js";

let svg = null;
let drawn = "";

/** Show a spec. `choose` is called with the name of another spec, `pick` with the number of a clicked state. */
export function show(spec, specs, choose, pick) {
  for (const id of ["meaning", "automaton"]) byId(id).hidden = false;
  byId("specs").replaceChildren(
    ...(specs.length > 1 ? specs : []).map((name) =>
      element("button", { type: "button", "aria-pressed": String(name === spec.name), click: () => choose(name) }, name),
    ),
  );
  byId("english").replaceChildren(...english(spec));
  draw(spec, pick);
}

/** Mark what is shown as that of an earlier text, or as current. A trace of an earlier text cannot be continued. */
export function stale(is) {
  byId("trace").inert = is;
  for (const id of ["meaning", "automaton", "trace"]) byId(id).classList.toggle("stale", is);
}

function english({ name, doc, formula, explanation, failures }) {
  const { outline, exclusive, ending, limit_steps: limit } = explanation;
  const nodes = [element("h2", {}, name)];
  if (doc) nodes.push(element("p", { class: "doc" }, doc));
  if (outline) {
    nodes.push(...reach(outline.goals));
    nodes.push(...list("Throughout:", outline.throughout), ...list("Again and again:", outline.recurring));
    nodes.push(...list(outline.goals.length + outline.throughout.length ? "And:" : "It asks for this:", outline.others));
  } else {
    nodes.push(element("p", {}, formula.english));
  }
  nodes.push(...list("It is broken for good by:", failures));
  const more = [
    ...list("Never at the same step:", exclusive.map((group) => group.join(", "))),
    element("p", {}, ending, limit === null ? "" : ` The limit is ${limit} steps.`),
    element("p", {}, element("code", { class: "formula" }, formula.unicode)),
  ];
  nodes.push(element("details", {}, element("summary", {}, "When it ends, and the formula"), more));
  return nodes;
}

function reach(rows) {
  const linked = ({ text, together }, index) => (index ? (together ? `then or at the same step ${text}` : `then ${text}`) : text);
  if (rows.length !== 1) return list("Reach each of these, in any order:", rows.map((goals) => goals.map(linked).join(", ")));
  const [goals] = rows;
  if (goals.length === 1) return list("Reach:", [goals[0].text]);
  const items = goals.map((goal) => element("li", {}, goal.together ? "at the same step or later, " : "", goal.text));
  return [element("p", {}, "Reach, in this order:"), element("ol", {}, items)];
}

function list(title, items) {
  return items.length ? [element("p", {}, title), element("ul", {}, items.map((item) => element("li", {}, item)))] : [];
}

function draw({ picture, note, name }, pick) {
  byId("note").textContent = note;
  byId("note").hidden = !note;
  if (drawn === picture && svg?.isConnected) return;
  drawn = picture;
  svg = null;
  if (!picture) {
    byId("picture").replaceChildren();
    return;
  }
  svg = document.importNode(new DOMParser().parseFromString(picture, "image/svg+xml").documentElement, true);
  for (const group of svg.querySelectorAll(".state")) {
    const act = () => pick(Number(group.dataset.states.split(" ")[0]));
    group.addEventListener("click", act);
    group.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      act();
    });
  }
  // The picture shrinks to fit, but stays readable.
  svg.style.minWidth = `${0.65 * svg.width.baseVal.value}px`;
  byId("picture").replaceChildren(svg);
}

/** Highlight the current state and the edge that led to it, and outline the clicked state. */
export function light(current, edge, picked) {
  if (!svg) return;
  const groupOf = (state) => [...svg.querySelectorAll(".state")].find((group) => group.dataset.states.split(" ").includes(String(state)));
  const first = (state) => groupOf(state)?.dataset.states.split(" ")[0];
  for (const group of svg.querySelectorAll(".state")) {
    group.classList.toggle("current", group === groupOf(current));
    group.classList.toggle("picked", picked !== null && group === groupOf(picked));
    group.setAttribute("aria-pressed", String(picked !== null && group === groupOf(picked)));
  }
  for (const group of svg.querySelectorAll(".edge")) {
    const { source, target } = group.dataset;
    group.classList.toggle("taken", edge !== null && source === first(edge[0]) && target === first(edge[1]));
  }
}

/** Show what remains in a state in words; if the picture is in symbols, also as a formula. */
export function showState(state, notation) {
  if (!state) {
    byId("state").replaceChildren(element("p", { class: "quiet" }, "Click a state to see what remains there."));
    return;
  }
  const { id, verdict, distance, label, leads } = state;
  const way = distance === null ? "no way to the goal" : distance ? `${distance} step${distance === 1 ? "" : "s"} to the goal` : "it is a goal";
  byId("state").replaceChildren(
    element("h3", {}, `State ${id} `, element("span", { class: `verdict ${verdict}` }, verdict), ` ${way}`),
    element("p", {}, label.english),
    notation === "unicode" ? element("p", {}, element("code", { class: "formula" }, label.unicode)) : "",
    ...list("What leads on:", leads.map((lead) => `${lead.when} (to state ${lead.state})`)),
  );
}
