"""TLT0425: clauses that occur twice."""

from __future__ import annotations

import pytest

import tltlc
from tests.calls import calls
from tests.tools.lint.helpers import SIGNALS, apply_fixes, labelled_texts_in_block
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.rules.duplicate_clause import RULE
from tltlc.tools.lint.run import view_of


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("avoid a", "keep not a"), ["keep not a"]),
        (("reach a", "require F a"), ["F a"]),
        (("require F a and G b", "reach c", "reach a"), ["reach a"]),
        (("reach a", "reach b", "reach a", "reach b", "reach a"), ["reach a", "reach b", "reach a"]),
        (("require F a and F a",), ["F a"]),
        # A clause that is equivalent but written differently counts as implied, not as a duplicate.
        (("reach a and b", "reach b and a"), []),
        (("reach a", "keep a"), []),
    ],
)
def test_duplicate_clauses_are_reported(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0425", *clauses) == expected


def test_the_first_of_two_duplicates_is_kept() -> None:
    before = SIGNALS + "spec s {\n    limit 9 steps\n"
    twice = before + "    reach a then b then c\n    avoid b // once\n    keep not b // twice\n}\n"
    assert apply_fixes(twice).source.text == before + "    reach a then b then c\n    avoid b // once\n}\n"


@pytest.mark.parametrize(
    "clauses",
    [
        ("require a", "require F[0,0] a"),
        ("require F[0,0] a", "require a"),
        ("require a", "require F[0,0] a", "require F[0,0] a"),
        ("reach b", "require a", "require F[0,0] a"),
    ],
)
def test_a_clause_that_decides_when_the_spec_is_judged_is_not_removed(clauses: tuple[str, ...]) -> None:
    lines = "\n    ".join(("limit 9 steps", *clauses))
    text = f"{SIGNALS}spec s {{\n    {lines}\n}}\n"
    before, after = (tltlc.compile_text(source)[0] for source in (text, apply_fixes(text).source.text))
    assert before.judge == after.judge == "goal"


def test_a_duplicate_of_the_earliest_clause_is_removed_beside_a_bounded_one() -> None:
    text = "signal a: bool\nspec s {\n    limit 9 steps\n    require a\n    require F[0,0] a\n    require a\n}\n"
    assert apply_fixes(text).source.text == text.replace("    require a\n}", "}")


def test_the_work_is_linear_in_the_clauses() -> None:
    def work(clauses: int) -> int:
        view = view_of(SourceFile("a.tltl", f"{SIGNALS}spec s {{\n{'    avoid a' * clauses}\n}}"), CompileOptions())
        return calls(lambda: list(RULE.check(view)))

    assert work(400) < 3 * work(200)
