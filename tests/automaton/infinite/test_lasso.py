"""The reference semantics on lassos: cases by hand, and a slower definition that unrolls the cycle."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.automaton.infinite.lassos import Lasso, Sample, lasso, lassos
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.logic.formula import TRUE, Formula

CASES = """
true            | -        yes
false           | a        no
a               a | -      yes
a               - | a      no
!a              - | a      yes
a & b           | a        no
a & b           | ab       yes
a | b           | b        yes
a -> b          | a        no
a -> b          | -        yes
a <-> b         | ab       yes
a <-> b         | b        no
X a             - | a      yes
X a             a | -      no
X a             | a -      no
N a             - | a      yes
N a             | a        yes
N a             a | -      no
F a             - - | a    yes
F a             | - - a    yes
F a             | b        no
G a             a | a      yes
G a             a | a -    no
G a             - | a      no
G F a           a | -      no
G F a           - | - a    yes
F G a           - | - a    no
F G a           - | a      yes
a U b           a a | b    yes
a U b           a - | b    no
a U b           | a        no
a U b           b | -      yes
a W b           | a        yes
a W b           a | b      yes
a W b           a - | b    no
a R b           | b        yes
a R b           b ab | -   yes
a R b           b a | b    no
a M b           | b        no
a M b           b ab | -   yes
a M b           b a | ab   no
"""


@pytest.mark.parametrize("case", CASES.strip().splitlines())
def test_each_operator_has_the_value_computed_by_hand(case: str) -> None:
    formula, word, answer = case[:16], case[16:-3], case[-3:].strip()
    prefix, cycle = lasso(word)
    assert holds_on_lasso(read_formula(formula), prefix, cycle) == (answer == "yes")


def test_an_empty_cycle_is_an_error() -> None:
    with pytest.raises(ValueError, match="empty"):
        holds_on_lasso(TRUE, [frozenset("a")], [])


@given(formulas(max_leaves=6), lassos())
@times(133)
def test_agrees_with_the_definitions_on_the_unrolled_trace(formula: Formula, word: Lasso) -> None:
    assert holds_on_lasso(formula, *word) == _holds(formula, word, 0, {})


def _holds(formula: Formula, word: Lasso, place: int, memo: dict[tuple[Formula, int], bool]) -> bool:
    """Whether a formula holds at ``place``, by the definitions.

    "Some later place" is one of the next ``len(prefix) + len(cycle)`` places.
    """
    prefix, cycle = word
    if place >= len(prefix):
        place = len(prefix) + (place - len(prefix)) % len(cycle)
    key = (formula, place)
    if key in memo:
        return memo[key]

    def at(operand: int, where: int) -> bool:
        return _holds(formula.args[operand], word, where, memo)

    later = range(place, place + len(prefix) + len(cycle))
    match formula.op:
        case "true" | "false":
            result = formula is TRUE
        case "atom":
            result = formula.name in _sample(word, place)
        case "not":
            result = not at(0, place)
        case "and":
            result = all(at(i, place) for i in range(len(formula.args)))
        case "or":
            result = any(at(i, place) for i in range(len(formula.args)))
        case "implies":
            result = at(1, place) or not at(0, place)
        case "iff":
            result = at(0, place) is at(1, place)
        case "X" | "N":
            result = at(0, place + 1)
        case "F":
            result = any(at(0, j) for j in later)
        case "G":
            result = all(at(0, j) for j in later)
        case "U":
            result = any(at(1, j) and all(at(0, i) for i in range(place, j)) for j in later)
        case "W":
            result = all(at(0, j) or any(at(1, i) for i in range(place, j + 1)) for j in later)
        case "R":
            result = all(at(1, j) or any(at(0, i) for i in range(place, j)) for j in later)
        case _:
            assert formula.op == "M"
            result = any(at(0, j) and all(at(1, i) for i in range(place, j + 1)) for j in later)
    memo[key] = result
    return result


def _sample(word: Lasso, place: int) -> Sample:
    prefix, cycle = word
    return prefix[place] if place < len(prefix) else cycle[place - len(prefix)]
