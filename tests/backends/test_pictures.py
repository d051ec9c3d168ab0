from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ET

import pytest
from hypothesis import HealthCheck, given, settings

from tests.backends.strategies import hostile_automata
from tests.fixtures import cover_and_hide
from tests.unfolded import unfolded
from tltlc import backends, compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Options
from tltlc.backends.drawing import layout
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.logic.formula import and_, atom, eventually

SVG = "{http://www.w3.org/2000/svg}"


def collect(goals: int) -> Fspa:
    """Return an automaton of goals in any order, with 2^n states and 3^n edges."""
    return build(spec_from_formula(and_(*(eventually(atom(f"g{i}")) for i in range(goals))), "collect"))


def draw_svg(fspa: Fspa, options: Options | None = None) -> ET.Element:
    picture = backends.emit("svg", fspa, options)[f"{fspa.name}.svg"]
    assert isinstance(picture, bytes)
    return ET.fromstring(picture)


def text_of(picture: ET.Element) -> str:
    return " ".join("".join(text.itertext()) for text in picture.iter(f"{SVG}text"))


def title(element: ET.Element) -> str:
    """Return the title, which tooltips show and screen readers read."""
    return element.findtext(f"{SVG}title") or ""


def test_an_svg_shows_labels_guards_and_distances() -> None:
    picture = draw_svg(cover_and_hide())
    groups = [group.get("class") for group in picture.iter(f"{SVG}g")]
    assert groups.count("node") == 6
    assert groups.count("edge") == 13
    for text in ("◇near(exit) ∧ □alive", "¬near(s1) ∧ alive", "∞", " 3 ", "⊥", "cover_and_hide"):
        assert text in text_of(picture)


def test_a_png_is_a_png() -> None:
    picture = backends.emit("png", cover_and_hide())["cover_and_hide.png"]
    assert isinstance(picture, bytes)
    assert picture.startswith(b"\x89PNG\r\n\x1a\n")
    assert len(picture) > 10_000


@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(hostile_automata())
def test_hostile_texts_stay_texts(fspa: Fspa) -> None:
    picture = draw_svg(fspa)
    assert not list(picture.iter(f"{SVG}script"))
    allowed = {SVG + name for name in ("svg", "g", "title", "text", "path", "polygon", "ellipse", "polyline")}
    assert {element.tag for element in picture.iter()} <= allowed


def within_40_steps() -> Fspa:
    (fspa,) = compile_text("signal fast: bool spec quick = eventually within 40 steps fast")
    return fspa


def test_folded_runs_are_marked_in_the_picture() -> None:
    picture = draw_svg(within_40_steps(), Options(report=lambda note: pytest.fail(note.title)))
    assert "Dashed: 39 of the 43 states, folded." in text_of(picture)
    nodes = [group for group in picture.iter(f"{SVG}g") if group.get("class") == "node"]
    dashed = [node for node in nodes if any(path.get("stroke-dasharray") for path in node.iter(f"{SVG}path"))]
    assert len(nodes) == 1 + 5
    assert ["39 more like these" in text_of(node) for node in nodes] == [node in dashed for node in nodes]
    assert title(dashed[0]) == "39 states, 2 to 40, pending, distance 1: ◇[0,39] fast … fast ∨ ○fast"
    assert dashed[0].get("data-states") == " ".join(map(str, range(2, 41)))


def test_runs_that_count_in_step_are_folded() -> None:
    with unfolded():
        (fspa,) = compile_text("clock 1 Hz signal a: bool signal b: bool spec both = F[0,100] a & F[0,100] b")
    picture = draw_svg(fspa, Options(report=lambda note: pytest.fail(note.title)))
    assert "Dashed: 294 of the 303 states, folded." in text_of(picture)
    states = [number for group in picture.iter(f"{SVG}g") for number in group.get("data-states", "").split()]
    assert sorted(map(int, states)) == list(range(303))
    assert "98 more like these ◇[0,99…2] a ∧ ◇[0,99…2] b" in text_of(picture)


