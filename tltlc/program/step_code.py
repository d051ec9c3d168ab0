"""The code of a step of a monitor, in the order that it has in all languages."""

from __future__ import annotations

from abc import ABC, abstractmethod

from tltlc.program import snippets
from tltlc.program.build import Program


class StepCode(ABC):
    """Writes the step of a program's monitor; for each language, a subclass writes the parts of the step.

    Each part is a list of lines of code.
    """

    def __init__(self, program_: Program) -> None:
        self._program, self._fspa = program_, program_.fspa

    def _step(self) -> list[str]:
        """Return the code of a step, with an empty line between its parts."""
        parts = (self._read(), self._compute(), self._check(), self._move(), self._judge(), self._remember())
        return snippets.paragraphs(*parts)

    @abstractmethod
    def _read(self) -> list[str]:
        """Return the code that reads signals, clamped to their ranges, and params into local variables."""

    def _compute(self) -> list[str]:
        """Return the code that computes the atoms, clamped to [-1, 1], and the registers that every step needs.

        With registers, each value is checked before the next is computed; otherwise, all checks come last.
        """
        lines: list[str] = []
        checks: list[str] = []
        for step in self._program.every_step:
            lines += self._register(step.index) if step.kind == "register" else self._value(step.index)
            if step.kind == "atom" and not self._program.always_in_range[step.index]:
                (lines if self._program.registers else checks).extend(self._range_check(step.index))
        return [*lines, *checks]

    def _values(self, case: int) -> list[str]:
        """Return the code that computes the atoms that only this case needs."""
        return [line for index in self._program.computed_in(case) for line in self._value(index)]

    @abstractmethod
    def _value(self, index: int) -> list[str]:
        """Return the code that computes the value of an atom, given its index."""

    @abstractmethod
    def _range_check(self, index: int) -> list[str]:
        """Return the code that clamps the value of an atom to [-1, 1], given its index."""

    @abstractmethod
    def _register(self, index: int) -> list[str]:
        """Return the code that computes the value of a register after the sample, given its index."""

    @abstractmethod
    def _check(self) -> list[str]:
        """Return the code that ends a step with an error if two atoms of an ``exclusive`` group hold together."""

    @abstractmethod
    def _move(self) -> list[str]:
        """Return the code that finds the next state of the automaton, with a case for each state or shape."""

    @abstractmethod
    def _judge(self) -> list[str]:
        """Return the code that computes progress and reward, and whether the episode ends."""

    @abstractmethod
    def _remember(self) -> list[str]:
        """Return the code that keeps the values of the registers for the next sample."""
