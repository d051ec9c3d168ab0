"""The automaton as a Graphviz graph, drawn like Fig. 3 of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from tltlc.automaton.fspa import Edge, Fspa, State, Verdict
from tltlc.backends import Files, Options, Target
from tltlc.backends.drawing.folding import Drawing, span, whole
from tltlc.backends.drawing.texts import Guards, label, visible, wrapped

if TYPE_CHECKING:
    from graphviz import Digraph

TARGET = Target("dot", "a graph for Graphviz", (".dot",))

LINES: dict[Verdict, str] = {
    "satisfied": "#15803d",
    "holding": "#16a34a",
    "pending": "#475569",
    "violated": "#dc2626",
}
"""Colour of the outline and of the corner mark by verdict; the interior is a pale shade of it."""

FILLS: dict[Verdict, str] = {
    "satisfied": "#dcfce7",
    "holding": "#f0fdf4",
    "pending": "#f8fafc",
    "violated": "#fef2f2",
}

Detail = Literal["full", "labels", "sketch"]
"""What the drawing shows: everything; no guards; states by their number alone, for a layout by forces."""

LABEL_WIDTH, GUARD_WIDTH = 30, 22
LONGEST_TOOLTIP = 2000
"""In characters: Graphviz reads no string of more than 16 KiB, in which one may take seven."""

FONT = "Helvetica,Arial,sans-serif"
GRAPH = {"rankdir": "LR", "bgcolor": "white", "pad": "0.2", "nodesep": "0.45", "ranksep": "0.7", "tooltip": " "}
DENSE_FROM = 30
"""Edges, each with a guard to be placed, from which on the layers get twice as tall as need be."""
DENSE = {"nodesep": "0.2"}
SKETCH = {"overlap": "prism", "K": "1.2", "splines": "line", "outputorder": "edgesfirst"}
NODE = {
    "shape": "box",
    "style": "rounded,filled",
    "margin": "0.04,0.04",
    "penwidth": "1.4",
    "fontname": FONT,
    "fontsize": "13",
    "fontcolor": "#0f172a",
}
EDGE = {"color": "#64748b", "arrowsize": "0.75", "fontname": FONT, "fontsize": "11", "fontcolor": "#334155"}


def emit(fspa: Fspa, options: Options) -> Files:
    """``NAME.dot``."""
    return {f"{fspa.name}.dot": graph(fspa, options)}


def graph(fspa: Fspa, options: Options, drawing: Drawing | None = None, detail: Detail = "full") -> str:
    """The DOT text of a drawing, that of everything if none is given.

    Each state shows its label and, as a mark in its upper right corner, its distance.  Accepting
    states are green with a double outline, traps red, and folded ones dashed.  Over infinite traces, the pairs that
    name an edge stand behind its guard: ``a [inf 0]``.
    """
    from graphviz import Digraph

    drawing = drawing or whole(fspa)
    texts = Guards(fspa, options.notation)
    title = {"label": _title(fspa, drawing), "labelloc": "t", "labeljust": "l"}
    dense = DENSE if len(drawing.edges) > DENSE_FROM else {}
    sketch = SKETCH if detail == "sketch" else {}
    drawn = Digraph(visible(fspa.name), graph_attr={**GRAPH, **title, **dense, **sketch})
    drawn.attr("node", **NODE)
    drawn.attr("edge", **EDGE)
    drawn.node("start", shape="point", style="filled", width="0.09", color="#475569", tooltip="start")
    for state in drawing.states:
        run = drawing.folded.get(state.id, (state,))
        _draw_state(
            drawn, run, span(*(label(end.label, options.notation) for end in (run[0], run[-1]))), detail != "sketch"
        )
    drawn.edge("start", "0")
    for edge in drawing.edges:
        _draw_edge(drawn, fspa, edge, texts.text(edge.guard.text), detail == "full")
    return str(drawn.source)


def _title(fspa: Fspa, drawing: Drawing) -> str:
    lines = [f"<B>{_html(fspa.name)}</B>"]
    if fspa.doc.strip():
        lines += map(_html, wrapped(fspa.doc, 100, 3))
    if drawing.folded:
        inside = sum(map(len, drawing.folded.values()))
        note = f"Dashed: {inside} of the {len(fspa.states)} states, folded."
        lines.append(f'<FONT COLOR="#64748b">{note}</FONT>')
    text = "".join(f'{line}<BR ALIGN="LEFT"/>' for line in lines)
    return f'<<FONT FACE="{FONT}" POINT-SIZE="13" COLOR="#0f172a">{text}</FONT>>'


def _draw_state(drawn: Digraph, run: tuple[State, ...], text: str, full: bool) -> None:
    """A state, or with a dashed outline the inner states of a run, which ``text`` spans."""
    state, last = run[0], run[-1]
    line, fill = LINES[state.verdict], FILLS[state.verdict]
    distance = span(*("∞" if end.distance is None else str(end.distance) for end in (state, last)))
    name = f"state {state.id}" if state is last else f"{len(run)} states, {state.id} to {last.id}"
    lines = list(map(_html, wrapped(text, LABEL_WIDTH))) if full else [f"<B>{state.id}</B>"]
    manner = {"peripheries": "2"} if state.accepting else {}
    if state is not last:
        lines = [f"<I>{len(run)} more like these</I>", *lines] if full else [f"<B>{state.id}…{last.id}</B>"]
        manner["style"] = f"{NODE['style']},dashed"
    body = "<BR/>".join(lines)
    mark = f'<FONT COLOR="white" POINT-SIZE="10"><B> {distance} </B></FONT>'
    # A cell gets its share of the width that the label asks for: one column of twelve keeps the mark small.
    html = (
        f'<<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="1"><TR><TD COLSPAN="11"></TD>'
        f'<TD BGCOLOR="{line}" STYLE="ROUNDED">{mark}</TD></TR>'
        f'<TR><TD COLSPAN="12" CELLPADDING="6">{body}</TD></TR></TABLE>>'
    )
    tip = _plain(f"{name}, {state.verdict}, distance {distance}: {text}")
    drawn.node(str(state.id), label=html, color=line, fillcolor=fill, tooltip=tip, **manner)


def _draw_edge(drawn: Digraph, fspa: Fspa, edge: Edge, text: str, full: bool) -> None:
    attributes = {"tooltip": _plain(text), **_manner(fspa.states[edge.source], fspa.states[edge.target])}
    if full:
        lines = "<BR/>".join(map(_html, wrapped(text, GUARD_WIDTH)))
        attributes["label"] = f'<<TABLE BORDER="0" CELLBORDER="0" CELLPADDING="3"><TR><TD>{lines}</TD></TR></TABLE>>'
    drawn.edge(str(edge.source), str(edge.target), **attributes)


def _manner(source: State, target: State) -> dict[str, str]:
    """How an edge is drawn: progress is dark and kept straight, ways into a trap are pale red and give way."""
    if source.id == target.id:
        # Nothing leaves a state that is final: its loop is out of the way on the right, where no edge arrives.
        return {"headport": "e", "tailport": "e"} if source.verdict in ("satisfied", "violated") else {}
    if source.distance is None:
        return {}
    if target.distance is None:
        return {"color": "#f87171", "weight": "0"}
    return {"color": "#0f172a", "penwidth": "1.5", "weight": "8"} if target.distance < source.distance else {}


def _plain(text: str) -> str:
    """A text that means itself: no escapes, and no markup though it may look like it."""
    from graphviz import escape

    # A subclass of str says so: made a bare str again, "<b>" would be markup.
    text = visible(text)
    plain: str = escape(text if len(text) <= LONGEST_TOOLTIP else f"{text[:LONGEST_TOOLTIP]} …")
    return plain


def _html(text: str) -> str:
    """Text inside an HTML-like label."""
    escaped = visible(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return escaped.replace('"', "&quot;").replace("[", "&#91;").replace("]", "&#93;")
