"""Say for people which values an automaton sees at a step: numbers with three digits, and enums by name."""

from __future__ import annotations

from math import floor

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import schedule
from tltlc.core.names import ComparisonName
from tltlc.core.record import record
from tltlc.expression.tree import AtomValue
from tltlc.program.flags import Flags
from tltlc.resolve.spec import Register, Signal
from tltlc.tools.judge.measures import short_number


@record
class StepValue:
    """A value at a step: ``subject`` is what has it, such as ``mode``, and ``value`` the value in words, ``alert``.

    A condition that holds, such as "mode was alert at the step before", is a ``subject`` without a ``value``.
    ``reads`` are the values of what the subject is computed from.
    """

    subject: str
    value: str = ""
    reads: tuple[StepValue, ...] = ()

    @property
    def text(self) -> str:
        """The value in words: ``mode is alert``, or ``danger is 0.5 (mode is alert, noise is 3)``."""
        text = f"{self.subject} is {self.value}" if self.value else self.subject
        return f"{text} ({', '.join(read.text for read in self.reads)})" if self.reads else text


def signal_value(signal: Signal, value: float) -> str:
    """Return the value of a signal in words: the name of the value of an enum, or a number with three digits.

    Values before the first or after the last of an enum count as these. A value between two, such as 2.5, is none
    of them, and has no name.
    """
    nearest = floor(value + 0.5)
    if not signal.values or abs(value - nearest) >= 0.5:
        return short_number(value)
    return signal.values[min(max(nearest, 0), len(signal.values) - 1)]


def register_value(register: Register, value: float, clock_s: float | None) -> str:
    """Return the value of a register in words: a number with three digits, for a time with its unit.

    ``clock_s`` is the length of a step; None if it is not known.
    """
    if register.unit == "steps" and clock_s is not None:
        return f"{short_number(value * clock_s)} s"
    return f"{short_number(value)} {register.unit if register.unit in ('s', 'steps') else ''}".rstrip()


def enum_of(fspa: Fspa, atom: int) -> Signal | None:
    """Return the enum that an atom tests, such as ``mode`` for ``mode is alert``; None for other atoms."""
    base = fspa.atoms[atom].base
    if not isinstance(base, ComparisonName) or base.operator != "is":
        return None
    return next((signal for signal in fspa.signals if signal.name == base.left and signal.values), None)


def truths(fspa: Fspa) -> frozenset[int]:
    """Return the atoms that are true or false and nothing between: of bools, of enums, and of their memory."""
    enums = {atom.name for index, atom in enumerate(fspa.atoms) if enum_of(fspa, index) is not None}
    sharp = Flags(fspa, schedule(fspa), enums)
    return frozenset(index for index, atom in enumerate(fspa.atoms) if AtomValue(atom.name) in sharp)


def atom_value(atom: int, value: float, true_or_false: frozenset[int]) -> str:
    """Return the value of an atom in words: ``yes`` or ``no`` for those in ``true_or_false``, else a number."""
    if atom in true_or_false:
        return "yes" if value > 0.0 else "no"
    return short_number(value)
