from __future__ import annotations

import re
from html import unescape

from hypothesis import given, settings

from tests.backends.strategies import automata, hostile_automata, infinite_automata
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tltlc import backends, compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.backends.drawing.picture_content import folded_drawing
from tltlc.backends.drawing.texts import escape_invisible, guards_by_arrow

STATE = re.compile(r'    state "([^"]*)" as s(\d+)')
EDGE = re.compile(r"    s(\d+) --> s(\d+): ([^:;]*(?:#\d+;[^:;]*)*)")
LEGEND = re.compile(r'    state "([^"]*)" as legend')
CLASS = re.compile(r"    class s(\d+) (satisfied|holding|pending|violated)")
FOLDED = re.compile(r"    class s(\d+) folded")


def mermaid_text(fspa: Fspa) -> str:
    text = backends.emit("mermaid", fspa)[f"{fspa.name}.mmd"]
    assert isinstance(text, str)
    return text


def words(text: str) -> list[str]:
    """Return the words that Mermaid shows for a text, whatever its line breaks."""
    return unescape(re.sub(r"#(\d+);", r"&#\1;", text.replace("<br/>", " "))).split()


def check(fspa: Fspa) -> None:
    """Assert that every line has one of the allowed forms, and that each drawn state and arrow has exactly one line."""
    drawing = folded_drawing(fspa)
    lines = mermaid_text(fspa).splitlines()
    assert lines[:2] == ["stateDiagram-v2", "    direction LR"]
    assert words(lines[2]) == escape_invisible(f"accTitle: The automaton of {fspa.name}").split()
    assert lines[-1] == "    class legend legend"
    (legend,) = (match[1] for line in lines if (match := LEGEND.fullmatch(line)))
    rest = [line for line in lines[3:-1] if not line.startswith("    classDef ") and not LEGEND.fullmatch(line)]
    states = [match for line in rest if (match := STATE.fullmatch(line))]
    edges = [match for line in rest if (match := EDGE.fullmatch(line))]
    classes = [match for line in rest if (match := CLASS.fullmatch(line))]
    dashed = [int(match[1]) for line in rest if (match := FOLDED.fullmatch(line))]
    assert [int(match[2]) for match in states] == [state.id for state in drawing.states]
    expected = guards_by_arrow(drawing.edges, "unicode")
    assert [(int(match[1]), int(match[2])) for match in edges] == list(expected)
    assert all(
        words(match[3]) == escape_invisible(" ".join("; ".join(guards).split())).split() or words(match[3])[-1] == "…"
        for match, guards in zip(edges, expected.values(), strict=True)
    )
    assert [(int(match[1]), match[2]) for match in classes] == [(state.id, state.verdict) for state in drawing.states]
    assert dashed == list(drawing.folded)
    assert len(states) + len(edges) + len(classes) + len(dashed) + 1 == len(rest)
    assert sum("direction" in line.lower() for line in lines) == 1
    for text in [legend, *(match[1] for match in states), *(match[3] for match in edges)]:
        text = text.replace("<br/>", "")
        assert not re.search(r"""[<>"'`{}\[\]%\\&|:]|(?<!\d);|#(?!\d+;)|-""", text)


def test_the_diagram_of_cover_and_hide_has_its_states_and_guards() -> None:
    check(cover_and_hide())
    text = mermaid_text(cover_and_hide())
    assert '    state "◇near(exit) ∧ □alive<br/>#91;1#93;" as s3' in text
    assert "    s3 --> s4: near(exit) ∧ alive\n" in text
    assert "    [*] --> s0\n" in text
    assert "    class s4 holding\n" in text


def test_comparisons_are_written_as_a_designer_writes_them() -> None:
    (fspa,) = compile_text("signal x: number in [0, 9]\nspec far { reach x >= 7 then x <= 1 }")
    text = " ".join(words(mermaid_text(fspa)))
    assert "(x >= 7)" in text and "(x <= 1)" in text
    assert "¬" not in text


def test_parallel_edges_share_an_arrow_that_shows_their_pairs() -> None:
    """Mermaid draws only one of two loops at a state."""
    (fspa,) = compile_text("signal a: bool spec s { semantics infinite require G F a }")
    assert [line for line in mermaid_text(fspa).splitlines() if EDGE.fullmatch(line)] == [
        "    s0 --> s0: ¬a#59;<br/>a #91;inf 0#93;",
    ]
    assert "its steps are marked [inf 0] again" in " ".join(words(mermaid_text(fspa)))
    check(fspa)


def test_runs_are_folded() -> None:
    (fspa,) = compile_text("signal fast: bool spec quick = eventually within 40 steps fast")
    text = mermaid_text(fspa)
    assert len([line for line in text.splitlines() if STATE.fullmatch(line)]) == 5
    assert "Dashed#58; 39 of the 43<br/>states, folded." in text
    assert 'state "39 more like these#58;<br/>◇' in text
    assert "    classDef folded stroke-dasharray:6 4\n" in text
    check(fspa)


@settings(max_examples=30, deadline=None)
@given(automata() | infinite_automata())
def test_every_line_of_a_diagram_is_valid(fspa: Fspa) -> None:
    check(fspa)


@times(30)
@given(hostile_automata())
def test_hostile_texts_stay_texts(fspa: Fspa) -> None:
    check(fspa)
