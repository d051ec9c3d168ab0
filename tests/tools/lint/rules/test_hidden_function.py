"""TLT0436: declarations with the name of a function about the trace so far."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import codes, labelled_texts
from tltlc.resolve.scope import MEMORY_FUNCTIONS

USE = "signal a: bool\nspec s = F a\n"


@pytest.mark.parametrize("name", MEMORY_FUNCTIONS)
@pytest.mark.parametrize(
    "declaration",
    ["signal {}: bool", "signal {}(x: entity): bool", "param {} = 3", "predicate {} = 1", "let {}(p: formula) = F p"],
)
def test_each_declaration_that_hides_a_function_is_reported(name: str, declaration: str) -> None:
    assert labelled_texts(f"{declaration.format(name)}\n{USE}", "TLT0436") == [name]


def test_other_names_and_the_function_itself_are_not_reported() -> None:
    assert "TLT0436" not in codes("signal times_: bool\nsignal a: bool\nspec s { limit 9 steps keep times(a) <= 3 }")


def test_parameters_are_no_declarations_of_the_file() -> None:
    assert "TLT0436" not in codes("let twice(times: formula) = times & X times\nsignal a: bool\nspec s = F twice(a)")
