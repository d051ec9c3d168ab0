"""Choose the samples from which traces of automata with registers are put together."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import islice, product
from typing import TYPE_CHECKING, Final

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.automaton.memory import given_atoms
from tltlc.core.record import record, replace
from tltlc.resolve.registers import SATURATING
from tltlc.resolve.sources import names_read
from tltlc.resolve.spec import Register, Signal
from tltlc.tools.witness.samples import SampleFinder, UnsatisfiedLiterals

if TYPE_CHECKING:
    from tltlc.monitor.traces import TraceSample

MOST_FREE: Final = 5
"""Up to this many atoms, all combinations of their truth values are tried."""
_MOST_SAMPLES: Final = 64
_LEVELS: Final = 4
"""How many values of a signal are tried whose values at other samples registers keep."""


@record
class CandidateSamples:
    """Different samples.

    ``are_all`` is true if every other sample gives all atoms the same truth values as one of these.
    """

    samples: tuple[TraceSample, ...]
    are_all: bool


def candidate_samples(fspa: Fspa) -> CandidateSamples:
    """Return samples of an automaton with registers, for traces that take its edges."""
    place = {atom: index for index, atom in enumerate(given_atoms(fspa))}
    primes = (prime for edge in fspa.edges for prime in edge.guard.primes[:MOST_FREE])
    given = (tuple((place[atom], holds) for atom, holds in prime if atom in place) for prime in primes)
    return candidates(without_registers(fspa), fspa.signals, fspa.registers, given)


def candidates(
    view: Fspa, signals: Collection[Signal], registers: Collection[Register], further: Iterable[Implicant] = ()
) -> CandidateSamples:
    """Return samples with a value for each of ``signals``: at most ``_MOST_SAMPLES``.

    They give the atoms of ``view``, an automaton without registers, many combinations of truth values,
    among them those in ``further``. Values of signals that only ``view`` has are left out: they stand
    for ``registers``.
    """
    finder = LiteralSamples(view, signals, registers)
    names = [signal.name for signal in signals]
    samples: dict[tuple[float, ...], None] = {}
    count = len(view.atoms)
    are_all = count <= MOST_FREE and {signal.name for signal in view.signals} <= set(names)
    for literals in all_literals(count) if count <= MOST_FREE else (*_few_literals(count), *further):
        found = finder.samples(literals)
        for chosen in found:
            samples[tuple(chosen[name] for name in names)] = None
        if not found and not _breaks_exclusive(literals, view):
            are_all = False
    read = {name for register in registers for name in names_read(register.update)}
    levels = list(_levels(signals, read, list(samples)))
    samples |= dict.fromkeys(levels)
    first = tuple(dict(zip(names, values, strict=True)) for values in islice(samples, _MOST_SAMPLES))
    return CandidateSamples(first, are_all and not levels and len(first) == len(samples))


class LiteralSamples:
    """Finds samples at which literals of the atoms of ``view`` are true, with a value for each of ``signals``.

    ``view`` is an automaton without registers. Signals that only ``view`` has stand for ``registers``.
    """

    def __init__(self, view: Fspa, signals: Collection[Signal], registers: Iterable[Register]) -> None:
        self._finder = SampleFinder(view)
        self._unread = {signal.name: _least(signal) for signal in signals}
        self._registers = tuple(registers)

    def samples(self, literals: Implicant) -> list[TraceSample]:
        """Return a sample for literals, and samples that may come before it; empty if none is found.

        Those before have the values of signals that the registers of the sample remember.
        """
        sample = self._finder.sample_for_literals(literals)
        if isinstance(sample, UnsatisfiedLiterals):
            return []
        found = [self._own(sample)]
        for register in self._registers:
            if register.name in sample:
                for name in names_read(register.update):
                    if name in self._unread:
                        found.append({**found[0], name: sample[register.name]})
        return found

    def _own(self, sample: TraceSample) -> TraceSample:
        return {name: sample.get(name, value) for name, value in self._unread.items()}


def without_registers(fspa: Fspa) -> Fspa:
    """Return an automaton with only the atoms that do not follow from others, in which signals replace registers.

    Only its atoms, signals, params and exclusive groups are meaningful.
    """
    given = given_atoms(fspa)
    place = {atom: index for index, atom in enumerate(given)}
    return with_signals_for_registers(
        replace(
            fspa,
            atoms=tuple(fspa.atoms[atom] for atom in given),
            exclusive=tuple(tuple(place[atom] for atom in group if atom in place) for group in fspa.exclusive),
        )
    )


def with_signals_for_registers(fspa: Fspa) -> Fspa:
    """Return an automaton in which signals with any value in their range replace the registers.

    It has only signals that its atoms read. Without registers, it is the automaton itself.
    """
    if not fspa.registers:
        return fspa
    read = {name for atom in fspa.atoms for name in names_read(atom.expression)}
    signals = [*fspa.signals, *map(_as_signal, fspa.registers)]
    return replace(fspa, signals=tuple(signal for signal in signals if signal.name in read), registers=())


def all_literals(count: int) -> Iterator[Implicant]:
    """Yield all combinations of truth values of this many atoms."""
    for truth in product((False, True), repeat=count):
        yield tuple(enumerate(truth))


def _few_literals(count: int) -> Iterator[Implicant]:
    """Yield combinations in which all atoms have the same truth value, or all but one."""
    for holds in (False, True):
        yield tuple((atom, holds) for atom in range(count))
        for other in range(count):
            yield tuple((atom, holds != (atom == other)) for atom in range(count))


def _breaks_exclusive(literals: Implicant, view: Fspa) -> bool:
    holding = {atom for atom, holds in literals if holds}
    return any(len(holding.intersection(group)) > 1 for group in view.exclusive)


def _levels(
    signals: Iterable[Signal], read: Collection[str], samples: Sequence[tuple[float, ...]]
) -> Iterator[tuple[float, ...]]:
    """Yield samples that differ from the first one in a signal that a register reads, at several levels."""
    for place, signal in enumerate(signals):
        if not samples or signal.name not in read:
            continue
        low = _least(signal)
        high = signal.high if signal.high is not None else low + _LEVELS
        for level in range(_LEVELS + 1):
            value = low + (high - low) * level / _LEVELS
            yield (*samples[0][:place], value, *samples[0][place + 1 :])


def _as_signal(register: Register) -> Signal:
    # Where a count or a time stops depends on the whole spec, so two specs may differ in that.
    return Signal(register.name, "number", register.low, None if register.kind in SATURATING else register.high)


def _least(signal: Signal) -> float:
    """Return the least value of a signal that the search tries."""
    if signal.low is not None:
        return signal.low
    return 0.0 if signal.high is None else signal.high - _LEVELS
