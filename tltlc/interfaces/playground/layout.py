"""Place the states of a small automaton and the texts of its edges without overlaps.

Columns of states alternate with columns of edge texts. A *node* is a state, or the part of an edge
that passes a column. The *level* of a node is the y coordinate of the state's centre or of the
edge's line. Nodes of a column do not overlap, so edges cross no state and no text. The text of an
edge is above its line. Traps are in a row below the columns. An edge to a trap goes straight down
from its state. If other states are below that state, the edge goes down a lane beside them. All
lengths are in pixels of the SVG; y points down.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import inf
from typing import Final

from tltlc.core.record import record
from tltlc.interfaces.playground.curves import Curve, PicturePoint, add_bend, add_drop, add_line
from tltlc.interfaces.playground.ordering import (
    EdgeEnds,
    LayoutNode,
    chain,
    columns_of,
    mean,
    neighbours,
    order_columns,
)

_SWEEPS: Final = 12
_GAP, _NARROW_GAP = 30.0, 12.0
"""Vertical gaps between two nodes of a column: the first if one of them is a state, the second if neither is."""
_LEAST_BEND, _MOST_BEND = 36.0, 110.0
"""Least and greatest distance between two columns, where edges change their levels."""
_LANE: Final = 20.0
"""Width of the lane in which edges drop past the lower states of a column."""

BoxSize = tuple[float, float]
"""Width and height."""


@record
class StateBox:
    """A box to place: a state, with the texts over and under it.

    ``width`` and ``height`` are the size of the state. ``over`` and ``under`` are the heights of
    the texts over and under the state, and ``span`` is the width of the widest text. ``below`` says
    whether the box is in the row of traps.
    """

    width: float
    height: float
    over: float = 0.0
    under: float = 0.0
    span: float = 0.0
    below: bool = False


@record
class Layout:
    """The places of all parts of a picture, in pixels.

    ``middles`` maps the number of each state to its centre. ``texts`` and ``curves`` map edges, as
    pairs of source and target, to the centres of their texts and to their curves. ``width`` and
    ``height`` are the right and lower ends of the picture.
    """

    middles: Mapping[int, PicturePoint]
    texts: Mapping[EdgeEnds, PicturePoint]
    curves: Mapping[EdgeEnds, Curve]
    width: float
    height: float


def layout(
    boxes: Mapping[int, StateBox], texts: Mapping[EdgeEnds, BoxSize], corner: PicturePoint = (0.0, 0.0)
) -> Layout:
    """Lay out boxes and edges; ``corner`` is the left upper corner of the picture.

    ``boxes`` maps the number of each state to its box; box 0 is the initial state. ``texts`` maps
    each edge, as a pair of source and target, to the size of its text. Loops, and the texts of edges
    to traps, are not placed here, because they are drawn over and under the boxes. No edge may lead
    from a trap to another box.
    """
    return _LayoutPass(boxes, texts, corner).layout()


class _LayoutPass:
    """Computes one layout: first the columns, then the levels (y coordinates) of their nodes, then the curves."""

    def __init__(self, boxes: Mapping[int, StateBox], texts: Mapping[EdgeEnds, BoxSize], corner: PicturePoint) -> None:
        self.boxes, self.texts = boxes, texts
        upper_states = [state for state in boxes if not boxes[state].below]
        inner_edges = [(a, b) for a, b in texts if a != b and not boxes[a].below and not boxes[b].below]
        self.drops = [(a, b) for a, b in texts if not boxes[a].below and boxes[b].below]
        self.column = {state: 2 * number for state, number in columns_of(upper_states, inner_edges).items()}
        self.chains = {ends: chain(ends, self.column) for ends in inner_edges}
        self.columns = order_columns(self.column, list(self.chains.values()))
        self.in_lanes = {a for a, _ in self.drops if not self._is_lowest(a)}
        self.lanes = {self.column[state] for state in self.in_lanes}
        self.levels = self._levels(corner[1])
        self.bottom = max(level + self._reach(node)[1] for node, level in self.levels.items())
        self.spans = self._spans(corner[0])
        self.ports = self._ports()
        self.row = self._row_below(corner[0])

    def layout(self) -> Layout:
        """Return the complete layout."""
        middles = {state: self._middle(state) for state in self.column} | self.row
        texts = {ends: self._text(ends, nodes[1]) for ends, nodes in self.chains.items()}
        curves = {ends: self._curve(ends) for ends in self.chains} | self._drops()
        below = [(place, self.boxes[state]) for state, place in self.row.items()]
        width = max([self.spans[-1][1], *(x + _span(box) / 2 for (x, _), box in below)])
        height = max([self.bottom, *(y + box.height / 2 + box.under for (_, y), box in below)])
        return Layout(middles, texts, curves, width, height)

    def _is_lowest(self, state: int) -> bool:
        return [node for node in self.columns[self.column[state]] if len(node) == 1][-1] == (state,)

    def _reach(self, node: LayoutNode) -> tuple[float, float]:
        """Return how far a node extends above and below its level (y coordinate), in pixels."""
        if len(node) == 1:
            box = self.boxes[node[0]]
            return box.height / 2 + box.over, box.height / 2 + box.under
        is_text = self.chains[node[0], node[1]][1] == node
        return (self.texts[node[0], node[1]][1] + 5, 3.0) if is_text else (0.0, 0.0)

    def _levels(self, top: float) -> dict[LayoutNode, float]:
        """Return the level (y coordinate) of each node; ``top`` is where the highest node shall begin.

        Nodes that an edge links have similar levels. Nodes of a column do not overlap.
        """
        beside = neighbours(link for nodes in self.chains.values() for link in pairwise(nodes))
        levels: dict[LayoutNode, float] = {}
        for nodes in self.columns:
            self._spread(nodes, dict.fromkeys(nodes, 0.0), levels)
        for sweep in range(_SWEEPS):
            for nodes in self.columns if sweep % 2 else reversed(self.columns):
                ideal_levels = {
                    node: mean([levels[next_node] for next_node in beside.get(node, ())], levels[node])
                    for node in nodes
                }
                self._spread(nodes, ideal_levels, levels)
        for nodes in sorted(self.chains.values(), key=len, reverse=True):
            self._straighten(nodes[1:-1], levels)
        shift = top - min(level - self._reach(node)[0] for node, level in levels.items())
        return {node: level + shift for node, level in levels.items()}

    def _spread(
        self, nodes: Sequence[LayoutNode], ideal_levels: Mapping[LayoutNode, float], levels: dict[LayoutNode, float]
    ) -> None:
        """Set the levels of a column's nodes: near their ideal levels, in the same order, and without overlaps.

        ``nodes`` are all nodes of the column from top to bottom. The new levels are stored in
        ``levels``; their mean is the mean of the ideal levels.
        """
        last: LayoutNode = ()
        for node in nodes:
            levels[node] = ideal_levels[node]
            if last:
                levels[node] = max(ideal_levels[node], levels[last] + self._apart(last, node))
            last = node
        shift = mean([ideal_levels[node] - levels[node] for node in nodes], 0.0)
        for node in nodes:
            levels[node] += shift

    def _apart(self, upper: LayoutNode, lower: LayoutNode) -> float:
        """Return the least distance between the levels of two nodes, one just below the other in a column."""
        gap = _GAP if len(upper) == 1 or len(lower) == 1 else _NARROW_GAP
        return self._reach(upper)[1] + gap + self._reach(lower)[0]

    def _straighten(self, nodes: Sequence[LayoutNode], levels: dict[LayoutNode, float]) -> None:
        """Change ``levels`` so that the edge through these nodes has few bends.

        Give the same level to as many of the first nodes as possible, then do so with the rest.
        """
        while nodes:
            low, high = self._room(nodes[0], levels)
            number = 1
            for node in nodes[1:]:
                top, bottom = self._room(node, levels)
                if max(low, top) > min(high, bottom):
                    break
                low, high, number = max(low, top), min(high, bottom), number + 1
            level = min(max(mean([levels[node] for node in nodes[:number]], 0.0), low), high)
            levels.update(dict.fromkeys(nodes[:number], level))
            nodes = nodes[number:]

    def _room(self, node: LayoutNode, levels: Mapping[LayoutNode, float]) -> tuple[float, float]:
        """Return the least and greatest level that a node can have between its neighbours in the column."""
        nodes = self.columns[self._number(node)]
        place = nodes.index(node)
        low = levels[nodes[place - 1]] + self._apart(nodes[place - 1], node) if place else -inf
        high = levels[nodes[place + 1]] - self._apart(node, nodes[place + 1]) if place + 1 < len(nodes) else inf
        return low, max(low, high)

    def _spans(self, left: float) -> list[tuple[float, float]]:
        """Return the x coordinates of the left and right end of each column.

        ``left`` is the left end of the first column.
        """
        rises = [0.0] * len(self.columns)
        for nodes in self.chains.values():
            for node, next_node in pairwise(nodes):
                number = min(self._number(node), self._number(next_node))
                rises[number] = max(rises[number], abs(self.levels[node] - self.levels[next_node]))
        spans = []
        for number, nodes in enumerate(self.columns):
            right = left + max(map(self._width, nodes))
            if number in self.lanes:
                right += _LANE
            spans.append((left, right))
            left = right + min(max(rises[number] / 3, _LEAST_BEND), _MOST_BEND)
        return spans

    def _number(self, node: LayoutNode) -> int:
        return self.column[node[0]] if len(node) == 1 else node[2]

    def _width(self, node: LayoutNode) -> float:
        if len(node) == 1:
            return _span(self.boxes[node[0]])
        return self.texts[node[0], node[1]][0] if self.chains[node[0], node[1]][1] == node else 0.0

    def _middle(self, state: int) -> PicturePoint:
        left, right = self.spans[self.column[state]]
        lane = _LANE if self.column[state] in self.lanes else 0.0
        return (left + right - lane) / 2, self.levels[(state,)]

    def _text(self, ends: EdgeEnds, node: LayoutNode) -> PicturePoint:
        left, right = self.spans[node[2]]
        return (left + right) / 2, self.levels[node] - 5 - self.texts[ends][1] / 2

    def _ports(self) -> dict[tuple[EdgeEnds, int], PicturePoint]:
        """Return the points at which edges touch their source and target; the keys are pairs of edge and state.

        The edges at one side of a state are sorted by the levels of the nodes that they lead to.
        """
        sides: dict[tuple[int, bool], list[tuple[float, EdgeEnds]]] = {}
        for ends, nodes in self.chains.items():
            for state, beside in ((ends[0], nodes[1]), (ends[1], nodes[-2])):
                side = state, self._number(beside) > self.column[state]
                sides.setdefault(side, []).append((self.levels[beside], ends))
        ports = {}
        for (state, is_right), leading in sides.items():
            (x, y), box = self._middle(state), self.boxes[state]
            for index, (_, ends) in enumerate(sorted(leading)):
                share = (index + 1) / (len(leading) + 1) - 0.5
                ports[ends, state] = x + box.width / 2 * (1 if is_right else -1), y + box.height * share
        return ports

    def _curve(self, ends: EdgeEnds) -> Curve:
        """Return the curve of an edge, which is straight inside columns and bent between them."""
        nodes = self.chains[ends]
        goes_right = self.column[ends[0]] < self.column[ends[1]]
        start, end = self.ports[ends, ends[0]], self.ports[ends, ends[1]]
        levels = [start[1], *(self.levels[node] for node in nodes[1:-1]), end[1]]
        curve: Curve = (start,)
        for number, (node, level) in enumerate(zip(nodes, levels, strict=True)):
            enter, leave = self.spans[self._number(node)][:: 1 if goes_right else -1]
            if number:
                curve = add_bend(curve, (enter, level))
            curve = add_line(curve, end if number == len(nodes) - 1 else (leave, level))
        return curve

    def _drops(self) -> dict[EdgeEnds, Curve]:
        """Return the curves of edges to traps; edges to the same trap end side by side."""
        paths_down = {a: self._path_down(a) for a, _ in self.drops}
        curves = {}
        for target, (x, y) in self.row.items():
            box = self.boxes[target]
            sources = sorted((a for a, b in self.drops if b == target), key=lambda a: (paths_down[a][-1][0], a))
            for index, a in enumerate(sources):
                share = (index + 1) / (len(sources) + 1) - 0.5
                port = x + box.width * share, y - box.height / 2
                # The texts of other boxes in the row may reach as far up as the texts of this box.
                curves[a, target] = add_line(add_drop(paths_down[a], (port[0], port[1] - box.over)), port)
        return curves

    def _path_down(self, state: int) -> Curve:
        """Return the first part of an edge to a trap: the curve from its state to the bottom of the columns."""
        (x, y), box = self._middle(state), self.boxes[state]
        curve: Curve = ((x, y + box.height / 2),)
        if state in self.in_lanes:
            under = y + box.height / 2 + box.under
            lane = self.spans[self.column[state]][1] - _LANE / 2
            curve = add_drop(add_line(curve, (x, under)), (lane, under + _GAP - 8))
        return add_line(curve, (curve[-1][0], self.bottom))

    def _row_below(self, left: float) -> dict[int, PicturePoint]:
        """Return the centre of each trap in the row below the columns, near the edges that lead to it."""
        ideal_x = {
            state: mean([self._path_down(a)[-1][0] for a, b in self.drops if b == state], 0.0)
            for state, box in self.boxes.items()
            if box.below
        }
        places: dict[int, PicturePoint] = {}
        reach = max((abs(self._path_down(a)[-1][0] - ideal_x[b]) for a, b in self.drops), default=0.0)
        top = self.bottom + min(max(reach / 8, 2 * _GAP), _MOST_BEND)
        for state in sorted(ideal_x, key=lambda state: (ideal_x[state], state)):
            box = self.boxes[state]
            x = max(ideal_x[state], left + _span(box) / 2)
            places[state] = x, top + box.over + box.height / 2
            left = x + _span(box) / 2 + 2 * _GAP
        return places


def _span(box: StateBox) -> float:
    return max(box.width, box.span)
