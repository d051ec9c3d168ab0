"""Draw an automaton as SVG; the playground page colours it and highlights the current state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Final

from tltlc.automaton.fspa import Fspa, Notation, State
from tltlc.automaton.text import label_text
from tltlc.backends.drawing.folding import Drawing, distance_range
from tltlc.backends.drawing.picture_content import PictureContent, folded_drawing, memory_texts, picture_content
from tltlc.backends.drawing.state_rows import state_rows
from tltlc.backends.drawing.texts import escape_invisible, guards_by_arrow, wrap_text
from tltlc.backends.drawing.timers import Timer
from tltlc.diagnostics.formats.text import columns
from tltlc.interfaces.playground.curves import PicturePoint, add_bend, svg_path
from tltlc.interfaces.playground.layout import BoxSize, StateBox, layout
from tltlc.interfaces.playground.ordering import EdgeEnds
from tltlc.logic.text.counts import number_range

MOST_STATES: Final = 40
MOST_EDGES: Final = 120
"""The most states and the most edges of a picture. People cannot read a larger one."""

# Widths of characters and heights of lines in pixels, for monospaced fonts.
_LABEL_CHARACTER, _LABEL_LINE = 7.3, 17.0
_GUARD_CHARACTER, _GUARD_LINE = 6.7, 14.0
_LABEL, _GUARD, _WIDE_GUARD = 26, 22, 30
"""Characters in a line of a label, of a guard, and of a guard with more room.

