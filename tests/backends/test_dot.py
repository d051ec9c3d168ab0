from __future__ import annotations

import html
import re

import pygraphviz
import pytest
from hypothesis import given, settings

from tests.backends.strategies import automata, hostile_automata, infinite_automata
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tltlc import backends, compile_text
from tltlc.automaton.fspa import Fspa, Guard, Notation, Pair, Text
from tltlc.automaton.text import guard_text, label_text
from tltlc.backends import Options
from tltlc.backends.dot import FILLS, LINES, MOST_GUARDS, graph
from tltlc.backends.drawing.folding import whole_drawing
from tltlc.backends.drawing.texts import escape_invisible, guards_by_arrow, wrap_text
from tltlc.core.record import replace
from tltlc.logic.formula import and_, atom, not_, or_


def dot_text(fspa: Fspa, options: Options | None = None) -> str:
    text = backends.emit("dot", fspa, options)[f"{fspa.name}.dot"]
    assert isinstance(text, str)
    return text


def parse_dot(text: str) -> pygraphviz.AGraph:
    return pygraphviz.AGraph(string=text)


def words_of(label: str) -> str:
    """Return the text that an HTML-like label shows."""
    return html.unescape(re.sub(r"<[^>]*>", " ", label.replace("<BR/>", " ")))


def test_loops_of_final_states_are_on_the_right_where_no_edge_arrives() -> None:
    drawn = parse_dot(dot_text(cover_and_hide()))
    on_the_right = [edge[0] for edge in drawn.edges() if edge[0] == edge[1] and edge.attr["headport"] == "e"]
    assert on_the_right == [str(state.id) for state in cover_and_hide().states if state.verdict == "violated"]


def test_the_picture_matches_the_figure_of_the_paper() -> None:
    fspa, drawn = cover_and_hide(), parse_dot(dot_text(cover_and_hide()))
    assert len(drawn.nodes()) == 1 + len(fspa.states)
    assert drawn.has_edge("start", "0")
    for state in fspa.states:
        node = drawn.get_node(str(state.id))
        distance = "∞" if state.distance is None else str(state.distance)
        label = label_text(fspa, state.id, "unicode")
        assert words_of(node.attr["label"]).split() == [*distance.split(), *label.split()]
        assert node.attr["color"] == LINES[state.verdict]
        assert node.attr["fillcolor"] == FILLS[state.verdict]
        assert (node.attr["peripheries"] or "") == ("2" if state.accepting else "")
    guards = {
        (source, target): words_of(drawn.get_edge(source, target).attr["label"]) for source, target in drawn.edges()
    }
    assert guards["0", "1"].split() == ["near(s1)", "∧", "alive"]
    assert guards["0", "0"].split() == ["¬near(s1)", "∧", "alive"]
    assert guards["2", "2"].split() == ["⊤"]


@pytest.mark.parametrize(
    ("notation", "label", "guard"),
    [
        ("unicode", "◇near(exit) ∧ □alive", "¬near(exit) ∧ alive"),
        ("ascii", "F near(exit) & G alive", "!near(exit) & alive"),
        ("english", "Reach near(exit), and keep alive throughout.", "not near(exit) and alive"),
    ],
)
def test_labels_and_guards_are_drawn_in_the_chosen_notation(notation: Notation, label: str, guard: str) -> None:
    drawn = parse_dot(dot_text(cover_and_hide(), Options(notation=notation)))
    assert drawn.get_node("3").attr["tooltip"].endswith(": " + label)
    assert drawn.get_edge("3", "3").attr["tooltip"] == guard


@settings(max_examples=30, deadline=None)
@given(automata() | infinite_automata())
def test_every_state_and_guard_is_drawn_once(fspa: Fspa) -> None:
    drawn = parse_dot(dot_text(fspa))
    assert len(drawn.nodes()) == len(fspa.states) + 1
    expected = guards_by_arrow(whole_drawing(fspa).edges, "unicode")
    assert sum(map(len, expected.values())) == len(fspa.edges)
    texts = {tuple(map(int, edge)): words_of(edge.attr["label"]) for edge in drawn.edges() if edge[0] != "start"}
    assert len(drawn.edges()) == len(texts) + 1
    assert {ends: text.split() for ends, text in texts.items()} == {
        ends: " ".join(guards).split() for ends, guards in expected.items()
    }


@times(30)
@given(hostile_automata())
def test_hostile_texts_stay_texts(fspa: Fspa) -> None:
    drawn = parse_dot(dot_text(fspa))
    assert sorted(drawn.nodes()) == sorted(["start", *(str(state.id) for state in fspa.states)])
    ends = {(str(edge.source), str(edge.target)) for edge in fspa.edges}
    assert sorted(map(tuple, drawn.edges())) == sorted([("start", "0"), *ends])
    for state in fspa.states:
        attributes = drawn.get_node(str(state.id)).attr
        words = words_of(attributes["label"]).split()[1:]
        assert words == escape_invisible(" ".join(wrap_text(label_text(fspa, state.id, "unicode"), 30))).split()
        assert attributes["color"] == LINES[state.verdict]


def test_parallel_edges_share_an_arrow_that_shows_their_pairs() -> None:
    """The labels of two loops at one state would overlap."""
    (fspa,) = compile_text("signal a: bool spec s { semantics infinite require G F a }")
    drawn = parse_dot(dot_text(replace(fspa, acceptance=(Pair((0,), (1,)), Pair((), (0,))))))
    (loop,) = (edge for edge in drawn.edges() if edge[0] == edge[1])
    assert loop.attr["tooltip"] == "¬a [fin 0] [inf 1]; a [inf 0]"
    assert words_of(loop.attr["label"]).split() == "¬a [fin 0] [inf 1] a [inf 0]".split()


