"""The automaton as a Graphviz graph, in the style of Fig. 3 of Gutiérrez-Sánchez et al. 2024."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

from tltlc.automaton.fspa import Fspa, State, Verdict
from tltlc.backends import Files, Options, Target
from tltlc.backends.drawing.folding import Drawing, distance_range, whole_drawing
from tltlc.backends.drawing.html_like import BACKED, LEFT, escape_html, literal_text, table
from tltlc.backends.drawing.picture_content import MOST_ROWS, PictureContent, distance_note, more_rows, picture_content
from tltlc.backends.drawing.state_rows import full_label, state_rows
from tltlc.backends.drawing.texts import escape_invisible, wrap_text
from tltlc.backends.drawing.timers import MemoryRow

if TYPE_CHECKING:
    from graphviz import Digraph

TARGET = Target("dot", "a graph for Graphviz", (".dot",))

LINES: dict[Verdict, str] = {
    "satisfied": "#15803d",
    "holding": "#16a34a",
    "pending": "#475569",
    "violated": "#dc2626",
}
"""The colour of a state's outline and distance mark, by verdict; ``FILLS`` has a pale shade for the inside."""

FILLS: dict[Verdict, str] = {
    "satisfied": "#dcfce7",
    "holding": "#f0fdf4",
    "pending": "#f8fafc",
    "violated": "#fef2f2",
}

Detail = Literal["full", "labels", "sketch"]
"""What the drawing shows.

``full`` shows everything, ``labels`` everything except guards, and ``sketch`` only the numbers of
states, for a force-directed layout.
"""

LABEL_WIDTH, WIDE_LABEL_WIDTH, GUARD_WIDTH, WIDE_GUARD_WIDTH = 30, 42, 22, 32
MOST_GUARDS = 24
"""The most guards on one arrow; if there are more, the arrow says how many more."""
TITLE_WIDTH = 100

FONT = "Helvetica,Arial,sans-serif"
GRAPH = {
    "rankdir": "LR",
    "bgcolor": "white",
    "pad": "0.2",
    "nodesep": "0.45",
    "ranksep": "0.7",
    "tooltip": " ",
    "labelloc": "t",
    "labeljust": "l",
    "fontname": FONT,
    "fontsize": "13",
    "fontcolor": "#0f172a",
}
DENSE_FROM = 30
"""Above this number of edges, states are drawn closer together, because the picture would be too tall otherwise."""
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
    """Return the file ``NAME.dot`` with the whole automaton, where NAME is the name of the automaton."""
    return {f"{fspa.name}.dot": graph(fspa, options)}


def graph(fspa: Fspa, options: Options, drawing: Drawing | None = None, detail: Detail = "full") -> str:
    """Return the DOT text of a drawing, by default of the whole automaton.

    Each state shows its label and, as a mark in its upper right corner, its distance. Accepting
    states are green with a double outline, traps are red, and folded states are dashed. All edges
    from one state to another share an arrow. Over infinite traces an arrow may have several guards,
    each followed by the sets of Rabin pairs that contain its edge: ``a [inf 0]``.
    """
    from graphviz import Digraph

    content = picture_content(fspa, drawing or whole_drawing(fspa), options.notation)
    drawing = content.drawing
    dense = DENSE if len(drawing.edges) > DENSE_FROM else {}
    sketch = SKETCH if detail == "sketch" else {}
    drawn = Digraph(
        escape_invisible(fspa.name), graph_attr={**GRAPH, "label": _title(fspa, content), **dense, **sketch}
    )
    drawn.attr("node", **NODE)
    drawn.attr("edge", **EDGE)
    drawn.node("start", shape="point", style="filled", width="0.09", color="#475569", tooltip="start")
    for state in drawing.states:
        run = drawing.folded.get(state.id, (state,))
        rows = state_rows(fspa, run, content.timers.get(state.id, {}), options.notation)
        _draw_state(drawn, run, rows, full_label(fspa, run, options.notation), detail != "sketch")
    drawn.edge("start", "0")
    for (source, target), guards in content.guards.items():
        _draw_arrow(drawn, fspa.states[source], fspa.states[target], guards, detail == "full")
    return str(drawn.source)


def _title(fspa: Fspa, content: PictureContent) -> str:
    """Return the title of the graph, as an HTML-like label: the spec's name, its documentation, and a legend."""
    texts = (_legend(fspa, content.drawing), *content.notes)
    legend = [line for note in texts for line in wrap_text(note, TITLE_WIDTH)]
    lines = [f"<B>{escape_html(fspa.name)}</B>"]
    if fspa.doc.strip():
        lines += map(escape_html, wrap_text(fspa.doc, TITLE_WIDTH, 3))
    lines += map(_grey, legend)
    lines += [_memory(content.memory)] if content.memory else []
    lines.append('<FONT POINT-SIZE="6">&#160;</FONT>')  # space above the states
    return f"<{table(lines, LEFT, spacing=2)}>"


