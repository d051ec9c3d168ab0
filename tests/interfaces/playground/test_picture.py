"""The picture of an automaton is complete, and nothing in it overlaps."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tltlc
from tests.backends.strategies import automata, hostile_automata, infinite_automata
from tests.fuzzing import times
from tests.unfolded import unfolded
from tltlc.automaton.fspa import Fspa, Notation
from tltlc.backends.drawing.folding import fold_runs
from tltlc.diagnostics.formats.text import columns
from tltlc.interfaces.playground.curves import Curve
from tltlc.interfaces.playground.layout import BoxSize, StateBox, layout
from tltlc.interfaces.playground.ordering import EdgeEnds
from tltlc.interfaces.playground.picture import MOST_STATES, picture

SIGNALS = "signal a: bool  signal b: bool  signal c: bool  "
SPECS = (
    "F(a & X F(b & X F c)) & G a",
    "F a & F b & F c",
    "G(a -> F b)",
    "G(a -> F[0,9] b)",
    "a U (b R c)",
    "true",
    "false & a",
    "a & !a",
)
DENSE = "G((a -> X b) | (c U !a)) & F(b & X c)"
"""A formula of about 10 states and many more edges."""
ROOT = Path(__file__).parents[3]
SHIPPED = sorted(
    path for folder in ("examples", "tltlc/interfaces/playground/examples") for path in (ROOT / folder).glob("*.tltl")
)


def automaton(formula: str, semantics: str = "finite") -> Fspa:
    (fspa,) = tltlc.compile_text(f"{SIGNALS} spec x {{ semantics {semantics} require {formula} }}")
    return fspa


def groups(svg: str, kind: str) -> list[ElementTree.Element]:
    return [element for element in ElementTree.fromstring(svg).iter() if element.get("class", "").split(" ")[0] == kind]


@pytest.mark.parametrize("formula", SPECS)
def test_every_state_and_edge_is_drawn_once(formula: str) -> None:
    fspa = automaton(formula)
    svg, _ = picture(fspa)
    assert svg
    drawing = fold_runs(fspa)
    drawn_states = [int(number) for group in groups(svg, "state") for number in group.get("data-states", "").split()]
    assert sorted(drawn_states) == [state.id for state in fspa.states]
    edges = [(int(group.get("data-source", "")), int(group.get("data-target", ""))) for group in groups(svg, "edge")]
    assert sorted(edges) == sorted({(edge.source, edge.target) for edge in drawing.edges})


Area = tuple[float, float, float, float]


def areas(svg: str) -> list[tuple[str, Area]]:
    """Return the areas of the states and of the texts of edges: left, top, right and bottom."""
    labelled_areas = []
    for frame in groups(svg, "frame"):
        x, y, width, height = (float(frame.get(name, "")) for name in ("x", "y", "width", "height"))
        labelled_areas.append(("state", (x, y, x + width, y + height)))
    for text in groups(svg, "guard"):
        lines = [(float(line.get("x", "")), float(line.get("y", "")), line.text or "") for line in text]
        # Estimates: the height is a little less than a line's, and the width is that of wide letters.
        half = max(columns(line) for _, _, line in lines) * 6.5 / 2
        x, top, bottom = lines[0][0], lines[0][1] - 9, lines[-1][1] + 3
        labelled_areas.append((" ".join(line for _, _, line in lines), (x - half, top, x + half, bottom)))
    return labelled_areas


def overlap(one: Area, other: Area) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def check_places(svg: str) -> None:
    root = ElementTree.fromstring(svg)
    width, height = float(root.get("width", "")), float(root.get("height", ""))
    places = areas(svg)
    for label, (left, top, right, bottom) in places:
        assert 0 <= left <= right <= width, label
        assert 0 <= top < bottom <= height, label
    for (one, here), (other, there) in combinations(places, 2):
        assert not overlap(here, there), (one, other)


@pytest.mark.parametrize("formula", [*SPECS, DENSE])
def test_states_and_texts_are_inside_and_do_not_overlap(formula: str) -> None:
    svg, _ = picture(automaton(formula))
    assert svg
    check_places(svg)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_pictures_of_shipped_specs_do_not_overlap(path: Path) -> None:
    for fspa in tltlc.compile_file(path):
        svg, note = picture(fspa)
        assert svg, note
        check_places(svg)


@given(automata() | infinite_automata() | hostile_automata())
def test_states_and_texts_of_every_automaton_do_not_overlap(fspa: Fspa) -> None:
    svg, note = picture(fspa)
    assert svg or note
    if svg:
        check_places(svg)


def test_a_long_text_is_cut_and_complete_in_the_title() -> None:
    names = [f"the_player_has_been_seen_in_room_{number}" for number in range(12)]
    signals = " ".join(f"signal {name}: bool" for name in names)
    (fspa,) = tltlc.compile_text(f"{signals} spec x = F ({' & '.join(names)})")
    svg, _ = picture(fspa)
    assert svg
    check_places(svg)
    (edge,) = (edge for edge in groups(svg, "edge") if edge.get("data-source") != edge.get("data-target"))
    title, text = edge[0].text or "", "".join(edge.itertext())
    assert title == f"From 0 to 1: {' and '.join(names)}"
    assert text.endswith("…")
    assert max(right for _, (_, _, right, _) in areas(svg)) < 1000


def test_acceptance_pairs_are_shown_on_their_edges() -> None:
    svg, _ = picture(automaton("G F a & G F b", "infinite"))
    assert svg
    assert "[inf 0]" in svg


def test_a_run_of_states_is_folded_with_a_note() -> None:
    svg, note = picture(automaton("G(a -> F[0,20] b)"))
    assert svg
    assert " folded" in svg
    assert note.startswith("Dashed: ")


def test_runs_that_count_together_are_folded() -> None:
    with unfolded():
        fspa = automaton("G !c & F[0,100] a & F[0,100] b")
    svg, note = picture(fspa)
    assert svg
    check_places(svg)
    assert len(fspa.states) == 303
    assert note == "Dashed: 294 of the 303 states, folded."
    (both,) = (group for group in groups(svg, "state") if group.get("data-states", "").startswith("2 "))
    label = " ".join(line.text or "" for text in both if text.get("class") == "label" for line in text)
    assert label == "98 more like these Avoid c throughout, reach a within 99…2 steps, and reach b within 99…2 steps."


def test_a_countdown_to_one_step_is_one_range() -> None:
    svg, _ = picture(automaton("F[0,9] a"))
    assert svg
    assert "Reach a within 8…1 steps." in svg


@pytest.mark.parametrize(
    ("notation", "labels", "guards"),
    [
        (
            "english",
            ["Reach a, and keep b throughout.", "The spec is violated.", "Keep b throughout."],
            ["not b", "true"],
        ),
        ("unicode", ["◇a ∧ □b", "⊥", "□b"], ["¬b", "⊤"]),
    ],
)
def test_labels_and_guards_are_in_words_or_in_symbols(notation: Notation, labels: list[str], guards: list[str]) -> None:
    svg, _ = picture(automaton("F a & G b"), notation)
    assert svg
    texts = {
        kind: [" ".join(line.text or "" for line in text) for text in groups(svg, kind)] for kind in ("label", "guard")
    }
    assert sorted(texts["label"]) == sorted(labels)
    assert set(guards) <= set(texts["guard"])


@pytest.mark.parametrize("formula", SPECS)
def test_the_numbers_of_a_state_are_inside_its_frame_and_above_its_text(formula: str) -> None:
    svg, _ = picture(automaton(formula))
    assert svg
    for state in groups(svg, "state"):
        parts = {part.get("class"): part for part in state}
        frame, number, distance = parts.get("ring", parts["frame"]), parts["number"], parts["distance"]
        left, top = float(frame.get("x", "")), float(frame.get("y", ""))
        right = left + float(frame.get("width", ""))
        # Digits are 8 high and 6.5 wide, and have no descenders.
        assert float(number.get("y", "")) - 8 > top
        assert left < float(number.get("x", ""))
        assert float(distance.get("x", "")) < right
        widths = [6.5 * columns(text.text or "") for text in (number, distance)]
        assert float(number.get("x", "")) + widths[0] < float(distance.get("x", "")) - widths[1]
        assert float(number.get("y", "")) < min(float(line.get("y", "")) for line in parts["label"]) - 9


def test_a_picture_with_too_many_states_is_not_drawn() -> None:
    fspa = automaton("F(a & F[3,7] b) & F(b & F[2,6] c)")
    assert len(fold_runs(fspa).states) > MOST_STATES
    assert picture(fspa) == (
        None,
        f"The automaton has {len(fspa.states)} states and {len(fspa.edges)} edges, too many for a picture.",
    )


def test_names_are_escaped() -> None:
    (fspa,) = tltlc.compile_text("/// <b>&\nspec x = F n > 1 & F n < 0.5  signal n in [0, 2]")
    svg, _ = picture(fspa)
    assert svg
    assert ElementTree.fromstring(svg) is not None
    assert "n &gt; 1" in svg


@st.composite
def graphs(draw: st.DrawFn) -> tuple[int, list[EdgeEnds]]:
    """A number of states, and edges between them."""
    size = draw(st.integers(1, 9))
    state = st.integers(0, size - 1)
    return size, draw(st.lists(st.tuples(state, state), max_size=20, unique=True))


@times(40)
@given(graphs(), st.lists(st.tuples(st.floats(1, 200), st.floats(1, 90)), min_size=20, max_size=20))
def test_edges_cross_no_state_and_no_text(graph: tuple[int, list[EdgeEnds]], sizes: list[BoxSize]) -> None:
    size, edges = graph
    traps = {state for state in range(1, size) if state % 4 == 3}
    texts = {(a, b): text_size for (a, b), text_size in zip(edges, sizes, strict=False) if a not in traps or a == b}
    boxes = {
        state: StateBox(60.0 + 10 * state, 40.0 + 5 * state, 9.0 * state, 8.0, 30.0 * state, below=state in traps)
        for state in range(size)
    }
    places = layout(boxes, texts, (7.0, 9.0))
    taken: dict[object, Area] = {}
    for state, (x, y) in places.middles.items():
        box = boxes[state]
        half = max(box.width, box.span) / 2
        top, bottom = y - box.height / 2, y + box.height / 2
        taken[state] = x - half, top - box.over, x + half, bottom + box.under
        assert taken[state][0] >= 7 - 1e-6 and taken[state][2] <= places.width + 1e-6
        assert taken[state][1] >= 9 - 1e-6 and taken[state][3] <= places.height + 1e-6
    for ends, (x, y) in places.texts.items():
        width, height = texts[ends]
        taken[ends] = x - width / 2, y - height / 2, x + width / 2, y + height / 2
    for one, other in combinations(taken.values(), 2):
        assert not overlap(inner(one), inner(other))
    assert set(places.curves) == {(a, b) for a, b in texts if a != b}
    for ends, way in places.curves.items():
        for x, y in points(way):
            # An edge overlaps its own two states.
            for owner, area in taken.items():
                assert owner in ends or not overlap((x, y, x, y), inner(area)), (ends, owner)


def inner(area: Area) -> Area:
    return area[0] + 0.1, area[1] + 0.1, area[2] - 0.1, area[3] - 0.1


def points(way: Curve) -> Iterator[tuple[float, float]]:
    """Yield points along a path of cubic Bézier curves."""
    for start in range(0, len(way) - 1, 3):
        a, b, c, d = way[start : start + 4]
        for number in range(21):
            t = number / 20
            u = 1 - t
            yield tuple(u**3 * a[i] + 3 * u * u * t * b[i] + 3 * u * t * t * c[i] + t**3 * d[i] for i in (0, 1))  # type: ignore[misc]
