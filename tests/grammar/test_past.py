"""English about the trace so far: each suggested text compiles, and means what its row says."""

from __future__ import annotations

import re

import pytest

from tltlc import compile_text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.parser import parse
from tltlc.pipeline import Session
from tltlc.tools.lint.scopes import apply_edits

NAMES = (
    "clock 10 Hz\nentity e\nsignal seen: bool\nsignal hidden: bool\nsignal alarm: bool\nsignal hp in [0, 9]\n"
    "signal near(x: entity): bool\n"
)


def _error(clause: str) -> tuple[str, Diagnostic]:
    text = f"{NAMES}spec s {{ {clause} }}"
    diagnostics = Session(SourceFile("a.tltl", text)).syntax_errors
    assert diagnostics, clause
    return text, diagnostics[0]


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("keep Y seen", "keep previously seen"),
        ("keep O seen implies hidden", "keep once seen implies hidden"),
        ("keep not H near(e)", "keep not historically near(e)"),
        ("keep hidden S alarm", "keep hidden since alarm"),
        ("keep not hidden S near(e) or seen", "keep not hidden since near(e) or seen"),
        ("keep previous seen implies hidden", "keep previously seen implies hidden"),
        ("keep previous hp <= hp", "keep previous(hp) <= hp"),
        ("keep hp >= previous hp", "keep hp >= previous(hp)"),
        ("keep seen begins implies hidden", "keep begins seen implies hidden"),
        ("reach near(e) ends", "reach ends near(e)"),
        ("keep seen in the last 5 s", "keep once within 5 s seen"),
        ("keep alarm implies seen within the last 5 seconds", "keep alarm implies once within 5 s seen"),
        ("keep not seen in the last 20 steps", "keep not once within 20 steps seen"),
        ("reach hidden for the last 3 s", "reach time_holding(hidden) >= 3 s"),
        ("keep alarm implies hidden for the last 3 s", "keep alarm implies historically for 3 s hidden"),
        ("reach hidden for 3 s", "reach time_holding(hidden) >= 3 s"),
        ("reach near(e) and hidden for 2 seconds", "reach time_holding((near(e) and hidden)) >= 2 s"),
        ("reach for 3 s hidden", "reach time_holding(hidden) >= 3 s"),
        ("reach hidden and near(e) at least twice", "reach hidden and times(near(e)) >= 2"),
    ],
)
def test_a_fix_gives_what_was_meant(wrong: str, right: str) -> None:
    text, error = _error(wrong)
    fixed = apply_edits(SourceFile("a.tltl", text), error.fixes[0].edits)
    assert fixed.text == f"{NAMES}spec s {{ {right} }}"
    compile_text(fixed.text)


@pytest.mark.parametrize(
    ("wrong", "suggested"),
    [
        ("keep seen at most 3 times", "keep times(seen) <= 3"),
        ("keep seen at most twice", "keep times(seen) <= 2"),
        ("keep seen less than 3 times", "keep times(seen) < 3"),
        ("keep seen at least twice", "reach times(seen) >= 2"),
        ("reach seen at least twice", "reach times(seen) >= 2"),
        ("reach seen at least once", "reach seen"),
        ("reach near(e) 3 times", "reach times(near(e)) >= 3"),
        ("reach seen at most 3 times", "keep times(seen) <= 3"),
        ("avoid seen more than 3 times", "avoid times(seen) > 3"),
        ("never seen more than 3 times", "avoid times(seen) > 3"),
        ("keep never seen more than 3 times", "avoid times(seen) > 3"),
    ],
)
def test_a_suggested_clause_compiles(wrong: str, suggested: str) -> None:
    _, error = _error(wrong)
    assert (error.help or "").splitlines()[0] == f"write `{suggested}`"
    compile_text(f"{NAMES}spec s {{ {suggested} }}")


@pytest.mark.parametrize(
    "wrong",
    ["keep alarm implies was seen", "keep has been seen implies hidden", "keep had been seen", "keep seen already"],
)
def test_words_for_what_has_held_suggest_once_and_say_what_it_means(wrong: str) -> None:
    _, error = _error(wrong)
    assert error.help == "write `once seen`, which is true from the first step with `seen` on"
    assert error.fixes == ()


def test_a_time_behind_several_conditions_may_be_about_the_last_or_about_all() -> None:
    _, error = _error("keep hidden and seen in the last 5 s")
    assert error.help == "write `keep hidden and once within 5 s seen`, or `keep once within 5 s (hidden and seen)`"
    assert error.fixes == ()


@pytest.mark.parametrize("wrong", ["keep not hidden for the last 3 s", "keep seen 3 times"])
def test_a_phrase_with_two_readings_gets_no_fix(wrong: str) -> None:
    _, error = _error(wrong)
    assert error.fixes == ()


@pytest.mark.parametrize(
    ("clause", "form"),
    [
        ("keep count(seen) <= 3", "`times(p)`"),
        ("keep prev(hp) <= hp", "`previous(x)`"),
        ("keep duration(hidden) < 3 s", "`time_holding(p)`"),
        ("keep elapsed(alarm) > 3 s", "`time_since(p)`"),
        ("keep rising(seen) implies hidden", "`begins p`"),
        ("keep time since alarm < 5 s", "`time_since(alarm)`"),
    ],
)
def test_names_from_elsewhere_are_explained(clause: str, form: str) -> None:
    with pytest.raises(TltlError) as failure:
        compile_text(f"{NAMES}spec s {{ {clause} }}")
    assert form in (failure.value.diagnostics[0].help or "")


def test_declared_names_keep_their_meaning() -> None:
    text = f"{NAMES}signal Y(x: entity): bool\nspec s {{ keep Y e }}"
    error = parse(SourceFile("a.tltl", text))[1][0]
    assert re.search(r"write `Y\(e\)`", error.help or "")


def test_a_name_in_a_comment_is_not_declared() -> None:
    text = f"{NAMES}// signal Y: the second axis, and import nothing\nspec s {{ keep Y seen }}"
    error = parse(SourceFile("a.tltl", text))[1][0]
    assert error.help == "write `keep previously seen`"


@pytest.mark.parametrize("clause", ["keep Y e", "keep has key", "keep a S b"])
def test_what_may_be_an_imported_name_is_no_past_operator(clause: str) -> None:
    text = f"import stealth\nspec s {{ {clause} }}"
    error = parse(SourceFile("a.tltl", text))[1][0]
    assert not re.search("previously|once|since", error.help or "")


def test_an_operand_with_since_is_put_in_brackets() -> None:
    text, error = _error("avoid hidden since seen before alarm")
    fixed = apply_edits(SourceFile("a.tltl", text), error.fixes[0].edits) if error.fixes else None
    assert fixed is None or "(not (hidden since seen)) weak_until alarm" in fixed.text
