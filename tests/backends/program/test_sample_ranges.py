"""The ranges of registers hold at every sample, whatever an artefact declares."""

from __future__ import annotations

import math
from random import Random

import pytest

from tests.backends.program.interpreter import Scope
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.expression.tree import Before, Condition, Const, Expression, Op, SignalValue, When
from tltlc.monitor import Monitor
from tltlc.program.build import program
from tltlc.program.used_names import functions_called
from tltlc.resolve.spec import Register, Signal
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
    """The interpreter has no language of its own, and the monitor does not know the program."""
    count = 0
    for seed in range(60):
        _, fspa = memory._random_spec("told", Draw(seed))
        if fspa is None or not fspa.registers:
            continue
        count += 1
        _follow(fspa, Random(seed))
    assert count > 30


def _follow(fspa: Fspa, rng: Random) -> None:
    found, monitor = program(fspa, ()), Monitor(fspa)
    kept = tuple(register.initial for register in fspa.registers)
    for _ in range(25):
        sample = {signal.name: _value(signal, rng) for signal in fspa.signals}
        scope = Scope(
            dict(zip(found.signals, sample.values(), strict=True)) | dict(zip(found.before, kept, strict=True))
        )
        lazy = [index for state in fspa.states for index in found.computed_in(state.id)]
        scope.changing |= {*found.atoms, *found.registers}
        for step in found.every_step:
            scope.run(found.values[step.index] if step.kind == "atom" else found.updates[step.index])
            if step.kind == "atom" and not found.always_in_range[step.index]:
                name = found.atoms[step.index]
                scope.values[name] = min(max(scope.values[name], -1.0), 1.0)
        for index in lazy:
            scope.run(found.values[index])
        kept = tuple(float(scope.values[name]) for name in found.registers)
        monitor.step(sample)
        assert kept == monitor.registers
        assert all(map(math.isfinite, kept))
        for name, value in zip(found.atoms, monitor.values, strict=True):
            assert scope.values.get(name, value) == value


def _value(signal: Signal, rng: Random) -> float:
    if signal.type == "bool":
        return float(rng.random() < 0.5)
    low, high = (-30.0, 30.0) if signal.low is None or signal.high is None else (signal.low, signal.high)
    return rng.choice((low, high, 0.0, 0.25, low + (high - low) * rng.random()))
