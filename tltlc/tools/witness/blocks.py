"""Write traces as ``test`` blocks that can be pasted into the file of their spec."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from functools import cached_property
from itertools import groupby
from math import floor
from typing import TYPE_CHECKING, NamedTuple

from tltlc.automaton.fspa import Edge, Fspa
from tltlc.automaton.memory import given_atoms
from tltlc.logic.formula import atom
from tltlc.logic.text.printer import operand_text
from tltlc.monitor import Monitor, Step
from tltlc.monitor.guards import prime_robustness
from tltlc.monitor.samples import number_text
from tltlc.tools.witness.step_lengths import length_of

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

Expectations = Mapping[int, Sequence[str]]
"""What a test expects after each step: texts for ``expect``, by step number from 1.

A text is for example ``pending``, ``progress >= 0.5`` or ``state "G a"``.
"""

_WIDTH = 100
_INDENT = "    "
_LONGEST_LABEL = 300


class BlockWriter:
    """Writes ``test`` blocks of one spec.

    If a trace begins like the previous trace, the monitor runs only on the part that differs. So
    traces with long common beginnings are cheap. ``monitor_steps`` counts the steps of the monitor.
    """

    def __init__(self, spec: Fspa) -> None:
        self.monitor_steps = 0
        self._spec = spec
        self._given = given_atoms(spec)
        self._fresh = Monitor(spec)
        self._last_trace: list[_MonitoredStep] = []
        self._literals_cache: dict[tuple[int, Letter], tuple[int, tuple[str, ...]]] = {}

    def block(self, title: str, letters: Iterable[Letter], expects: Expectations) -> str:
        """Return the text of a ``test`` block, with a newline at the end.

        The block has a step for each letter, that is, for each set of atoms that hold; equal
        consecutive letters share a step. Names in letters that are not atoms of the spec are left
        out. ``expects`` says what to expect after which step. The test passes only if no two atoms of
        an ``exclusive`` group hold together.

        Raises:
            ValueError: there is no letter or no expectation, or the spec has no atoms that a step can name.
        """
        steps = list(enumerate(letters, start=1))
        if not self._given or not steps or not any(expects.get(number) for number, _ in steps):
            raise ValueError("a test names atoms, takes at least one step and expects something")
        lines = [f'test "{_one_line(title)}" for {self._spec.name} {{']
        # A step with an expectation after it ends its run of equal steps.
        ends = sorted(number for number in expects if expects[number])
        literals = self._literals([letter for _, letter in steps])
        lengths = [length_of(letter, self._spec) for _, letter in steps]
        for (_, letter_literals, length), run in groupby(
            steps, lambda step: (bisect_left(ends, step[0]), literals[step[0] - 1], lengths[step[0] - 1])
        ):
            numbers = [number for number, _ in run]
            lines += _step(letter_literals, len(numbers), length)
            lines += [f"{_INDENT}expect {expected}" for expected in expects.get(numbers[-1], ())]
        return "\n".join([*lines, "}", ""])

    def expectations(self, letters: Iterable[Letter], steps: Iterable[int] | None = None) -> Expectations:
        """Run the monitor on a trace; return what it reports after ``steps``, by step number from 1.

        ``steps`` are the numbers of the steps to report on; for None, only the last step. A report is
        for example ``("pending", "progress >= 0.5", 'state "F a"')``. It has the progress, rounded
        down to four decimals, only if this is above 0, and the label of the state unless it is very
        long or hard to quote.
        """
        results = self.results(letters)
        numbers = {len(results)} if steps is None else set(steps)
        return {number: _report(results[number - 1]) for number in sorted(numbers) if 1 <= number <= len(results)}

    def results(self, letters: Iterable[Letter]) -> list[Step]:
        """Return what the monitor reports after each step of a trace."""
        letters = list(letters)
        common = 0
        for step, letter in zip(self._last_trace, letters, strict=False):
            if step.letter != letter:
                break
            common += 1
        del self._last_trace[common:]
        monitor = copy(self._last_trace[-1].monitor if self._last_trace else self._fresh)
        for letter in letters[common:]:
            self.monitor_steps += 1
            result = monitor.step_atoms(given_values(self._spec, letter), length_of(letter, self._spec))
            self._last_trace.append(_MonitoredStep(letter, result, copy(monitor)))
        return [step.result for step in self._last_trace]

    def _literals(self, letters: Sequence[Letter]) -> list[tuple[str, ...]]:
        """Return, for each letter, the texts that its step has: the names of the atoms that hold.

        If no atom holds, the only text is a negated atom, such as ``not seen``, because a step must
        name an atom.
        """
        all_literals: list[tuple[str, ...]] = []
        state = 0
        for letter in letters:
            entry = self._literals_cache.get((state, letter))
            if entry is None:
                entry = self._literals_cache[state, letter] = self._successor_and_literals(state, letter)
            state, letter_literals = entry
            all_literals.append(letter_literals)
        return all_literals

    def _successor_and_literals(self, state: int, letter: Letter) -> tuple[int, tuple[str, ...]]:
        """Return the state after a letter, and the texts that the step for this letter has.

        If no atom holds, the only text is a negated atom: the first one that the guard of the edge
        names.
        """
        spec, atom_values = self._spec, letter_values(self._spec, letter)
        taken = (
            (edge, prime)
            for edge in self._leaving[state]
            for prime in edge.guard.primes
            if prime_robustness(prime, atom_values) > 0
        )
        # A letter that breaks `exclusive` may take no edge: the monitor rejects it, and so does the test.
        target, prime = next(((edge.target, prime) for edge, prime in taken), (state, ()))
        atom_names = tuple(spec.atoms[atom].name for atom in self._given if spec.atoms[atom].name in letter)
        named = next((atom for atom, _ in prime if atom in self._given), self._given[0])
        return target, atom_names or (f"not {atom_operand(spec.atoms[named].name)}",)

    @cached_property
    def _leaving(self) -> list[list[Edge]]:
        leaving: list[list[Edge]] = [[] for _ in self._spec.states]
        for edge in self._spec.edges:
            leaving[edge.source].append(edge)
        return leaving


class _MonitoredStep(NamedTuple):
    """A step of the last trace: its letter, what the monitor reported, and a copy of the monitor after the step."""

    letter: Letter
    result: Step
    monitor: Monitor


def test_block(title: str, spec: Fspa, letters: Iterable[Letter], expects: Expectations) -> str:
    """Return the text of a single ``test`` block, as :meth:`BlockWriter.block` does."""
    return BlockWriter(spec).block(title, letters, expects)


def expectations(fspa: Fspa, letters: Iterable[Letter], steps: Iterable[int] | None = None) -> Expectations:
    """Return what the monitor reports on a single trace, as :meth:`BlockWriter.expectations` does."""
    return BlockWriter(fspa).expectations(letters, steps)


def _report(step: Step) -> tuple[str, ...]:
    progress = floor(step.progress * 10_000 + 1e-6) / 10_000
    progress_expectation = (f"progress >= {progress:.4g}",) if progress > 0 else ()
    return (step.verdict, *progress_expectation, *_state_expectation(step.label))


def letter_values(fspa: Fspa, letter: Letter) -> tuple[float, ...]:
    """Return a value for each atom of an automaton, in order: 1 if the atom holds in the letter, else -1."""
    return tuple(1.0 if atom.name in letter else -1.0 for atom in fspa.atoms)


def given_values(fspa: Fspa, letter: Letter) -> tuple[float, ...]:
    """Return the values of the atoms that do not follow from others, as for :meth:`Monitor.step_atoms`.

    The atoms of ``test`` blocks have the same values.
    """
    values = letter_values(fspa, letter)
    return tuple(values[atom] for atom in given_atoms(fspa))


def _state_expectation(label: str) -> tuple[str, ...]:
    """Return the expectation that the state has this label, as a tuple of one text: ``('state "F a"',)``.

    The tuple is empty if the label is too long to read, or contains a quote or a line break.
    """
    return () if len(label) > _LONGEST_LABEL or '"' in label or "\n" in label else (f'state "{label}"',)


def atom_operand(name: str) -> str:
    """Return the name of an atom as an operand of ``not``: ``near(exit)``, but ``(x > 5)`` with brackets."""
    return operand_text(atom(name))


def _step(literals: Sequence[str], times: int, length: float | None) -> list[str]:
    """Return the lines of a step such as ``step 3x for 2 s alive, seen``; long lines are broken after commas."""
    repeated = f"{times}x " if times > 1 else ""
    takes = f"for {number_text(length)} s " if length else ""
    lines = [f"{_INDENT}step {repeated}{takes}{literals[0]}"]
    for literal in literals[1:]:
        if len(lines[-1]) + len(literal) + 3 > _WIDTH:
            lines[-1] += ","
            lines.append(f"{_INDENT * 2}{literal}")
        else:
            lines[-1] += f", {literal}"
    return lines


def _one_line(title: str) -> str:
    return " ".join(title.replace('"', "'").split())