def _memory(memory: Sequence[MemoryRow]) -> str:
    """Return the table of the registers: what each is about, its kind, its maximum and its first value."""
    rows = [("Memory", "kind", "at most", "at the start")]
    rows += [(row.name, row.kind, row.maximum, row.initial) for row in memory[:MOST_ROWS]]
    rows += [(text, "", "", "") for text in more_rows(memory)]
    cells = ("".join(f"{LEFT}{_grey(wrap_text(cell, TITLE_WIDTH)[0])}</TD>" for cell in row) for row in rows)
    inside = "".join(f"<TR>{row}</TR>" for row in cells)
    return f'<TABLE BORDER="0" CELLBORDER="0" CELLPADDING="1" CELLSPACING="3">{inside}</TABLE>'


def _grey(text: str) -> str:
    return f'<FONT COLOR="#64748b" POINT-SIZE="11">{escape_html(text)}</FONT>' if text else ""


def _legend(fspa: Fspa, drawing: Drawing) -> str:
    nearer = any(_is_nearer(fspa.states[edge.source], fspa.states[edge.target]) for edge in drawing.edges)
    return distance_note(drawing, "Corner", "double outline") + " Bold arrows come nearer." * nearer


def _draw_state(drawn: Digraph, run: tuple[State, ...], rows: Sequence[str], text: str, full: bool) -> None:
    """Add a state to the graph ``drawn``: with its ``rows`` if ``full``, and otherwise only with its number.

    ``text`` is its label, for the tooltip.

    If ``run`` has several states, they are folded: they become one state with a dashed outline.
    """
    state, last = run[0], run[-1]
    line, fill = LINES[state.verdict], FILLS[state.verdict]
    distance = distance_range(state.distance, last.distance)
    name = f"state {state.id}" if state is last else f"{len(run)} states, {state.id} to {last.id}"
    width = LABEL_WIDTH if len(rows) == 1 else WIDE_LABEL_WIDTH
    lines = [line for row in rows for line in wrap_text(row, width)]
    body = "<BR/>".join(map(escape_html, lines)) if full else f"<B>{state.id}</B>"
    style = {"peripheries": "2"} if state.accepting else {}
    if state is not last:
        body = table([f"<I>{len(run)} more like these</I>", body]) if full else f"<B>{state.id}…{last.id}</B>"
        style["style"] = f"{NODE['style']},dashed"
    mark = f'<FONT COLOR="white" POINT-SIZE="10"><B> {distance} </B></FONT>'
    # All columns of the table have the same width. The mark takes only one of twelve, so that it stays small.
    html = (
        f'<<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="1"><TR><TD COLSPAN="11"></TD>'
        f'<TD BGCOLOR="{line}" STYLE="ROUNDED">{mark}</TD></TR>'
        f'<TR><TD COLSPAN="12" CELLPADDING="6">{body}</TD></TR></TABLE>>'
    )
    tip = literal_text(f"{name}, {state.verdict}, distance {distance}: {text}")
    drawn.node(str(state.id), label=html, color=line, fillcolor=fill, tooltip=tip, **style)


def _draw_arrow(drawn: Digraph, source: State, target: State, guards: Sequence[str], full: bool) -> None:
    attributes = {"tooltip": literal_text("; ".join(guards)), **_edge_style(source, target)}
    if full:
        width = GUARD_WIDTH if len(guards) == 1 else WIDE_GUARD_WIDTH
        rows = ["<BR/>".join(map(escape_html, wrap_text(guard, width))) for guard in guards[:MOST_GUARDS]]
        rest = len(guards) - len(rows)
        rows += [f"and {rest} more"] if rest else []
        attributes["label"] = f"<{table(rows, BACKED, spacing=4)}>"
    drawn.edge(str(source.id), str(target.id), **attributes)


def _edge_style(source: State, target: State) -> dict[str, str]:
    """Return the Graphviz attributes of an edge that determine its style.

    Edges to a state with a smaller distance are bold and straight. Edges that enter a trap from
    another kind of state are pale red and may bend.
    """
    if source.id == target.id:
        # The only edge that leaves a satisfied or violated state is its loop: draw it on the right, where no edge
        # arrives.
        return {"headport": "e", "tailport": "e"} if source.verdict in ("satisfied", "violated") else {}
    if source.distance is not None and target.distance is None:
        return {"color": "#f87171", "weight": "0"}
    return {"color": "#0f172a", "penwidth": "1.5", "weight": "8"} if _is_nearer(source, target) else {}


def _is_nearer(source: State, target: State) -> bool:
    return source.distance is not None and target.distance is not None and target.distance < source.distance
