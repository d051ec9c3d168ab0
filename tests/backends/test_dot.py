from __future__ import annotations

import html
import re

import pygraphviz
import pytest
from hypothesis import given, settings

from tests.backends.strategies import automata, hostile_automata, infinite_automata
from tests.fixtures import cover_and_hide
from tltlc import backends, compile_text
from tltlc.automaton.fspa import Fspa, Pair, Text
from tltlc.backends import Options
from tltlc.backends.dot import FILLS, LINES, graph
from tltlc.backends.drawing.texts import Guards, visible, wrapped
from tltlc.record import replace


def emitted(fspa: Fspa, options: Options | None = None) -> str:
    text = backends.emit("dot", fspa, options)[f"{fspa.name}.dot"]
    assert isinstance(text, str)
    return text


def parsed(text: str) -> pygraphviz.AGraph:
    return pygraphviz.AGraph(string=text)


def words_of(label: str) -> str:
    """The text that an HTML-like label shows."""
    return html.unescape(re.sub(r"<[^>]*>", " ", label.replace("<BR/>", " ")))


def test_loops_of_final_states_are_on_the_right_where_no_edge_arrives() -> None:
    drawn = parsed(emitted(cover_and_hide()))
    on_the_right = [edge[0] for edge in drawn.edges() if edge[0] == edge[1] and edge.attr["headport"] == "e"]
    assert on_the_right == [str(state.id) for state in cover_and_hide().states if state.verdict == "violated"]


def test_the_picture_shows_what_the_figure_of_the_paper_shows() -> None:
    fspa, drawn = cover_and_hide(), parsed(emitted(cover_and_hide()))
    assert len(drawn.nodes()) == 1 + len(fspa.states)
    assert drawn.has_edge("start", "0")
    for state in fspa.states:
        node = drawn.get_node(str(state.id))
        distance = "∞" if state.distance is None else str(state.distance)
        assert words_of(node.attr["label"]).split() == [*distance.split(), *state.label.unicode.split()]
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
        ("english", "Eventually near(exit); and always alive.", "not near(exit) and alive"),
    ],
)
def test_notations(notation: backends.Notation, label: str, guard: str) -> None:
    drawn = parsed(emitted(cover_and_hide(), Options(notation=notation)))
    assert drawn.get_node("3").attr["tooltip"].endswith(": " + label)
    assert drawn.get_edge("3", "3").attr["tooltip"] == guard


@settings(max_examples=30, deadline=None)
@given(automata() | infinite_automata())
def test_every_state_and_edge_is_drawn_once(fspa: Fspa) -> None:
    drawn = parsed(emitted(fspa))
    expected = sorted((str(edge.source), str(edge.target)) for edge in fspa.edges)
    assert sorted(pair for pair in drawn.edges() if pair[0] != "start") == expected
    assert len(drawn.nodes()) == len(fspa.states) + 1


@settings(max_examples=80, deadline=None)
@given(hostile_automata())
def test_hostile_texts_stay_texts(fspa: Fspa) -> None:
    drawn = parsed(emitted(fspa))
    assert sorted(drawn.nodes()) == sorted(["start", *(str(state.id) for state in fspa.states)])
    assert len(drawn.edges()) == len(fspa.edges) + 1
    for state in fspa.states:
        attributes = drawn.get_node(str(state.id)).attr
        shown = words_of(attributes["label"]).split()[1:]
        assert shown == visible(" ".join(wrapped(state.label.unicode, 30))).split()
        assert attributes["color"] == LINES[state.verdict]


def test_edges_that_pairs_tell_apart_are_both_drawn_with_the_pairs() -> None:
    (fspa,) = compile_text("signal a: bool spec s { semantics infinite require G F a }")
    drawn = parsed(emitted(replace(fspa, acceptance=(Pair((0,), (1,)), Pair((), (0,))))))
    loops = [edge for edge in drawn.edges() if tuple(edge) == ("0", "0")]
    assert sorted(edge.attr["tooltip"] for edge in loops) == ["a [inf 0]", "¬a [fin 0] [inf 1]"]
    assert all(words_of(edge.attr["label"]).split() == edge.attr["tooltip"].split() for edge in loops)


def test_a_sketch_has_no_guards() -> None:
    drawn = parsed(graph(cover_and_hide(), Options(), detail="sketch"))
    assert words_of(drawn.get_node("0").attr["label"]).split() == ["3", "0"]
    assert not drawn.get_edge("0", "1").attr["label"]


def test_guards_may_be_left_to_the_tooltips() -> None:
    drawn = parsed(graph(cover_and_hide(), Options(), detail="labels"))
    assert words_of(drawn.get_node("3").attr["label"]).split() == ["1", "◇near(exit)", "∧", "□alive"]
    edge = drawn.get_edge("0", "1")
    assert (edge.attr["label"] or "", edge.attr["tooltip"]) == ("", "near(s1) ∧ alive")


@pytest.mark.parametrize("character", ["p", "漢", "\u202e", "\\", '"', "<"])
def test_texts_of_any_length_can_be_read_by_graphviz(character: str) -> None:
    fspa = cover_and_hide()
    text = 10_000 * f"{character}{character} "
    edges = tuple(replace(edge, guard=replace(edge.guard, text=text)) for edge in fspa.edges)
    states = tuple(replace(state, label=Text(text, text, text)) for state in fspa.states)
    drawn = parsed(emitted(replace(fspa, edges=edges, states=states)))
    assert (len(drawn.nodes()), len(drawn.edges())) == (1 + len(states), 1 + len(edges))
    assert drawn.get_edge("0", "1").attr["tooltip"].endswith(" …")


def test_long_labels_are_wrapped_before_operators_and_cut() -> None:
    assert wrapped("aaaa & bbbb & cccc", 9) == ["aaaa", "& bbbb", "& cccc"]
    assert wrapped("aaaa & bbbb & cccc", 13) == ["aaaa & bbbb", "& cccc"]
    assert wrapped("a " * 100, 1, most_lines=3) == ["a", "a", "a …"]
    assert wrapped("one_word_that_is_too_long", 5) == ["one_word_that_is_too_long"]
    assert wrapped("", 5) == [""]


def test_comparisons_arguments_and_bounds_stay_on_one_line() -> None:
    assert wrapped("at & !(force > 40) & (speed < 2.5)", 9) == ["at", "& !(force > 40)", "& (speed < 2.5)"]
    assert wrapped("near(a) & placed(cube, tray)", 15) == ["near(a)", "& placed(cube, tray)"]
    assert wrapped("a & F[0,4] b", 8) == ["a", "& F[0,4] b"]
    assert wrapped("aaaa & b [fin 10] [inf 2]", 8) == ["aaaa & b", "[fin 10] [inf 2]"]
    assert wrapped("Reach near(a, close=3), then b.", 24) == ["Reach near(a, close=3),", "then b."]
    assert wrapped("not aaaa or not bbbb", 9) == ["not aaaa", "or not bbbb"]
    assert wrapped("a - b + c > 0", 4) == ["a - b +", "c > 0"], "no longer than two widths"


def test_names_of_atoms_are_kept_whatever_operators_stand_in_them() -> None:
    fspa = cover_and_hide()
    atoms = tuple(replace(a, name=n) for a, n in zip(fspa.atoms, ("x!", "a & b", "true_love", "b"), strict=True))
    guards = Guards(replace(fspa, atoms=atoms), "unicode")
    assert guards.text("!x! & (a & b | !true_love) -> true") == "¬x! ∧ (a & b ∨ ¬true_love) ⇒ ⊤"
