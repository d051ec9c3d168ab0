"""The ranges of registers hold at every sample, whatever an artefact declares."""

from __future__ import annotations

from random import Random

import pytest

from tests.backends.program.following import follow
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.expression.tree import Before, Condition, Const, Expression, Op, SignalValue, When
from tltlc.program.build import program
from tltlc.program.used_names import functions_called
from tltlc.resolve.spec import Register
from tltlc.tools.conformance import memory
from tltlc.tools.conformance.draw import Draw

X = SignalValue("x")


def remembering(low: float | None, high: float | None, initial: float, update: Expression) -> Fspa:
    """Return the automaton of an atom that reads a register ``r``, and nothing else, over a signal x in [-1, 1]."""
    (fspa,) = compile_text("signal x in [-1, 1]\nspec here { reach highest(x) > 0 }")
    register = Register("r", "highest", "", low, high, initial, update)
    atom = replace(fspa.atoms[0], expression=Op("/", (Const(0.5), Op("+", (SignalValue("r"), Const(2.0))))))
    return replace(fspa, registers=(register,), atoms=(atom,))


MORE = When(((Condition(">", (X, Const(0.0))), Op("+", (Before("r"), Const(1.0)))),), Before("r"))


@pytest.mark.parametrize(
    ("low", "high", "initial", "update", "finite", "in_range"),
    [
        # A count that stops at 7, from 0: the divisor of the atom is at least 2.
        (0.0, 7.0, 0.0, Op("min", (MORE, Const(7.0))), True, True),
        # The declared range is too narrow for the first value, or for later ones: nothing follows from it. The greatest
        # double plus 1 is that double, so the sum is finite.
        (0.0, 7.0, -2.0, Op("min", (MORE, Const(7.0))), True, False),
        (0.0, 7.0, 0.0, Op("min", (MORE, Const(8.0))), True, False),
        (0.0, 7.0, 0.0, MORE, True, False),
        (None, None, 0.0, MORE, True, False),
        (0.0, 7.0, 1.0, Op("+", (Before("r"), Before("r"))), False, False),
        (-1.0, 1.0, 1.0, X, True, True),
        (0.0, 1.0, 1.0, X, True, True),
        (None, None, 0.0, Op("sqrt", (X,)), False, False),
    ],
)
def test_a_range_counts_only_if_no_sample_leaves_it(
    low: float | None, high: float | None, initial: float, update: Expression, finite: bool, in_range: bool
) -> None:
    found = program(remembering(low, high, initial, update), ())
    assert (found.always_finite, found.always_in_range) == ((finite,), (in_range,))


def test_one_wrong_range_is_not_used_for_another_register() -> None:
    fspa = remembering(0.0, 1.0, 0.5, Op("*", (Before("r"), X)))
    copy_of_r = Register("s", "last", "", 0.0, 1.0, 0.5, Before("r"))
    found = program(replace(fspa, registers=(*fspa.registers, copy_of_r)), ())
    assert found.always_finite == (True, True), "a finite number times one in [-1, 1]"
    assert found.always_in_range == (False,)


@pytest.mark.parametrize(("limit", "kept"), [(2.0, True), (7.0, False), (9.0, False)])
def test_a_maximum_that_a_register_never_exceeds_is_dropped(limit: float, kept: bool) -> None:
    fspa = remembering(0.0, 7.0, 0.0, Op("min", (MORE, Const(7.0))))
    value = Op("/", (Op("min", (SignalValue("r"), Const(limit))), Const(10.0)))
    found = program(replace(fspa, atoms=(replace(fspa.atoms[0], expression=value),)), ())
    assert ("min" in functions_called(found.values[0])) == kept
    assert "min" in functions_called(found.updates[0])


def test_statements_compute_the_registers_of_the_monitor() -> None:
    count = 0
    for seed in range(60):
        _, fspa = memory._random_spec("told", Draw(seed))
        if fspa is None or not fspa.registers:
            continue
        count += 1
        follow(fspa, Random(seed), 25, has_bools=seed % 2 == 0)
    assert count > 30
