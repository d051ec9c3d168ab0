"""The first fix of clauses that were once led to another meaning, and those that get none because they have two."""

from __future__ import annotations

import pytest

from tests.grammar.phrases_as_typed import errors, fix, is_equivalent, prelude
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic


def spec(clause: str, declarations: str = "platformer") -> str:
    return f"{prelude(declarations)}spec s {{\n{clause}\n}}\n"


def first_error(clause: str, declarations: str = "platformer") -> Diagnostic:
    return errors(SourceFile("a.tltl", spec(clause, declarations)))[0]


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("keep damaged implies invulnerable for 1 s", "keep damaged implies always for 1 s invulnerable"),
        ("keep damaged -> invulnerable for 60 steps", "keep damaged implies always for 60 steps invulnerable"),
        ("always (damaged -> invulnerable for 60 steps)", "keep damaged implies always for 60 steps invulnerable"),
        (
            "require always (damaged -> invulnerable for 60 steps)",
            "keep damaged implies always for 60 steps invulnerable",
        ),
        (
            "require damaged -> invulnerable for 60 steps",
            "require damaged implies always for 60 steps invulnerable",
        ),
        ("after damaged keep invulnerable for 1 s", "keep damaged implies always for 1 s invulnerable"),
        ("avoid died more than 3 times", "keep times(died) <= 3"),
        ("avoid died > 3", "keep times(died) <= 3"),
        ("keep died <= 3", "keep times(died) <= 3"),
        ("avoid at_door after died", "keep died implies always not at_door"),
        ("reach has_key and at_door within 5 s", "require eventually within 5 s (has_key and at_door)"),
        ("keep health > 3 is true", "keep health > 3"),
        ("reach has_key once", "reach has_key"),
        ("reach health == 100 then at_door", "reach health >= 100 then at_door"),
        ("reach health == 0", "reach health <= 0"),
        ("keep coins never decrease", "avoid coins < previous(coins)"),
        ("reach coins >= 100 and no damaged", "reach coins >= 100 avoid damaged"),
        ("unless has_key, never at_door", "keep at_door implies has_key"),
        ("after damaged reach checkpoint within 10 s", "keep damaged implies eventually within 10 s checkpoint"),
        ("if damaged then reach checkpoint within 8 s", "keep damaged implies eventually within 8 s checkpoint"),
        ("when damaged reach not damaged within 8 s", "keep damaged implies eventually within 8 s not damaged"),
        ("whenever damaged, checkpoint within 8 s", "keep damaged implies eventually within 8 s checkpoint"),
        (
            "after died reach checkpoint or not died within 10 s",
            "keep died implies eventually within 10 s (checkpoint or not died)",
        ),
        ("as soon as damaged reach checkpoint within 10 s", "keep damaged implies eventually within 10 s checkpoint"),
        ("following damaged, checkpoint within 10 s", "keep damaged implies eventually within 10 s checkpoint"),
        ("after boss_dead keep health > 0", "keep boss_dead implies always health > 0"),
        ("after boss_dead, keep health > 0", "keep boss_dead implies always health > 0"),
        ("once boss_dead keep health > 0", "keep boss_dead implies always health > 0"),
        ("after coins >= 30 keep health > 0", "keep coins >= 30 implies always health > 0"),
        ("after damaged, keep invulnerable for 1 s", "keep damaged implies always for 1 s invulnerable"),
        ("avoid damaged then damaged within 2 s", "avoid (begins damaged) then within 2 s (begins damaged)"),
        ("at most 3 times died", "keep times(died) <= 3"),
        ("keep coins is three", "keep coins == 3"),
        ("avoid coins is not three", "avoid coins != 3"),
    ],
)
def test_the_first_fix_has_the_meaning(typed: str, meant: str) -> None:
    text, left = fix(spec(typed))
    assert not left
    assert is_equivalent(text, spec(meant))


@pytest.mark.parametrize(
    "typed",
    [
        "once has_key",
        "keep at_door implies has_key once",
        "has_key before at_door",
        "at_exit requires boss_dead",
        "reach has_key then at_door then at_exit in 90 s",
        "after boss_dead, door_open",
        "not jumping until boss_dead",
        "must has_key",
        "never has_key or at_door",
        "never invulnerable for 3 s",
        "keep invulnerable for 3 s",
        "reach has_key then at_door within 90 s",
        "reach coins >= 30 before at_door",
        "after boss_dead reach at_exit",
        "after boss_dead keep damaged at most 3 times",
        "after boss_death keep health > 0",
        "while damaged reach at_door",
        "if damaged keep invulnerable within 5 s",
        "after damaged keep invulnerable within 5 s",
        "reach at most 50 coins",
        "the player must reach at most 50 coins",
        "coins is three",
    ],
)
def test_a_clause_with_two_readings_gets_no_fix(typed: str) -> None:
    error = first_error(typed)
    assert error.fixes == ()
    assert error.help


@pytest.mark.parametrize("word", ["after", "once", "following"])
def test_a_sentence_that_begins_with_an_event_gets_the_clauses_for_it(word: str) -> None:
    for typed in (
        f"{word} boss_dead reach has_key then at_exit",
        f"{word} boss_dead keep damaged at most 3 times",
        f"{word} boss_death reach at_exit",
    ):
        help_ = first_error(typed).help or ""
        assert "implies always a` for" in help_ or "implies eventually" in help_


def test_a_value_that_an_enum_lacks_gets_its_values() -> None:
    assert first_error("light is blu", "puzzle").help == (
        "`light` has no value `blu`: its values are `red`, `green`, `blue`"
    )


@pytest.mark.parametrize(
    "typed",
    [
        "avoid died more than 3 times",
        "after damaged keep invulnerable for 1 s",
        "at most 3 times died",
        "the player must reach has_key",
        "reach has_key within 5 s",
        "reach at least 5 coins",
    ],
)
def test_what_is_underlined_is_what_the_first_fix_replaces(typed: str) -> None:
    error = first_error(typed)
    (edit,) = error.fixes[0].edits
    assert error.labels[0].span == edit.span


@pytest.mark.parametrize(
    "typed", ["avoid died > 3", "keep died < 50", "keep died more than 3", "reach died >= 3 times"]
)
def test_a_truth_is_never_offered_percent(typed: str) -> None:
    error = first_error(typed)
    assert "%" not in f"{error.help} {[fix.title for fix in error.fixes]}"


def test_once_is_never_offered_as_a_call() -> None:
    for typed in ("once has_key", "reach once", "keep has_key once", "at_door once has_key"):
        error = first_error(typed)
        assert "once(" not in f"{error.help} {[fix.title for fix in error.fixes]}"


@pytest.mark.parametrize(
    ("declared", "meant"),
    [
        ("signal speed: number in [0 m/s, 10 m/s]", "signal speed: speed in [0 m/s, 10 m/s]"),
        ("signal speed in [0 m/s, 10 m/s]", "signal speed: speed in [0 m/s, 10 m/s]"),
        ("signal speed: speed in [0, 10] m/s", "signal speed: speed in [0 m/s, 10 m/s]"),
    ],
)
def test_a_range_with_a_unit_gets_its_type(declared: str, meant: str) -> None:
    rest = "\nspec s = G speed < 3 m/s\n"
    assert fix(f"{declared}{rest}") == (f"{meant}{rest}", [])


def test_the_error_names_the_signal_that_has_no_range() -> None:
    (error,) = errors(SourceFile("a.tltl", "signal near: number signal far in [0, 9] spec s = G near < far"))
    assert error.code == "TLT0311"
    assert "for `near`" in (error.help or "")
