"""A help about a test of a value, or a bound with the wrong word, keeps what the author wrote, and compiles."""

from __future__ import annotations

import re

import pytest

from tests.grammar.suggestions import NAMES, VARIES, error_of, suggestions
from tltlc import compile_text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.tools.lint.scopes import apply_edits


def mended(clause: str) -> str:
    """Apply the first fix of each error until the clause compiles, and return the clause."""
    head = f"{NAMES}spec s {{ "
    text = f"{head}{clause} }}"
    for _ in range(4):
        try:
            compile_text(text)
        except TltlError as error:
            text = apply_edits(SourceFile("a.tltl", text), error.diagnostics[0].fixes[0].edits).text
        else:
            return text.removeprefix(head).removesuffix(" }")
    raise AssertionError(text)


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        ("keep mode is chase or alert", "keep mode is chase or mode is alert"),
        ("keep chase implies a", "keep mode is chase implies a"),
        ("keep a implies not chase", "keep a implies not mode is chase"),
        ("keep alert or chase implies a", "keep mode is alert or mode is chase implies a"),
        ("keep Mode is alert", "keep mode is alert"),
        ("keep phase = 3 implies once phase = 2", "keep phase == 3 implies once phase == 2"),
        ("keep mode = chase or mode = alert", "keep mode is chase or mode is alert"),
        ("keep phase ≠ 0", "keep phase != 0"),
        ("keep phase ≠ last", "keep phase != last"),
        ("keep mode ≠ idle", "keep mode is not idle"),
    ],
)
def test_the_fixes_keep_each_value(clause: str, meant: str) -> None:
    assert mended(clause) == meant


def test_a_second_value_after_is_not_gets_no_fix() -> None:
    error = error_of("keep mode is not chase or alert")[1]
    assert error.fixes == ()
    assert error.help == "`alert` is a value of `mode`: write `mode is not chase and mode is not alert`"


def test_the_value_of_an_enum_at_the_step_before_gets_a_form() -> None:
    error = error_of("keep previous(mode) is alert implies a")[1]
    assert error.help == "write `keep previously (mode is alert) implies a`"
    assert [edit.text for fix in error.fixes for edit in fix.edits] == ["keep previously (mode is alert) implies a"]
    compile_text(f"{NAMES}spec s {{ keep previously (mode is alert) implies a }}")


@pytest.mark.parametrize("names", ["signal other: (low, alert)", "signal state(x: entity): (calm, hunting)"])
def test_a_value_of_two_enums_or_of_many_signals_gets_no_fix(names: str) -> None:
    value = "alert" if "alert" in names else "hunting"
    error = error_of(f"keep {value} implies a", f"{NAMES}{names}\n")[1]
    assert error.fixes == ()
    assert f"`{value}` is a value of" in (error.help or "")


@pytest.mark.parametrize(
    ("clause", "each", "some"),
    [
        ("keep once for 5 s a implies b", "historically for 5 s a", "once within 5 s a"),
        ("keep historically within 3 s a implies b", "historically for 3 s a", "once within 3 s a"),
        ("keep b implies eventually for 2 s not a", "always for 2 s not a", "eventually within 2 s not a"),
        ("keep b implies always within 2 s (a or b)", "always for 2 s (a or b)", "eventually within 2 s (a or b)"),
        ("keep b implies next for 2 s a", "weak_next always for 2 s a", "next after 2 s a"),
    ],
)
def test_a_bound_with_the_wrong_word_keeps_its_time_and_formula(clause: str, each: str, some: str) -> None:
    assert re.findall("`([^`]*)`", error_of(clause)[1].help or "") == [each, some]
    for reading in suggestions(clause):
        compile_text(f"{NAMES}spec s {{ {reading} }}")


def test_a_bound_in_steps_where_the_clock_varies_gets_a_time() -> None:
    assert error_of("keep once for 5 steps a implies b", VARIES)[1].help == "write `once within 2 s p`"
    assert error_of("keep b implies next for 2 s a", VARIES)[1].help == (
        "write `weak_next always for 2 s a` if it must hold for that time from the next step on"
    )


def test_an_equality_of_a_signal_with_a_whole_range_says_to_declare_an_int() -> None:
    error = error_of("keep lap == 2", "signal lap in [1, 3]\n")[1]
    assert "`signal lap: int in [1, 3]`" in (error.help or "")
    assert "true or false" not in (error.help or "")
    assert error.fixes == ()
    assert (
        error_of("keep lap == 1", "signal lap in [1, 3]\n")[1].help
        == "write `keep lap <= 1`: the range of `lap` ends there"
    )
