"""Normal form, negation and normalisation are correct over infinite traces, and have the form that they promise."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.automaton.infinite.lassos import ABC, some_formulas, some_lassos
from tests.reference_formulas import read_formula
from tltlc.automaton.infinite.delta2 import contains, delta_2, delta_2_dually, is_pi_2, is_sigma_2
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.automaton.infinite.normal_form import infinite_form, is_rigid, negation, with_derived_operators
from tltlc.automaton.work import OutOfWork
from tltlc.logic.formula import FALSE, TRUE, Formula

SEEDS = pytest.mark.parametrize("seed", range(10))


@SEEDS
def test_the_normal_form_keeps_the_meaning_and_its_negation_inverts_it(seed: int) -> None:
    words = some_lassos(ABC, 12, seed)
    for formula in some_formulas(60, 10, seed):
        normal = infinite_form(formula)
        opposite = negation(normal)
        assert _is_normal(normal)
        assert _is_normal(opposite)
        for word in words:
            expected = holds_on_lasso(formula, *word)
            assert holds_on_lasso(normal, *word) == expected, formula
            assert holds_on_lasso(opposite, *word) != expected, formula
            assert holds_on_lasso(with_derived_operators(normal), *word) == expected, formula


def test_readable_formulas_have_no_constant_operands() -> None:
    for formula in some_formulas(300, 10, 0):
        for node in with_derived_operators(infinite_form(formula)).walk():
            assert not any(argument in (TRUE, FALSE) for argument in node.args)


@SEEDS
@pytest.mark.parametrize("normalise", [delta_2, delta_2_dually])
def test_normalisation_keeps_the_meaning_and_reaches_delta_2(
    normalise: Callable[[Formula], Formula], seed: int
) -> None:
    words = some_lassos(ABC, 12, seed)
    finished = 0
    for formula in some_formulas(40, 12, seed):
        try:
            normalised = normalise(infinite_form(formula))
        except OutOfWork:
            continue
        finished += 1
        assert _is_delta_2(normalised)
        for word in words:
            assert holds_on_lasso(normalised, *word) == holds_on_lasso(formula, *word), formula
    assert finished >= 38


@pytest.mark.parametrize(
    ("formula", "normal"),
    [
        ("G(a U b)", "G F b & G(a | b)"),
        ("F(a W b)", "F G a | F b"),
        ("G F(a U b)", "G F b"),
        ("F G(a W b)", "F G(a | b)"),
        ("G F(a | b)", "G F a | G F b"),
        ("F G(a & b)", "F G a & F G b"),
        ("X G F a", "G F a"),
        ("a U G F b", "G F b"),
        ("F(a & G F b)", "G F b & F a"),
        ("G(a -> G F b)", "G F b | G !a"),
        ("N a", "X a"),
        ("a R b", "b W (a & b)"),
        ("a M b", "b U (a & b)"),
        ("F F a", "F a"),
        ("a & !a", "false"),
        ("a | (a & b)", "a"),
    ],
)
def test_the_normal_form_is_simplified_by_known_rewrites(formula: str, normal: str) -> None:
    form = infinite_form(read_formula(formula))
    assert str(with_derived_operators(form)) in (
        normal,
        str(with_derived_operators(infinite_form(read_formula(normal)))),
    )
    assert form is infinite_form(with_derived_operators(form))


def test_a_normalisation_that_grows_too_large_stops() -> None:
    text = "a0"
    for i in range(1, 9):
        text = f"((({text}) U b{i}) W c{i})"
    with pytest.raises(OutOfWork):
        delta_2(infinite_form(read_formula(f"G({text})")))


def _is_normal(formula: Formula) -> bool:
    """Whether a formula has only literals, ``and or X U W``, and rigid ``G F p`` and ``F G p``.

    A rigid formula must not contain another one, and must not be an operand of ``X``, ``U`` or ``W``.
    """
    inner_halves = {node.args[0] for node in formula.walk() if is_rigid(node) and node.op in ("G", "F")}
    for node in formula.walk():
        if node.op in ("G", "F"):
            if node not in inner_halves and node.args[0].op != {"G": "F", "F": "G"}[node.op]:
                return False
            if node in inner_halves and any(below.op in ("G", "F") for below in node.args[0].walk()):
                return False
        elif node.op == "not":
            if node.args[0].op != "atom":
                return False
        elif node.op in ("X", "U", "W"):
            if any(is_rigid(operand) and operand not in (TRUE, FALSE) for operand in node.args):
                return False
        elif node.op not in ("true", "false", "atom", "and", "or"):
            return False
    return True


def _is_delta_2(formula: Formula) -> bool:
    stack, seen = [formula], {formula}
    for node in stack:
        if node.op in ("and", "or"):
            stack += [operand for operand in node.args if operand not in seen]
            seen.update(node.args)
        elif node.op in ("G", "F"):
            if contains(node.args[0].args[0], "W" if node.op == "G" else "U"):
                return False
        elif not (is_sigma_2(node) or is_pi_2(node)):
            return False
    return True