A line with a longer word may have up to twice as many.
"""
_MOST_LINES: Final = 6
_LOOP: Final = 26.0
"""Height of a loop over or under its state."""
_MARGIN: Final = 20.0
_START: Final = 26.0
"""Length of the arrow into the initial state."""


def picture(fspa: Fspa, notation: Notation = "english") -> tuple[str | None, str]:
    """Return a picture of an automaton as SVG, and notes, for example about states that are folded into one.

    If the picture would have too many states or edges, return None and a note that says so.

    States are groups with the class ``state`` and the class of their verdict; ``data-states`` has
    the number of the state, or the numbers of all states that are folded into it. Edges are groups
    with the class ``edge``, ``data-source`` and ``data-target``. The title of a state or an edge is
    its full text in words; the picture shows only the start of a long text.
    """
    drawing = folded_drawing(fspa)
    if len(drawing.states) > MOST_STATES or len(drawing.edges) > MOST_EDGES:
        return None, f"The automaton has {len(fspa.states)} states and {len(fspa.edges)} edges, too many for a picture."
    content = picture_content(fspa, drawing, notation)
    return _PictureText(fspa, content, notation).svg(), " ".join((*content.notes, *_sentences(content)))


def _sentences(content: PictureContent) -> list[str]:
    """Return the registers of the legend as sentences."""
    heading, *rows = memory_texts(content.memory) or [""]
    return [f"{heading} {'; '.join(rows)}."] if rows else []


class _PictureText:
    """Computes the SVG text of one picture: first the wrapped texts of states and edges, then the layout."""

    def __init__(self, fspa: Fspa, content: PictureContent, notation: Notation) -> None:
        drawing = content.drawing
        self.fspa, self.drawing = fspa, drawing
        self.trap = _trap(drawing)
        self.guards = content.guards
        self.titles = guards_by_arrow(drawing.edges, "english")
        self.lines = {ends: self._lines(ends) for ends in self.guards}
        self.runs = {state.id: drawing.folded.get(state.id, (state,)) for state in drawing.states}
        self.labels = {
            state: _label_lines(fspa, run, content.timers.get(state, {}), notation) for state, run in self.runs.items()
        }
        self.boxes = {state: self._box(state) for state in self.runs}
        sizes = {ends: _size(lines) for ends, lines in self.lines.items()}
        self.places = layout(self.boxes, sizes, (_MARGIN + _START, _MARGIN))

    def svg(self) -> str:
        """Return the picture of the automaton as SVG text."""
        width, height = self.places.width + _MARGIN, self.places.height + _MARGIN
        left, y = self._frame(0)[0], self.places.middles[0][1]
        start = f'<circle cx="{left - _START:.1f}" cy="{y:.1f}" r="3.5"/>'
        start += svg_path(add_bend(((left - _START, y),), (left, y)))
        edges = (self._edge(ends) for ends in self.guards)
        states = (self._state(state) for state in self.drawing.states)
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}"'
            f' width="{width:.0f}" height="{height:.0f}" role="group"'
            f' aria-label="The automaton of {_escape(self.fspa.name)}">'
            f'<g class="start">{start}</g>{"".join(edges)}{"".join(states)}</svg>'
        )

    def _lines(self, ends: EdgeEnds) -> list[str]:
        """Return the text of an edge, broken into lines.

        The lines are longer for loops and edges to a trap, whose texts are over or under a state,
        where there is more room.
        """
        is_wide = ends[0] == ends[1] or ends[1] == self.trap
        return _shorten(self.guards[ends], _WIDE_GUARD if is_wide else _GUARD)

    def _box(self, state: int) -> StateBox:
        lines = self.labels[state]
        width, height = max(_columns(lines) * _LABEL_CHARACTER + 30, 62.0), len(lines) * _LABEL_LINE + 32
        loop = _size(self.lines.get((state, state), []))
        fall = _size([] if self.trap in (None, state) else self.lines.get((state, self.trap), []))
        beside, under = (size[1] + margin if size[1] else 0.0 for size, margin in ((loop, _LOOP + 4), (fall, 12)))
        if state == self.trap:
            arriving = sum(target == state for _, target in self.lines)
            return StateBox(max(width, 12.0 * arriving), height, 0.0, beside, loop[0], below=True)
        return StateBox(width, height, beside, under, max(loop[0], fall[0]))

    def _frame(self, state: int) -> tuple[float, float, float, float]:
        """Return the left, top, right and bottom coordinates of the frame around a state."""
        (x, y), box = self.places.middles[state], self.boxes[state]
        return x - box.width / 2, y - box.height / 2, x + box.width / 2, y + box.height / 2

    def _state(self, state: State) -> str:
        run = self.runs[state.id]
        left, top, right, bottom = self._frame(state.id)
        number = number_range(run[0].id, run[-1].id)
        distance = distance_range(run[0].distance, run[-1].distance)
        classes = f"state {state.verdict}{' accepting' if state.accepting else ''}{' folded' if len(run) > 1 else ''}"
        title = _escape(f"State {number}, {state.verdict}: {label_text(self.fspa, run[0].id)}")
        frame = _rectangle("frame", left, top, right, bottom, 9)
        frame += _rectangle("ring", left + 4, top + 4, right - 4, bottom - 4, 6) if state.accepting else ""
        lines = self.labels[state.id]
        # The number and the distance take the first line.
        middle = (left + right) / 2, top + 21 + len(lines) * _LABEL_LINE / 2
        return (
            f'<g class="{classes}" data-states="{" ".join(str(state.id) for state in run)}" tabindex="0" role="button"'
            f' aria-label="{title}"><title>{title}</title>{frame}'
            f'<text class="number" x="{left + 10:.1f}" y="{top + 17:.1f}">{number}</text>'
            f'<text class="distance" x="{right - 10:.1f}" y="{top + 17:.1f}" text-anchor="end">{distance}</text>'
            f"{_text(lines, middle, _LABEL_LINE, 'label')}</g>"
        )

    def _edge(self, ends: EdgeEnds) -> str:
        source, target = (self.fspa.states[end] for end in ends)
        kind = ""
        if source.id != target.id and source.distance is not None:
            kind = " failing" if target.distance is None else " nearer" if target.distance < source.distance else ""
        title = _escape(f"From {source.id} to {target.id}: {'; '.join(self.titles[ends])}")
        return (
            f'<g class="edge{kind}" data-source="{ends[0]}" data-target="{ends[1]}" role="img">'
            f"<title>{title}</title>{self._arrow(ends)}</g>"
        )

    def _arrow(self, ends: EdgeEnds) -> str:
        """Return the arrow of an edge and the text of its guard, as SVG."""
        lines = self.lines[ends]
        width, height = _size(lines)
        left, top, right, bottom = self._frame(ends[0])
        x = (left + right) / 2
        if ends[0] == ends[1]:
            foot, out = (bottom, 1) if ends[0] == self.trap else (top, -1)
            turn = foot + 30 * out
            loop = svg_path(((x - 14, foot), (x - 26, turn), (x + 26, turn), (x + 14, foot)))
            return loop + _text(lines, (x, foot + (_LOOP + height / 2) * out), _GUARD_LINE, "guard")
        curve = self.places.curves[ends]
        if ends[1] != self.trap:
            return svg_path(curve) + _text(lines, self.places.texts[ends], _GUARD_LINE, "guard")
        # The arrow passes behind its text.
        background = _rectangle("behind", x - width / 2, bottom + 5, x + width / 2, bottom + 7 + height, 0)
        return svg_path(curve) + background + _text(lines, (x, bottom + 6 + height / 2), _GUARD_LINE, "guard")


def _trap(drawing: Drawing) -> int | None:
    """Return the number of the state with the verdict ``violated`` that no edge leaves; None if there is none.

    The initial state does not count.
    """
    leaving = {edge.source for edge in drawing.edges if edge.source != edge.target}
    traps = (state.id for state in drawing.states if state.verdict == "violated" and state.id not in leaving)
    return next((state for state in traps if state), None)


def _label_lines(fspa: Fspa, run: Sequence[State], timers: Mapping[str, Timer], notation: Notation) -> list[str]:
    heading = [f"{len(run)} more like these"] if len(run) > 1 else []
    rows = state_rows(fspa, run, timers, notation)
    return [*heading, *(line for row in rows for line in _shorten([row], _LABEL))]


def _shorten(texts: Sequence[str], width: int) -> list[str]:
    """Wrap texts to at most ``_MOST_LINES`` lines of about ``width`` characters.

    No line has more than ``2 * width`` characters. An ellipsis stands for text that is left out.
    """
    lines = [line for text in texts for line in wrap_text(text, width, _MOST_LINES)]
    if len(lines) > _MOST_LINES:
        lines = [*lines[: _MOST_LINES - 1], "…"]
    return [line if len(line) <= 2 * width else f"{line[: 2 * width - 1]}…" for line in lines]


def _size(lines: Sequence[str]) -> BoxSize:
    return _columns(lines) * _GUARD_CHARACTER, len(lines) * _GUARD_LINE


def _columns(lines: Sequence[str]) -> int:
    return max(map(columns, lines), default=0)


def _rectangle(kind: str, left: float, top: float, right: float, bottom: float, radius: int) -> str:
    size = f'width="{right - left:.1f}" height="{bottom - top:.1f}"'
    return f'<rect class="{kind}" x="{left:.1f}" y="{top:.1f}" {size} rx="{radius}"/>'


def _text(lines: Sequence[str], middle: PicturePoint, height: float, kind: str) -> str:
    x, first = middle[0], middle[1] - (len(lines) - 1) * height / 2 + 4
    spans = (f'<tspan x="{x:.1f}" y="{first + i * height:.1f}">{_escape(line)}</tspan>' for i, line in enumerate(lines))
    return f'<text class="{kind}" text-anchor="middle">{"".join(spans)}</text>'


def _escape(text: str) -> str:
    return escape(escape_invisible(text))
