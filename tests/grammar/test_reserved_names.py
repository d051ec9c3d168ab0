"""Words of the language as names: one error at the declaration, and the rest of the file is read with the name."""

from __future__ import annotations

import pytest

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.pipeline import compile_source, compile_text
from tltlc.tools.lint.scopes import apply_edits

RULES = """\
signal won: bool
spec a {{
    limit 9 steps
    reach {0} then won
    avoid begins ({0}) and won
}}
spec b {{
    level hall
    reach {0}
}}
"""


def _errors(text: str) -> list[Diagnostic]:
    with pytest.raises(TltlError) as caught:
        compile_text(text)
    return [item for item in caught.value.diagnostics if item.severity == "error"]


@pytest.mark.parametrize(
    ("declaration", "use", "word"),
    [
        ("signal screen: (home, level, result)", "screen is level", "level"),
        ("signal screen: (home,\n    judge,\n    result)", "screen is judge", "judge"),
        ("signal level: int in [0, 9]", "level > 3", "level"),
        ("signal goal: bool\nsignal limit: bool", "limit", "limit"),
        ("signal release: bool", "release", "release"),
        ("entity chest\nsignal reach(e): bool", "reach(chest)", "reach"),
    ],
)
def test_a_reserved_word_that_is_declared_gets_one_error_and_a_fix_for_all_uses(
    declaration: str, use: str, word: str
) -> None:
    text = f"{declaration}\n{RULES.format(use)}"
    (error,) = _errors(text)
    assert (error.code, error.title) == ("TLT0106", f"`{word}` is a reserved word, not a name")
    assert error.help == f"choose another name, for example `{word}_`"
    mended = apply_edits(SourceFile("a.tltl", text), error.fixes[0].edits)
    assert [fspa.name for fspa in compile_source(mended).automata] == ["a", "b"]
    assert mended.text.count(f"{word}_") == text.count(word) - _clauses(text, word)


def _clauses(text: str, word: str) -> int:
    """Return how many clauses of the rules begin with a word."""
    return sum(part.split()[0] == word for part in RULES.format("won").replace("{", "\n").splitlines() if part.split())


def test_the_other_errors_of_the_file_are_found() -> None:
    text = f"signal screen: (home, level)\n{RULES.format('screen is level')}spec c {{ reach screen is leval }}\n"
    assert [error.code for error in _errors(text)] == ["TLT0106", "TLT0201"]


def test_the_operator_stays_where_it_stands_between_two_formulas() -> None:
    text = "signal release: bool\nsignal won: bool\nspec s { require (won release won) and release }\n"
    (error,) = _errors(text)
    mended = apply_edits(SourceFile("a.tltl", text), error.fixes[0].edits).text
    assert "require (won release won) and release_" in mended


def test_the_new_name_is_free() -> None:
    (error,) = _errors("signal level: bool\nsignal level_: bool\nspec s { reach level and level_ }\n")
    assert error.help == "choose another name, for example `level__`"
