"""Choose samples from which traces of an automaton with registers are put together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, product
from typing import TYPE_CHECKING, Final

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.automaton.memory import given_atoms
from tltlc.core.record import replace
from tltlc.resolve.derived_atoms import names_read
from tltlc.resolve.spec import Register, Signal
from tltlc.tools.witness.samples import SampleFinder, UnsatisfiedLiterals

if TYPE_CHECKING:
    from tltlc.monitor.traces import TraceSample

_MOST_SAMPLES: Final = 64
_MOST_FREE: Final = 5
"""Up to this many atoms, all combinations of their truth values are tried."""
_LEVELS: Final = 4
"""How many values of a signal are tried whose values at other samples registers keep."""


def candidate_samples(fspa: Fspa) -> tuple[TraceSample, ...]:
    """Return different samples of an automaton with registers: at most ``_MOST_SAMPLES``.

    They give the atoms that do not follow from others many combinations of truth values. Values of
    registers that such an atom reads are chosen freely for this, and then left out.
    """
    view = without_registers(fspa)
    finder = SampleFinder(view)
    names = [signal.name for signal in fspa.signals]
    unread = {signal.name: _least(signal) for signal in fspa.signals}
    samples: dict[tuple[float, ...], None] = {}
    for literals in _literals(fspa, view):
        sample = finder.sample_for_literals(literals)
        if not isinstance(sample, UnsatisfiedLiterals):
            samples[tuple({**unread, **sample}[name] for name in names)] = None
    for values in _levels(fspa, list(samples)):
        samples[values] = None
    return tuple(dict(zip(names, values, strict=True)) for values in islice(samples, _MOST_SAMPLES))


def without_registers(fspa: Fspa) -> Fspa:
    """Return an automaton with only the atoms that do not follow from others, in which signals replace registers.

    It has only signals that these atoms read. Only its atoms, signals, params and exclusive groups are meaningful.
    """
    given = given_atoms(fspa)
    place = {atom: index for index, atom in enumerate(given)}
    signals = [*fspa.signals, *map(_as_signal, fspa.registers)]
    read = {name for atom in given for name in names_read(fspa.atoms[atom].expression)}
    return replace(
        fspa,
        atoms=tuple(fspa.atoms[atom] for atom in given),
        signals=tuple(signal for signal in signals if signal.name in read),
        exclusive=tuple(tuple(place[atom] for atom in group if atom in place) for group in fspa.exclusive),
        registers=(),
    )


def _literals(fspa: Fspa, view: Fspa) -> Iterator[Implicant]:
    """Yield sets of literals over the atoms of ``view``: all, or those of guards and those that differ in one atom."""
    count = len(view.atoms)
    if count <= _MOST_FREE:
        for truth in product((False, True), repeat=count):
            yield tuple(enumerate(truth))
        return
    place = {atom: index for index, atom in enumerate(given_atoms(fspa))}
    none = tuple((atom, False) for atom in range(count))
    yield none
    for edge in fspa.edges:
        for prime in edge.guard.primes[:_MOST_FREE]:
            yield tuple((place[atom], holds) for atom, holds in prime if atom in place)
    for chosen in range(count):
        yield tuple((atom, atom == chosen) for atom, _ in none)
        yield tuple((atom, atom != chosen) for atom, _ in none)
    yield tuple((atom, True) for atom in range(count))


def _levels(fspa: Fspa, samples: Sequence[tuple[float, ...]]) -> Iterator[tuple[float, ...]]:
    """Yield samples that differ from the first one in a signal that a register reads, at several levels."""
    read = {name for register in fspa.registers for name in names_read(register.update)}
    for place, signal in enumerate(fspa.signals):
        if not samples or signal.name not in read:
            continue
        low = _least(signal)
        high = signal.high if signal.high is not None else low + _LEVELS
        for level in range(_LEVELS + 1):
            value = low + (high - low) * level / _LEVELS
            yield (*samples[0][:place], value, *samples[0][place + 1 :])


def _as_signal(register: Register) -> Signal:
    return Signal(register.name, "number", register.low, register.high)


def _least(signal: Signal) -> float:
    """Return the least value of a signal that the search tries."""
    if signal.low is not None:
        return signal.low
    return 0.0 if signal.high is None else signal.high - _LEVELS
