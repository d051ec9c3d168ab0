"""Print the steps of a trace as a table that a person can read, while the trace is read."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import schedule
from tltlc.automaton.text import label_text
from tltlc.expression.tree import AtomValue
from tltlc.monitor.run import RunStep
from tltlc.program.flags import Flags
from tltlc.tools.judge.failing_step import short_number

_NUMBER: Final = 9
"""The width of a column of numbers with three digits: ``-1.23e-05`` is the longest."""


class StepTable:
    """A table with a line for each step, at most ``width`` characters wide.

    Numbers have three significant digits; atoms that are only true or false are ``yes`` and ``no``. Atoms
    that do not fit are left out, and counted in ``left_out``.
    """

    def __init__(self, fspa: Fspa, width: int) -> None:
        columns = [("step", 5), ("verdict", 9), ("progress", 8), ("reward", _NUMBER)]
        self._titles = [(title, max(least, len(title))) for title, least in columns]
        used = sum(wide + 2 for _, wide in self._titles)
        self._atoms: list[int] = []
        known = flags(fspa)
        for index, atom in enumerate(fspa.atoms):
            wide = max(len(atom.name), 3 if index in known else _NUMBER)
            if used + wide <= width:
                self._titles.append((atom.name, wide))
                self._atoms.append(index)
                used += wide + 2
        self.left_out = len(fspa.atoms) - len(self._atoms)
        self._flags = [index in known for index in self._atoms]
        self._to_do = label_text(fspa, 0)

    def head(self) -> Iterator[str]:
        """Yield the lines before the first step: what the spec asks for, and the titles of the columns."""
        yield f"to do: {self._to_do}"
        yield self._line([title for title, _ in self._titles])

    def rows(self, row: RunStep) -> Iterator[str]:
        """Yield the line of a step, and after it what remains to be done, if the step changed it."""
        step = row.step
        atoms = [
            ("yes" if row.values[index] > 0.0 else "no") if flag else short_number(row.values[index])
            for index, flag in zip(self._atoms, self._flags, strict=True)
        ]
        yield self._line(
            [str(row.number), step.verdict, short_number(step.progress), short_number(step.reward), *atoms]
        )
        if step.label_english != self._to_do:
            self._to_do = step.label_english
            if step.verdict in ("pending", "holding"):
                yield f"to do: {self._to_do}"

    def _line(self, cells: list[str]) -> str:
        aligned = [
            cell.ljust(wide) if title == "verdict" else cell.rjust(wide)
            for cell, (title, wide) in zip(cells, self._titles, strict=True)
        ]
        return "  ".join(aligned).rstrip()


def flags(fspa: Fspa) -> frozenset[int]:
    """Return the atoms that are only -1 or 1, so that they are true or false and nothing between."""
    sharp = Flags(fspa, schedule(fspa))
    return frozenset(index for index, atom in enumerate(fspa.atoms) if AtomValue(atom.name) in sharp)
