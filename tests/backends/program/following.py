"""Run the program of an automaton with registers beside the monitor, and compare all that they compute.

The interpreter has no language of its own, and the monitor does not know the program.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from random import Random

from tests.backends.program.interpreter import Scope, Value, failure_names, step
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.program.build import Program, program
from tltlc.resolve.spec import Signal

Drawn = Callable[[Signal, Random], float]


def follow(fspa: Fspa, rng: Random, samples: int, *, has_bools: bool = False, draw: Drawn | None = None) -> Program:
    """Compare the program and the monitor on random samples, and return the program."""
    found, monitor = program(fspa, (), has_bools=has_bools), Monitor(fspa)
    kept, state, best, done = tuple(register.initial for register in fspa.registers), 0, 0.0, False
    for number in range(1, samples + 1):
        sample = {signal.name: (draw or any_value)(signal, rng) for signal in fspa.signals}
        scope = Scope(_read(found, found.signals, sample.values()) | _read(found, found.before, kept))
        lazy = [index for case in range(len(found.cases)) for index in found.computed_in(case)]
        scope.changing |= {*found.atoms, *found.registers}
        for computation in found.every_step:
            index = computation.index
            scope.run(found.values[index] if computation.kind == "atom" else found.updates[index])
            if computation.kind == "atom" and not found.always_in_range[index]:
                name = found.atoms[index]
                scope.values[name] = min(max(scope.values[name], -1.0), 1.0)
        for index in lazy:
            scope.run(found.values[index])
        kept = tuple(float(scope.value(value)) for value in found.kept)
        wanted = monitor.step(sample)
        assert kept == monitor.registers
        assert all(map(math.isfinite, kept))
        for name, value in zip(found.atoms, monitor.values, strict=True):
            assert _as_number(scope.values.get(name, value)) == value
        atoms = {name: scope.values[name] for name in found.atoms if name in scope.values}
        after = step(found, state, number, best, done, atoms)
        state, best, done = int(after["target"]), float(after["best"]), bool(after["done"])
        limiting = None if after["limiting"] == -1 else fspa.atoms[int(after["limiting"])].name
        assert (state, limiting) == (wanted.state, wanted.limiting)
        assert (best, after["reward"], done) == (wanted.progress, wanted.reward, wanted.done)
        assert after["robustness"] == wanted.robustness
        if wanted.failed_step in (None, number):
            assert failure_names(found, after) == (wanted.failed_clause, wanted.failed_atom)
    return found


def _read(found: Program, variables: Iterable[str], numbers: Iterable[float]) -> dict[str, Value]:
    values = zip(variables, numbers, strict=True)
    return {name: value == 1.0 if name in found.booleans else value for name, value in values}


def _as_number(value: Value) -> float:
    """Return the value of an atom, given that of its variable: a flag is a Boolean."""
    return (1.0 if value else -1.0) if isinstance(value, bool) else value


def any_value(signal: Signal, rng: Random) -> float:
    """Return a random value of a signal."""
    if signal.type == "bool":
        return float(rng.random() < 0.5)
    low, high = (-30.0, 30.0) if signal.low is None or signal.high is None else (signal.low, signal.high)
    if signal.type == "int":
        return float(rng.randint(int(low), int(high)))
    return rng.choice((low, high, 0.0, 0.25, low + (high - low) * rng.random()))
