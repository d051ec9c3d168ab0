"""The lengths of the steps of a trace, for automata whose clock varies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Final

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.samples import STEP_LENGTH, number_text

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter
    from tltlc.monitor.traces import TraceSample

_MOST_DEADLINES: Final = 3
_WITHOUT_DEADLINES_S: Final = 1.0


class StepLengthName(str):
    """A name in a letter that stands for no atom: it says how long after the letter before it comes, in seconds."""

    __slots__ = ("seconds",)
    seconds: float

    def __new__(cls, seconds: float) -> StepLengthName:
        """Make the name of a length."""
        name = super().__new__(cls, f"{STEP_LENGTH}: {number_text(seconds)} s")
        name.seconds = seconds
        return name


def letter_with_length(letter: Letter, seconds: float) -> Letter:
    """Return a letter that comes ``seconds`` after the one before."""
    return letter | {StepLengthName(seconds)}


def sample_with_length(sample: TraceSample, seconds: float) -> TraceSample:
    """Return a sample that comes ``seconds`` after the one before."""
    return {**sample, STEP_LENGTH: seconds}


def length_names(given: TraceSample | Letter) -> frozenset[str]:
    """Return the names in a letter that say how long a sample or another letter comes after the one before."""
    if isinstance(given, Mapping):
        return frozenset({StepLengthName(given[STEP_LENGTH])} if STEP_LENGTH in given else ())
    return frozenset(name for name in given if isinstance(name, StepLengthName))


def atoms_of(letter: Letter) -> Letter:
    """Return a letter without the names that say how long it comes after the one before."""
    return letter - length_names(letter)


def length_of(letter: Letter, fspa: Fspa) -> float | None:
    """Return how long after the letter before a letter comes, in seconds; None if the clock does not vary.

    A letter that does not say so comes at the time of the letter before.
    """
    if not fspa.clock_varies:
        return None
    return next((name.seconds for name in letter if isinstance(name, StepLengthName)), 0.0)


def shortest_deadline_s(fspa: Fspa) -> float:
    """Return the shortest time that a register of an automaton is compared with, in seconds; 1 s if there is none."""
    return min(_deadlines((fspa,)), default=_WITHOUT_DEADLINES_S)


def lengths_to_try(automata: Iterable[Fspa]) -> tuple[float, ...]:
    """Return lengths of steps with which traces can meet and miss the deadlines of automata; 1 s if there are none.

    They are the shortest deadlines, and a quarter of the shortest one.
    """
    deadlines = sorted(_deadlines(automata))[:_MOST_DEADLINES]
    return (deadlines[0] / 4, *deadlines) if deadlines else (_WITHOUT_DEADLINES_S,)


def _deadlines(automata: Iterable[Fspa]) -> set[float]:
    """Return the times of the registers: one that counts time stops at twice the longest that it is compared with."""
    maxima = (register.high for fspa in automata for register in fspa.registers if register.unit == "s")
    return {high / 2 for high in maxima if high}
