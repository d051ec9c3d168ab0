"""The automaton as an inline SVG, with the numbers of episodes in its states and on its edges."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Sequence, Set
from typing import Final
from xml.etree import ElementTree

from markupsafe import Markup

from tltl_runtime.regression.report.page.render import render
from tltl_runtime.regression.report.page.traffic import Traffic
from tltl_runtime.support.markup import coordinate
from tltlc.api import Diagnostic, Fspa, Notation, TltlError, compiler, label_text, record, replace

_LAYOUT_LIMIT_S: Final = 10.0
"""The time limit, in seconds, of each attempt to lay out an automaton."""

Ends = tuple[int, int]
"""The source and the target of an edge."""

_NUMBER: Final = re.compile(r"-?\d+(?:\.\d+)?")
_THINNEST, _THICKEST = 0.8, 7.0
_LETTER_HEIGHT, _MARGIN = 12.0, 4.0
"""The height of a letter and the margin of the picture, in the units of the picture."""
_LETTER_WIDTH: Final = 6.4
"""The width of a character of a badge, in the units of the picture."""
_BADGE_HEIGHT: Final = 16.0
"""The height of a badge, in the units of the picture."""


@record
class AutomatonPicture:
    """The picture of a spec's automaton.

    ``svg`` is the picture as SVG with its formulas in words, or None if the automaton could not be laid
    out. ``symbols`` is the picture with the formulas in symbols, or None. ``notes`` are sentences on what
    the picture does not show, and why.
    """

    svg: bytes | None
    notes: tuple[str, ...]
    symbols: bytes | None = None


def draw_automaton(fspa: Fspa) -> AutomatonPicture:
    """Draw an automaton in words and in symbols, without the counts of episodes.

    A separate process lays out each picture. Each attempt may take 10 seconds. If that fails, the
    picture has no SVG.
    """
    words = _draw(fspa, "english")
    return words if words.svg is None else replace(words, symbols=_draw(fspa, "unicode").svg)


def _draw(fspa: Fspa, notation: Notation) -> AutomatonPicture:
    diagnostics: list[Diagnostic] = []
    try:
        # The page already shows the description of the spec.
        files = compiler.emit(
            "svg",
            replace(fspa, doc=""),
            compiler.BackendOptions(notation, layout_limit_s=_LAYOUT_LIMIT_S, report=diagnostics.append),
        )
    except TltlError as error:
        return AutomatonPicture(None, tuple(_sentence(diagnostic) for diagnostic in error.diagnostics))
    ((name, content),) = files.items()
    if not name.endswith(".svg"):
        return AutomatonPicture(
            None, (f"The automaton with {len(fspa.states)} states is too tangled to be drawn in time.",)
        )
    data = content.encode() if isinstance(content, str) else content
    return AutomatonPicture(data, tuple(_sentence(diagnostic) for diagnostic in diagnostics))


def picture(fspa: Fspa, svg: bytes, now: Traffic, before: Traffic) -> Markup:
    """Add badges to the ``svg`` of an automaton: how many episodes visited each state and failed there.

    Also scale the thickness of each edge with the share of episodes that took it. The result contains
    badges and widths both for the episodes ``now`` and for those ``before``, in the baseline; the
    style sheet shows one of the two. A node of the SVG may stand for a chain of states; its attribute
    ``data-states`` lists them.
    """
    root = ElementTree.fromstring(svg)
    for node in root.iter():
        node.tag = node.tag.rpartition("}")[2]
    root.remove(root[0])  # its title
    states = {
        group: tuple(map(int, numbers.split())) for group in root.iter("g") if (numbers := group.get("data-states"))
    }
    edges = {
        group: (int(source), int(target))
        for group in root.iter("g")
        if (source := group.get("data-source")) and (target := group.get("data-target"))
    }
    counts = [(_edge_counts(traffic, states.values(), set(edges.values())), traffic) for traffic in (now, before)]
    for group, run in states.items():
        _mark_state(group, group[0], run, now, before)
    for group, ends in edges.items():
        _mark_edge(group, group[0], ends, [(edge_counts[ends], traffic) for edge_counts, traffic in counts])
    _, _, width, height = map(float, _NUMBER.findall(root.get("viewBox", "")))
    top = _remove_title(root)
    for graph in root:
        # Draw states last, so that no edge covers their badges.
        graph[:] = sorted(graph, key=lambda child: child.get("class") == "node")
    root.attrib = {
        "class": "automaton",
        "viewBox": f"0 {coordinate(top)} {coordinate(width)} {coordinate(height - top)}",
        "role": "img",
        "aria-label": f"The automaton of the spec {fspa.name}; the table below has its numbers.",
        "style": f"--width: {width:.0f}",
    }
    return Markup(ElementTree.tostring(root, encoding="unicode", short_empty_elements=True))


def _edge_counts(traffic: Traffic, runs: Collection[tuple[int, ...]], drawn_edges: Set[Ends]) -> Counter[Ends]:
    """Count the episodes that took each drawn edge; an episode counts once for an edge.

    ``runs`` has the states of each node. A node with several states stands for a chain of states,
    and is named by the first of them: an edge from or to any state of the chain counts as the drawn
    edge from or to that node.
    """
    first = {state: run[0] for run in runs for state in run}
    folded = [run[0] for run in runs if len(run) > 1]

    def drawn_edge(edge: Ends) -> Ends:
        source, target = (first[end] for end in edge)
        if source != target and (source, target) not in drawn_edges:
            # The edge skips a chain that is drawn as one node: count it at the edge into that node.
            target = next(
                (
                    run_start
                    for run_start in folded
                    if (source, run_start) in drawn_edges and (run_start, target) in drawn_edges
                ),
                target,
            )
        return source, target

    return Counter(edge for edges in traffic.edges for edge in {drawn_edge(edge) for edge in edges})


def _mark_state(
    group: ElementTree.Element, title: ElementTree.Element, states: tuple[int, ...], now: Traffic, before: Traffic
) -> None:
    left, top, right, bottom = _extent(group)
    name = f"State {states[0]}" if len(states) == 1 else f"States {states[0]} to {states[-1]}"
    _name(group, name.lower(), left, top, right)
    parts = []
    for when, traffic in (("now", now), ("before", before)):
        visited = _visits(traffic, states)
        failed = sum(traffic.failed.get(state, 0) for state in states)
        parts.append(f"{when}: visited by {visited} of {traffic.episodes} {traffic.noun}, {failed} failed in it")
        badges = ElementTree.SubElement(group, "g", {"class": f"counts {when}"})
        _badge(badges, "visited", str(visited), left + 6, bottom, grows=1)
        if failed:
            _badge(badges, "failed", f"{failed} failed", right - 6, bottom, grows=-1)
    title.text = f"{name}; {'; '.join(parts)}"


def _visits(traffic: Traffic, states: tuple[int, ...]) -> int:
    """Return how many episodes visited a node of the picture, which stands for ``states``.

    For a node with several states, these are the episodes that took an edge into one of the states.
    """
    if len(states) == 1:
        return traffic.visited.get(states[0], 0)
    return sum(any(target in states for _, target in edges) for edges in traffic.edges)


def _mark_edge(
    group: ElementTree.Element, title: ElementTree.Element, ends: Ends, edge_counts: Sequence[tuple[int, Traffic]]
) -> None:
    """Set the thickness and the title of an edge; remove the title of a self-loop.

    ``edge_counts`` has two pairs, one for now and one for the baseline: how many episodes took the
    edge, and the counts of all episodes.
    """
    if ends[0] == ends[1]:
        group.set("class", "edge loop")
        group.remove(title)
        return
    widths, parts = [], []
    for when, (count, traffic) in zip(("now", "before"), edge_counts, strict=True):
        share = count / traffic.episodes if traffic.episodes else 0.0
        widths.append(f"--took-{when}: {coordinate(_THINNEST + share * (_THICKEST - _THINNEST))}")
        parts.append(f"{when}: taken by {count} of {traffic.episodes} {traffic.noun}")
        if not count:
            group.set("class", f"{group.get('class')} untaken-{when}")
    group.set("style", "; ".join(widths))
    title.text = f"From state {ends[0]} to state {ends[1]}; {'; '.join(parts)}"


def _name(group: ElementTree.Element, text: str, left: float, top: float, right: float) -> None:
    """Add a badge with the name of a state at the upper left corner of the state's node.

    If the badge would cover the mark for the state's distance from acceptance, it is placed above
    the mark.
    """
    x, y = min(left + 6, right - _width(text)), top
    # The mark of the distance is a filled path without an outline.
    for mark in (path for path in group.iter("path") if path.get("stroke") == "none"):
        mark_left, mark_top, _, _ = _extent(mark)
        if x + _width(text) > mark_left - 1:
            y = min(y, mark_top - _BADGE_HEIGHT / 2 - 1)
    _badge(group, "name", text, x, y, grows=1)


def _width(text: str) -> float:
    """Return the width of a badge with this text."""
    return len(text) * _LETTER_WIDTH + 9


def _badge(parent: ElementTree.Element, kind: str, text: str, x: float, y: float, grows: int) -> None:
    """Add a pill-shaped badge that starts at ``x`` if ``grows`` is positive, else ends at ``x``.

    ``kind`` is its CSS class.
    """
    width = _width(text)
    left = x if grows > 0 else x - width
    group = ElementTree.SubElement(parent, "g", {"class": f"badge {kind}"})
    sides = {
        "x": coordinate(left),
        "y": coordinate(y - _BADGE_HEIGHT / 2),
        "width": coordinate(width),
        "height": coordinate(_BADGE_HEIGHT),
        "rx": "8",
    }
    ElementTree.SubElement(group, "rect", sides)
    ElementTree.SubElement(group, "text", {"x": coordinate(left + width / 2), "y": coordinate(y + 4)}).text = text


def _extent(group: ElementTree.Element) -> tuple[float, float, float, float]:
    """Return the bounds of what an SVG group draws: left, top, right, bottom."""
    points = list(_points(group))
    xs, ys = [x for x, _ in points], [y for _, y in points]
    return min(xs), min(ys), max(xs), max(ys)


def _remove_title(root: ElementTree.Element) -> float:
    """Remove the name of the spec from the SVG of an automaton.

    Return the y coordinate at which the remaining drawing begins, in the units of the view box.
    """
    (graph,) = (child for child in root if child.get("class") == "graph")
    groups = [child for child in graph if child.get("class") is not None]
    for child in set(graph) - set(groups):
        graph.remove(child)
    ys = [y for group in groups for _, y in _points(group)]
    ys += [float(text.get("y", 0)) - _LETTER_HEIGHT for group in groups for text in group.iter("text")]
    moved = float(_NUMBER.findall(graph.get("transform", "").rpartition("translate")[2])[1])
    return max(0.0, min(ys) + moved - _MARGIN)


def _points(group: ElementTree.Element) -> Iterator[tuple[float, float]]:
    for shape in group.iter():
        if shape.tag == "ellipse":
            x, y, rx, ry = (float(shape.get(name, 0)) for name in ("cx", "cy", "rx", "ry"))
            yield from ((x - rx, y - ry), (x + rx, y + ry))
        numbers = [float(digits) for digits in _NUMBER.findall(shape.get("points") or shape.get("d") or "")]
        yield from zip(numbers[::2], numbers[1::2], strict=True)


def _sentence(diagnostic: Diagnostic) -> str:
    text = f"{diagnostic.title[:1].upper()}{diagnostic.title[1:]}"
    return f"{text}: {diagnostic.help}" if diagnostic.severity != "note" and diagnostic.help else f"{text}."


def label_texts(fspa: Fspa, state: int) -> tuple[str, str]:
    """Return what remains to be done in a state, in words and in symbols."""
    return label_text(fspa, state), label_text(fspa, state, "unicode")


def counts_table(fspa: Fspa, now: Traffic, before: Traffic) -> Markup:
    """Return an HTML table with a row for each state of the automaton.

    A row says what remains to be done in the state, and how many episodes visited it and failed in
    it, ``now`` and ``before`` (in the baseline).
    """
    rows = [
        (state.id, label_texts(fspa, state.id), [*_counts(state.id, now), *_counts(state.id, before)])
        for state in fspa.states
    ]
    return render("counts_table.html", rows=rows)


def _counts(state: int, traffic: Traffic) -> tuple[str, str]:
    """Return two texts, such as ``3 of 25``: how many episodes visited a state, and how many failed in it."""
    visited, failed = (f"{counts.get(state, 0)} of {traffic.episodes}" for counts in (traffic.visited, traffic.failed))
    return visited, failed