def test_a_picture_its_states_and_its_edges_have_titles() -> None:
    picture = draw_svg(cover_and_hide())
    assert picture.get("role") == "group"
    assert title(picture) == "The automaton of cover_and_hide"
    titles = {title(group) for group in picture.iter(f"{SVG}g") if group.get("role") == "img"}
    assert "state 3, pending, distance 1: ◇near(exit) ∧ □alive" in titles
    assert "from 3 to 4: near(exit) ∧ alive" in titles
    ends = [(group.get("data-source"), group.get("data-target")) for group in picture.iter(f"{SVG}g")]
    assert {(str(edge.source), str(edge.target)) for edge in cover_and_hide().edges} <= set(ends)
    assert not any(element.get("id") for element in picture.iter()), "it can stand in a page beside others"


def test_texts_are_centred_in_their_shapes() -> None:
    """Texts that are aligned to the left would overflow on the right in wider fonts."""
    for group in draw_svg(cover_and_hide()).iter(f"{SVG}g"):
        shapes = [extent(shape) for shape in group if shape.get("fill") not in (None, "none") and shape.get("stroke")]
        for text in group.findall(f"{SVG}text"):
            if group.get("class") != "graph":
                assert text.get("text-anchor") == "middle"
                x = float(text.get("x", "nan"))
                assert any(abs(x - (left + right) / 2) < 0.01 for left, right in shapes)


def extent(shape: ET.Element) -> tuple[float, float]:
    """Return the smallest and largest x of a shape."""
    numbers = re.findall(r"-?\d+(?:\.\d+)?", shape.get("d") or shape.get("points") or shape.get("cx") or "")
    return min(map(float, numbers[::2])), max(map(float, numbers[::2]))


def test_the_graph_is_not_folded_if_the_layout_times_out() -> None:
    fspa = within_40_steps()
    files = backends.emit("svg", fspa, Options(layout_limit_s=0.0001))
    assert files == backends.emit("dot", fspa)
    (text,) = files.values()
    assert "dashed" not in str(text)


def test_a_tangled_graph_is_sketched_with_a_note() -> None:
    notes: list[Diagnostic] = []
    picture = draw_svg(collect(6), Options(report=notes.append))
    assert [(note.code, note.severity) for note in notes] == [("TLT0711", "note")]
    assert "g0" not in text_of(picture)


def test_many_edges_are_drawn_without_guards_with_a_note() -> None:
    notes: list[Diagnostic] = []
    picture = draw_svg(collect(5), Options(report=notes.append))
    assert [(note.code, note.severity) for note in notes] == [("TLT0711", "note")]
    assert "◇g0" in text_of(picture)
    assert "¬g0" not in text_of(picture)
    titles = [title(group) for group in picture.iter(f"{SVG}g") if group.get("data-source")]
    assert any(edge_title.endswith(": ¬g0 ∧ ¬g1") for edge_title in titles)


def test_the_graph_is_emitted_if_the_layout_times_out() -> None:
    notes: list[Diagnostic] = []
    files = backends.emit("svg", cover_and_hide(), Options(layout_limit_s=0.0001, report=notes.append))
    assert files == backends.emit("dot", cover_and_hide())
    assert [(note.code, note.help) for note in notes] == [("TLT0711", "other tools may draw it")]


def test_an_error_of_the_layout_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layout, "graph", lambda *_, **__: "digraph {")
    with pytest.raises(TltlError) as caught:
        backends.emit("svg", cover_and_hide())
    assert [error.code for error in caught.value.diagnostics] == ["TLT0712"]


def test_a_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pygraphviz", None)
    with pytest.raises(TltlError) as caught:
        backends.emit("svg", cover_and_hide())
    (error,) = caught.value.diagnostics
    assert error.code == "TLT0730"
    assert "pip install" in (error.help or "")
