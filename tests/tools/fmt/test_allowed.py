"""Formatting changes neither what allow comments apply to nor what the linter reports."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.calls import calls
from tests.fuzzing import times
from tests.tools.fmt.laws import check
from tests.tools.fmt.random_texts import join
from tltlc.core.source import SourceFile
from tltlc.grammar.allow_comments import statements
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.parser import parse
from tltlc.pipeline import CompileOptions
from tltlc.tools.fmt import STYLES, format_text
from tltlc.tools.fmt.layout_constraints import NO_CONSTRAINTS, required_constraints
from tltlc.tools.lint.run import findings, view_of

ALLOW = "// tltlc: allow"
CLAUSES = (
    *("reach a implies b", "reach b then (a implies c)", "keep c", "keep c or a", "avoid b", "require a"),
    *("keep always eventually c", "reach next next next a", "reach a until c", "limit 9 steps"),
)
CODES = ("TLT0410", "TLT0412", "TLT0413", "TLT0418", "TLT0419", "TLT0421", "TLT0424", "TLT0425", "TLT0429", "TLT0433")
GAPS = [*[" "] * 12, *["\n"] * 2, "\n\n", " // a remark\n", *(f" {ALLOW} {code}\n" for code in CODES)]
GAPS += [f"\n{ALLOW} {first}, {second} as it is\n" for first, second in pairwise(CODES)]


def _declarations(random: Random) -> Iterator[str]:
    yield "signal a: bool signal b: bool signal c: bool"
    for number in range(random.randint(1, 3)):
        if random.random() < 0.3:
            yield f"signal unheard_{number}: bool"
        else:
            clauses = random.sample(CLAUSES, random.randint(0, 3))
            yield f"spec s{number} {{ {' '.join(clauses)} keep b or c }}"


def _reported(text: str) -> list[tuple[str, int]]:
    """Return the codes that the linter reports, each with the number of its statement."""
    view = view_of(SourceFile("a.tltl", text), CompileOptions())
    spans = statements(view.module)
    reported = [(finding.diagnostic.code, finding.diagnostic.labels[0].span.start) for finding in findings(view)]
    return [(code, sum(span.start <= start for span in spans)) for code, start in reported]


@times(25)
@given(st.randoms(use_true_random=False), st.sampled_from([*STYLES]))
def test_lint_reports_the_same_after_formatting(random: Random, style: str) -> None:
    tokens = [token for text in _declarations(random) for token in tokenize(text).tokens if token.text]
    # A number must stay next to its unit.
    words = [f"{token.text} steps" if token.text == "9" else token.text for token in tokens if token.type != "UNIT"]
    text = join(random, words, GAPS)
    assert _reported(format_text(text, style)) == _reported(text)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (  # Clauses that share a line stay on one line.
            f"spec s {{\n limit 9 steps   reach a->b {ALLOW} TLT0412\n keep c keep d }}",
            f"spec s {{\n    limit 9 steps reach a implies b  {ALLOW} TLT0412\n    keep c\n    keep d\n}}\n",
        ),
        (f"signal a:bool signal b:bool {ALLOW} TLT0421", f"signal a: bool signal b: bool  {ALLOW} TLT0421\n"),
        (  # The comment applies to the whole spec already.
            f"spec s {{\n keep a\n reach a->b }} {ALLOW} TLT0412",
            f"spec s {{\n    keep a\n    reach a implies b\n}}  {ALLOW} TLT0412\n",
        ),
        (
            f"{ALLOW} TLT0419\nspec s {{ keep a\n reach a->b }}",
            f"{ALLOW} TLT0419\nspec s {{\n    keep a\n    reach a implies b\n}}\n",
        ),
    ],
)
def test_allow_comments_keep_their_targets(text: str, expected: str) -> None:
    assert check(f"signal x: bool\n{text}", "words") == f"signal x: bool\n{expected}"


def test_a_declaration_that_cannot_be_formatted_safely_is_copied() -> None:
    long = "a_name_of_forty_characters_it_has_indeed"
    text = f"spec s {{\n   keep {long} keep {long} and !{long}  {ALLOW} TLT0412\n  keep !e\n\n\n }}"
    rest = "signal e: bool\nspec t = not e\n"
    kept = text.replace("\n\n\n", "\n\n")
    assert check(f"{rest}{text}\nspec u=!e", "words") == f"{rest}{kept}\nspec u = not e\n"


def test_the_work_for_comments_above_one_line_is_linear() -> None:
    def work(number: int) -> int:
        comments = "// tltlc: allow TLT0418\n" * number
        lets = " ".join(f"let l{index} = F a" for index in range(number))
        text = f"signal a: bool\nspec s = F a\n{comments}{lets}\n"
        module, _ = parse(SourceFile("example.tltl", text))
        return calls(lambda: required_constraints(module, text, NO_CONSTRAINTS))

    assert work(400) < 2.5 * work(200)


@pytest.mark.parametrize(
    "entities",
    [
        "entity a,\n    b, // tltlc: allow TLT0421\n    c\n",
        "entity a,\n    // tltlc: allow TLT0421\n    b,\n    c\n",
    ],
)
def test_a_comment_in_a_list_of_entities_allows_no_more_than_before(entities: str) -> None:
    assert entities in format_text(f"{entities}signal x: bool\nspec s = F x\n", "words")
