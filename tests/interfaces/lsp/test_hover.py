"""The hover text for the word at the mark."""

from __future__ import annotations

import pytest
from lsprotocol import types

from tests.interfaces.lsp.texts import open_text
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.hover import hover
from tltlc.interfaces.lsp.slow_analysis import Request, analyse

TEXT = """\
import stealth
entity s1, exit
/// What is left in the tank.
signal fuel: ratio
signal away(x: entity): length in [0 m, 200 m]
param most: length in [1 m, 9 m] = 2 m
let calm = always fuel > 10 %
/// The switch, then the exit.
spec leave {
    limit 40 steps
    reach near(s1) then near(exit)
    keep fuel > 10 % or calm
}
"""


def hover_text(at: str, text: str = TEXT) -> str:
    document, offset, _ = open_text(text.replace(at, "¦" + at, 1))
    result = hover(document, offset, None, "utf-16")
    assert result is not None
    assert isinstance(result.contents, types.MarkupContent)
    return result.contents.value


@pytest.mark.parametrize(
    ("at", "parts"),
    [
        ("fuel: ratio", ("signal fuel: ratio", "What is left in the tank.", "[0, 1]")),
        ("away(", ("length", "[0 m, 200 m]", "metres")),
        ("most", ("2 m", "[1 m, 9 m]")),
        ("calm =", ("let calm = always fuel > 10 %", "Keep fuel > 0.1 throughout.")),
        (
            "near(s1) then",
            ("predicate near(target: entity", "Closeness to `target`", "[-1, 1]", "From `spatial.tltl`."),
        ),
        ("exit\n", ("entity exit",)),
        ("leave {", ("The switch, then the exit.", "Reach near(s1), then near(exit); and whenever", "limit 40 steps")),
        ("reach", ("`reach a then b`", "Reach near(s1), then near(exit).")),
        ("then near", ("Reach near(s1), then near(exit).",)),
        ("or calm", ("Either have fuel > 0.1 now or",)),
        ("keep", ("`keep a`", "Whenever fuel <= 0.1, keep")),
    ],
)
def test_the_hover_text_has_the_expected_parts(at: str, parts: tuple[str, ...]) -> None:
    text = hover_text(at)
    for part in parts:
        assert part in text


def test_the_hover_text_of_a_spec_describes_its_automaton() -> None:
    document, offset, _ = open_text(TEXT.replace("leave {", "¦leave {"))
    analysis = analyse(Request(document.source, (), {}, {}))
    result = hover(document, offset, analysis, "utf-16")
    assert result is not None
    assert isinstance(result.contents, types.MarkupContent)
    figures = analysis.figures[0]
    assert f"{figures.states} states, distance 2." in result.contents.value


def test_the_hover_text_of_an_enum_has_the_numbers_of_its_values() -> None:
    text = "signal mode: (idle, alert)\nsignal phase: int in [0, 5]\nspec a = F mode is alert & F phase == 2\n"
    assert "0 for idle, 1 for alert." in hover_text("mode is", text)
    assert "An int signal, supplied by the game as a whole number; its range is [0, 5]." in hover_text("phase ==", text)


def test_a_space_has_no_hover_text() -> None:
    document, _, _ = open_text(TEXT)
    assert hover(document, TEXT.index("= 2 m"), None, "utf-16") is None


def test_operators_of_infinite_specs_are_explained_as_such() -> None:
    text = "signal a: bool\nspec again {\n    semantics infinite\n    require always eventually a\n}\n"
    assert "again and again" in hover_text("require", text)


def test_a_name_that_shadows_another_is_resolved_correctly() -> None:
    document, offset, _ = open_text("entity s1, s2\nsignal at(x: entity): bool\nspec a = all s in (s1, s2): F at(¦s)")
    result = hover(document, offset, None, "utf-16")
    assert result is not None
    assert isinstance(document, Document)
    assert isinstance(result.contents, types.MarkupContent)
    assert "all s in (s1, s2)" in result.contents.value


def test_times_are_explained_in_steps() -> None:
    text = "clock 20 Hz\n" + TEXT.replace("import stealth\n", "").replace("40 steps", "2 s")
    assert hover_text("2 s", text) == "40 steps of 0.05 s."
    assert hover_text("limit", text) == "`limit 400 steps` or `limit 20 s`"


def test_a_missing_range_is_not_mentioned() -> None:
    text = "param most: length = 2 m\nsignal far: length\nsignal most_of: length in [0 m, inf]\n"
    assert hover_text("most: l", text).endswith("A length constant, 2 m.")
    assert hover_text("far", text).endswith("supplied by the game as metres.")
    assert hover_text("most_of", text).endswith("supplied by the game as metres; its range is [0 m, inf].")


PAST = """\
clock 10 Hz
signal seen: bool
signal hp in [0, 9]
predicate falling in [-1, 1] = clamp(previous(hp) - hp, -1, 1)
spec s {
    keep times(seen) <= 3 and hp >= 1
    keep once within 2 s seen implies time_since(seen) < 4 s
    keep (seen since begins seen)
}
"""


@pytest.mark.parametrize(
    ("at", "parts"),
    [
        (
            "times(seen)",
            ["`times(p)` or `times(p, MAXIMUM)`", "How often p has begun to hold", "In `s`, it stops at 7."],
        ),
        ("time_since(seen)", ["in s", "In `s`, it stops at 80 steps."]),
        ("previous(hp)", ["at the sample before"]),
        ("once within", ["`once p` or `once within 5 s p`", "held before"]),
        ("2 s seen", ["20 steps"]),
        ("since begins", ["`p since q`"]),
        ("begins", ["`begins p`"]),
        ("seen since", ["signal seen: bool"]),
    ],
)
def test_words_about_the_past_are_explained(at: str, parts: list[str]) -> None:
    text = hover_text(at, PAST)
    assert all(part in text for part in parts), text


def test_a_declaration_with_the_name_of_a_function_is_described_instead() -> None:
    text = "signal times(x: entity): bool\nentity a\nspec s { keep times(a) }\n"
    assert "signal times(x: entity): bool" in hover_text("times(a)", text)
