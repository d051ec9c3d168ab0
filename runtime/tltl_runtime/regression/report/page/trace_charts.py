"""Draw recorded traces: the values of the atoms over time, with the states of the automaton.

Each atom has a row with the curve of its values, from -1 to 1. The row is coloured where the atom holds.
Functions draw the SVG, not templates, because nearly every attribute is computed.
"""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Final

from markupsafe import Markup

from tltl_runtime.regression.explain.stages import is_opposite_asked
from tltl_runtime.regression.explain.trace_ends import step_text
from tltl_runtime.regression.report.page.render import render
from tltl_runtime.regression.report.trace_curves import TraceCurves
from tltl_runtime.support.markup import coordinate, element
from tltlc.api import EMPTY, Fspa, label_text, record

_WIDTH: Final = 860
_LEFT: Final = 170
_RIGHT: Final = 26
_LAST_STATE: Final = 20
"""The least width of the box of the last state, which may reach into the right margin."""
_ROW: Final = 26
_STATES: Final = 22
_AXIS: Final = 30
_LONGEST_NAME: Final = 24
"""Longer names of atoms are cut; their tooltip has the whole name."""

_MOST_POINTS: Final = 1_500
"""The greatest number of samples that a row shows one by one.

The samples of a longer trace are drawn in groups. The least and the greatest value of each group are drawn,
so that no short change is lost.
"""


@record
class _Chart:
    """The picture of a recorded trace or episode; ``anchor`` is its address within the page.

    ``ended`` says in words how the trace or episode ended. ``film`` is the film of an episode, WebP in
    base64; it is empty if there is none.
    """

    anchor: str
    name: str
    is_episode: bool
    ended: str
    picture: Markup
    film: str


def trace_charts(
    fspa: Fspa, traces: Mapping[int, TraceCurves], slug: str, films: Mapping[int, bytes] = EMPTY
) -> Markup:
    """Return the pictures of recorded traces or episodes as HTML: those that failed, then those that were accepted.

    Each is below its film if there is one.

    ``traces`` and ``films`` (WebP) are by index. ``slug`` is the case's short name in addresses within
    the page.
    """
    charts = [
        _Chart(
            anchor=anchor(slug, index),
            name=curves.name,
            is_episode=curves.kind == "episode",
            ended=curves.ended,
            picture=_chart(fspa, curves),
            film=base64.b64encode(films.get(index, b"")).decode(),
        )
        for index, curves in sorted(traces.items(), key=lambda item: (item[1].is_accepted, item[0]))
    ]
    return render("trace_charts.html", charts=charts)


def anchor(slug: str, index: int) -> str:
    """Return the address of the picture of a trace within the page: ``trace:navigation-v1:3``."""
    return f"trace:{slug}:{index}"


def _chart(fspa: Fspa, curves: TraceCurves) -> Markup:
    height = _STATES + _ROW * len(fspa.atoms) + _AXIS
    parts = [element("title", f"{curves.name}: states and atoms over {curves.steps} steps")]
    parts += _state_strip(fspa, curves)
    for row, atom in enumerate(fspa.atoms):
        # The row of a goal such as `x >= 7` shows this comparison, and not the atom that the compiler made of it.
        values, top = [values[row] for values in curves.atoms], _STATES + _ROW * row
        holds = [value > 0.0 for value in values]
        if atom.opposite is not None and is_opposite_asked(fspa, row):
            # At 0, the opposite holds.
            parts += _atom_row(atom.opposite, [-value for value in values], [not held for held in holds], top)
        else:
            parts += _atom_row(atom.name, values, holds, top)
    parts += _axis(fspa, curves.steps, height - _AXIS)
    return element("svg", *parts, class_="diagram trace", viewBox=f"0 0 {_WIDTH} {height}", role="img")


def _x(step: float, steps: int) -> float:
    return _LEFT + step / max(1, steps) * (_WIDTH - _LEFT - _RIGHT)


