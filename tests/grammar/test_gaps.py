"""Sentences with words that no name of the file has get their clauses, with a letter for these words."""

from __future__ import annotations

import re

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors
from tltlc.core.source import SourceFile

HEAD = "clock 10 Hz\nsignal fire: bool\nsignal spray: bool\nsignal health in [0, 100]\n"


def help_of(typed: str) -> str:
    return errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))[0].help or ""


@pytest.mark.parametrize(
    ("typed", "clause", "conditions"),
    [
        ("keep ends fire implies gates up within 4 s", "keep ends fire implies eventually within 4 s p", ["gates up"]),
        ("keep door closed while spray", "keep spray implies p", ["door closed"]),
        ("after fire, no trading until spray", "keep fire implies (not p weak_until spray)", ["trading"]),
        ("when fire, the lamp glows within 5 s", "keep fire implies eventually within 5 s p", ["lamp glows"]),
        ("the player has to be calm when spray", "keep spray implies p", ["calm"]),
        ("whenever the boss dies, music within 2 s", "keep p implies eventually within 2 s q", ["boss dies", "music"]),
        ("no trading during combat", "keep q implies not p", ["trading", "combat"]),
    ],
)
def test_a_letter_stands_for_what_the_file_has_no_name_for(typed: str, clause: str, conditions: list[str]) -> None:
    text = help_of(typed)
    assert text.startswith(f"write `{clause}`, with your condition")
    assert re.findall(r"for `([^`]*)` in place of `[pq]`", text) == conditions
    tltlc.compile_text(f"{HEAD}signal p: bool\nsignal q: bool\nspec s {{ {clause} }}")


def test_a_letter_is_no_name_of_the_file() -> None:
    text = f"{HEAD}signal p: bool\nspec s {{\nafter p, no trading until spray\n}}\n"
    (error,) = errors(SourceFile("a.tltl", text))
    assert error.help == (
        "write `keep p implies (not q weak_until spray)`, with your condition for `trading` in place of `q`"
    )


@pytest.mark.parametrize(
    "typed",
    [
        "if fire then spray besides wave",
        "keep fire implies trading twice",
        "when sun, rain and wind, fire",
        "whenever the quick brown lazy old fox jumps, fire",
        "health rises like wurble than spray",
    ],
)
def test_words_that_join_conditions_and_many_unknown_words_get_no_letter(typed: str) -> None:
    assert "in place of" not in help_of(typed)
