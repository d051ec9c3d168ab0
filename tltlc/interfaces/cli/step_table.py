"""Print the steps of a trace as a table that a person can read, while the trace is read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.monitor.failure_words import atom_titles, shortened
from tltlc.monitor.run import RunStep
from tltlc.tools.judge.measures import short_number
from tltlc.tools.judge.step_values import atom_value, truths

_NUMBER: Final = 9
"""The width of a column of numbers with three digits: ``-1.23e-05`` is the longest."""


class StepTable:
    """A table with a line for each step, at most ``width`` characters wide.

    Numbers have three significant digits; atoms that are only true or false are ``yes`` and ``no``. Atoms
    that do not fit are left out, and counted in ``left_out``. If one of them decides that the trace fails, the
    table goes on with other columns from this step on: those of the deciding atoms come first.
    """

    def __init__(self, fspa: Fspa, width: int) -> None:
        self._fspa, self._width, self._truths = fspa, width, truths(fspa)
        self._names = atom_titles(fspa)
        self._to_do = label_text(fspa, 0)
        self._choose(())

    def _choose(self, first: Sequence[int]) -> None:
        """Choose the columns: those of the atoms ``first``, at least one of them, and further ones that fit."""
        columns = [("step", 5), ("verdict", 9), ("progress", 8), ("reward", _NUMBER)]
        self._titles = [(title, max(least, len(title))) for title, least in columns]
        used = sum(wide + 2 for _, wide in self._titles)
        self._atoms: list[int] = []
        for index in dict.fromkeys((*first, *range(len(self._fspa.atoms)))):
            title = self._names[index]
            wide = max(len(title), 3 if index in self._truths else _NUMBER)
            if used + wide <= self._width or (first and not self._atoms):
                self._titles.append((title, wide))
                self._atoms.append(index)
                used += wide + 2
        self.left_out = len(self._fspa.atoms) - len(self._atoms)

    def head(self) -> Iterator[str]:
        """Yield the lines before the first step: what the spec asks for, and the titles of the columns."""
        yield f"to do: {shortened(self._to_do)}"
        yield self._line([title for title, _ in self._titles])

    def rows(self, row: RunStep, deciding: Sequence[int] = ()) -> Iterator[str]:
        """Yield the line of a step, and after it what remains to be done, if the step changed it.

        ``deciding`` are the indices of the atoms that decide that the trace fails, the one to name first; the
        titles come again if the table did not have all of them.
        """
        step = row.step
        if step.failed_step == row.number and not set(deciding) <= set(self._atoms):
            self._choose(deciding)
            yield self._line([title for title, _ in self._titles])
        atoms = [atom_value(index, row.values[index], self._truths) for index in self._atoms]
        yield self._line(
            [str(row.number), step.verdict, short_number(step.progress), short_number(step.reward), *atoms]
        )
        if step.label_english != self._to_do:
            self._to_do = step.label_english
            if step.verdict in ("pending", "holding"):
                yield f"to do: {shortened(self._to_do)}"

    def _line(self, cells: list[str]) -> str:
        aligned = [
            cell.ljust(wide) if title == "verdict" else cell.rjust(wide)
            for cell, (title, wide) in zip(cells, self._titles, strict=True)
        ]
        return "  ".join(aligned).rstrip()