def _state_strip(fspa: Fspa, curves: TraceCurves) -> Iterator[Markup]:
    """Yield the SVG of a strip with a box for each stay in a state.

    A box contains the number of the state if it is wide enough.
    """
    yield element("text", "state", class_="tick y", x=_LEFT - 6, y=15)
    size = _group_size(curves.steps)
    # A sample is drawn with the state that it leads to, so that the last state can be seen, too.
    stays = [(arrival.state, max(0, arrival.step - 1)) for arrival in curves.arrivals]
    # Of several stays that begin in a group of samples, the last one is drawn.
    starts = [*{start // size: (state, start) for state, start in stays}.values(), (0, curves.steps)]
    for (state, start), (_, end) in pairwise(starts):
        left, right = _x(start, curves.steps), _x(end, curves.steps)
        if end == curves.steps:
            # The last state is often entered at the last sample, and would be too narrow to be seen.
            right = max(right, left + _LAST_STATE)
        title = element("title", f"state {state}, from {step_text(fspa, start + 1)}: {label_text(fspa, state)}")
        box = {"x": coordinate(left), "width": coordinate(max(0.5, right - left)), "y": 2, "height": _STATES - 6}
        kind = fspa.states[state].verdict
        yield element("rect", title, class_=f"stay {kind} {'odd' if state % 2 else 'even'}", **box)
        if right - left > 14:
            middle = coordinate((left + right) / 2)
            yield element("text", str(state), class_="stay-name", x=middle, y=15)


def _atom_row(name: str, values: Sequence[float], holds: Sequence[bool], top: int) -> Iterator[Markup]:
    """Yield the SVG of an atom's row: its name, its zero line, a box wherever it holds, and its curve.

    ``values`` are the atom's values at the samples, and ``holds`` says at which of them it holds. ``top`` is
    the upper edge of the row.
    """
    steps, zero, height = len(values), top + _ROW / 2, _ROW / 2 - 2
    short = name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 1]}…"
    label_y = coordinate(zero + 4)
    yield element("text", element("title", name), short, class_="tick y", x=_LEFT - 6, y=label_y)
    y = coordinate(zero)
    yield element("line", class_="grid", x1=_LEFT, x2=_WIDTH - _RIGHT, y1=y, y2=y)
    points = list(_points(values))
    for first, last in _stretches(holds):
        left, width = _x(first, steps), _x(last, steps) - _x(first, steps)
        when = f"at step {last}" if last == first + 1 else f"from step {first + 1} to {last}"
        box = {"x": coordinate(left), "width": coordinate(max(0.5, width)), "y": top + 2, "height": _ROW - 4}
        yield element("rect", element("title", f"{name} holds {when}"), class_="holds", **box)
    path = " ".join(f"{coordinate(_x(step, steps))},{coordinate(zero - height * value)}" for step, value in points)
    yield element("polyline", class_="atom", points=path)


def _stretches(holds: Sequence[bool]) -> Iterator[tuple[int, int]]:
    """Yield the runs of samples at which an atom ``holds``, as (first, last + 1).

    In a trace whose samples are drawn in groups, an atom counts as holding in a whole group if it
    holds at one of its samples.
    """
    size = _group_size(len(holds))
    start = None
    for group in range(0, len(holds) + size, size):
        is_held = any(holds[group : group + size])
        if is_held and start is None:
            start = group
        elif not is_held and start is not None:
            yield start, min(group, len(holds))
            start = None


def _group_size(steps: int) -> int:
    """Return how many samples are drawn as one group, so that a row has at most ``_MOST_POINTS`` groups."""
    return max(1, -(-steps // _MOST_POINTS))


def _points(values: Sequence[float]) -> Iterator[tuple[float, float]]:
    """Yield the corners (step, value) of the curve of ``values``, which is constant between two samples."""
    size = _group_size(len(values))
    for start in range(0, len(values), size):
        group = values[start : start + size]
        end = min(start + size, len(values))
        for value in dict.fromkeys((min(group), max(group))):
            yield float(start), value
        yield float(end), group[-1]


def _axis(fspa: Fspa, steps: int, top: int) -> Iterator[Markup]:
    """Yield the time axis: in seconds if the spec has a clock, else in steps."""
    step_s = fspa.clock_s or 1.0
    end = steps * step_s
    spacings = (unit * 10.0**exponent for exponent in range(-4, 9) for unit in (1, 2, 5))
    spacing = next(spacing for spacing in spacings if spacing >= max(end / 8, step_s))
    for tick in range(int(end / spacing + 1e-9) + 1):
        x = coordinate(_x(tick * spacing / step_s, steps))
        yield element("line", class_="grid", x1=x, x2=x, y1=0, y2=top)
        yield element("text", f"{tick * spacing:g}", class_="tick x", x=x, y=top + 14)
    label = "time, s" if fspa.clock_s else "step"
    yield element("text", label, class_="tick x", x=coordinate((_LEFT + _WIDTH - _RIGHT) / 2), y=top + 27)