def test_an_arrow_with_very_many_guards_counts_the_rest() -> None:
    fspa = cover_and_hide()
    edges = tuple(replace(fspa.edges[0], guard=Guard(atom(f"p{index}"), ())) for index in range(MOST_GUARDS + 3))
    drawn = parse_dot(dot_text(replace(fspa, edges=edges)))
    loop = drawn.get_edge("0", "0")
    words = words_of(loop.attr["label"]).split()
    assert words == [*(f"p{index}" for index in range(MOST_GUARDS)), "and", "3", "more"]
    assert loop.attr["tooltip"].endswith(f"; p{MOST_GUARDS + 2}")


@pytest.mark.parametrize(
    ("formula", "legend"),
    [
        ("G F a", "A trace is accepted if its steps are marked [inf 0] again and again for ever."),
        (
            "F G a",
            "A trace is accepted if its steps are marked [inf 0] again and again for ever, and [fin 0] only finitely"
            " often.",
        ),
        (
            "G F a | F G b",
            "A trace is accepted if, for some n, its steps are marked [inf n] again and again for ever,"
            " and [fin n] only finitely often.",
        ),
        ("F (a & !a)", ""),
    ],
)
def test_the_legend_explains_the_pairs(formula: str, legend: str) -> None:
    (fspa,) = compile_text(f"signal a: bool signal b: bool spec s {{ semantics infinite require {formula} }}")
    drawn = parse_dot(dot_text(fspa))
    title = " ".join(words_of(drawn.graph_attr["label"]).split())
    assert (legend in title) if legend else ("accepted" not in title)


@pytest.mark.parametrize(
    ("formula", "legend"),
    [
        ("F a", "Corner: distance to a goal (double outline). Bold arrows come nearer."),
        ("G a", "Corner: distance to a goal (double outline), ∞ if none can be reached."),
        ("a & !a", "Corner: distance to a goal, ∞ if none can be reached."),
    ],
)
def test_the_legend_explains_only_what_is_drawn(formula: str, legend: str) -> None:
    (fspa,) = compile_text(f"signal a: bool spec s = {formula}")
    drawn = parse_dot(dot_text(fspa))
    assert " ".join(words_of(drawn.graph_attr["label"]).split()) == f"s {legend}"


def test_a_sketch_has_no_guards() -> None:
    drawn = parse_dot(graph(cover_and_hide(), Options(), detail="sketch"))
    assert words_of(drawn.get_node("0").attr["label"]).split() == ["3", "0"]
    assert not drawn.get_edge("0", "1").attr["label"]


def test_guards_can_be_shown_only_in_tooltips() -> None:
    drawn = parse_dot(graph(cover_and_hide(), Options(), detail="labels"))
    assert words_of(drawn.get_node("3").attr["label"]).split() == ["1", "◇near(exit)", "∧", "□alive"]
    edge = drawn.get_edge("0", "1")
    assert (edge.attr["label"] or "", edge.attr["tooltip"]) == ("", "near(s1) ∧ alive")


@pytest.mark.parametrize("character", ["p", "漢", "\u202e", "\\", '"', "<"])
def test_graphviz_can_read_texts_of_any_length(character: str) -> None:
    fspa = cover_and_hide()
    text = 10_000 * f"{character}{character} "
    edges = tuple(replace(edge, guard=replace(edge.guard, formula=Text(text, text, text))) for edge in fspa.edges)
    states = tuple(replace(state, label=Text(text, text, text)) for state in fspa.states)
    drawn = parse_dot(dot_text(replace(fspa, edges=edges, states=states)))
    assert (len(drawn.nodes()), len(drawn.edges())) == (1 + len(states), 1 + len(edges))
    assert drawn.get_edge("0", "1").attr["tooltip"].endswith(" …")


def test_labels_break_before_operators_and_lose_their_last_lines() -> None:
    assert wrap_text("aaaa & bbbb & cccc", 9) == ["aaaa", "& bbbb", "& cccc"]
    assert wrap_text("aaaa & bbbb & cccc", 13) == ["aaaa & bbbb", "& cccc"]
    assert wrap_text("a " * 100, 1, most_lines=3) == ["a", "a", "a …"]
    assert wrap_text("one_word_that_is_too_long", 5) == ["one_word_that_is_too_long"]
    assert wrap_text("", 5) == [""]


def test_comparisons_arguments_and_bounds_stay_on_one_line() -> None:
    assert wrap_text("at & !(force > 40) & (speed < 2.5)", 9) == ["at", "& !(force > 40)", "& (speed < 2.5)"]
    assert wrap_text("near(a) & placed(cube, tray)", 15) == ["near(a)", "& placed(cube, tray)"]
    assert wrap_text("a & F[0,4] b", 8) == ["a", "& F[0,4] b"]
    assert wrap_text("aaaa & b [fin 10] [inf 2]", 8) == ["aaaa & b", "[fin 10] [inf 2]"]
    assert wrap_text("Reach near(a, close=3), then b.", 24) == ["Reach near(a, close=3),", "then b."]
    assert wrap_text("not aaaa or not bbbb", 9) == ["not aaaa", "or not bbbb"]
    assert wrap_text("a - b + c > 0", 4) == ["a - b +", "c > 0"], "no longer than two widths"


def test_operators_inside_names_of_atoms_are_kept() -> None:
    names = ("x!", "a & b", "true_love")
    guard = Guard(and_(not_(atom(names[0])), or_(atom(names[1]), not_(atom(names[2])))), ())
    assert guard_text(guard, "unicode") == "¬x! ∧ (a & b ∨ ¬true_love)"
    assert guard_text(guard, "english") == "not x! and (a & b or not true_love)"
