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
from tltlc.logic.formula import atom
from tltlc.logic.text.printer import operand_text
from tltlc.monitor import Monitor, Step
from tltlc.monitor.guards import prime_robustness

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

Expectations = Mapping[int, Sequence[str]]
"""What to ``expect`` after a step: ``pending``, ``progress >= 0.5``, ``state "G a"``.

Steps are numbered from 1.
"""

_WIDTH = 100
_INDENT = "    "
_LONGEST_LABEL = 300


class Blocks:
    """Writes the ``test`` blocks of one spec.

    If a trace begins like the trace before it, only the rest is run. The words for each letter are
    computed once for each state. So many traces with long common beginnings need few steps of the
    monitor. ``runs`` counts these steps.
    """

    def __init__(self, spec: Fspa) -> None:
        self.runs = 0
        self._spec = spec
        self._fresh = Monitor(spec)
        self._ran: list[_Ran] = []
        self._worded: dict[tuple[int, Letter], tuple[int, tuple[str, ...]]] = {}

    def block(self, title: str, letters: Iterable[Letter], expects: Expectations) -> str:
        """Return the text of a ``test`` block, which ends with a newline.

        It has a step for each letter, and equal consecutive letters share one step. Letters contain
        names of atoms. Names that are not atoms of the spec are left out. For the test to pass, the
        letters must respect the spec's ``exclusive`` groups.

        Raises:
            ValueError: there is no letter or no expectation, or the spec has no atoms, so it can
                have no test.
        """
        steps = list(enumerate(letters, start=1))
        if not self._spec.atoms or not steps or not any(expects.get(number) for number, _ in steps):
            raise ValueError("a test names atoms, takes at least one step and expects something")
        lines = [f'test "{_one_line(title)}" for {self._spec.name} {{']
        # A step with an expectation after it ends its run of equal steps.
        ends = sorted(number for number in expects if expects[number])
        literals = self._literals([letter for _, letter in steps])
        for (_, letter_literals), run in groupby(
            steps, lambda step: (bisect_left(ends, step[0]), literals[step[0] - 1])
        ):
            numbers = [number for number, _ in run]
            lines += _step(letter_literals, len(numbers))
            lines += [f"{_INDENT}expect {expected}" for expected in expects.get(numbers[-1], ())]
        return "\n".join([*lines, "}", ""])

    def expectations(self, letters: Iterable[Letter], steps: Iterable[int] | None = None) -> Expectations:
        """Return what the monitor reports after some steps of a trace, by step number from 1.

        By default this is only the last step. The report is the verdict, the progress, rounded down
        to four decimals, and the state unless its label is very long.
        """
        results = self.results(letters)
        wanted = {len(results)} if steps is None else set(steps)
        return {number: _expected(results[number - 1]) for number in sorted(wanted) if 1 <= number <= len(results)}

    def results(self, letters: Iterable[Letter]) -> list[Step]:
        """Return what the monitor reports after each step of a trace."""
        letters = list(letters)
        shared = 0
        for ran, letter in zip(self._ran, letters, strict=False):
            if ran.letter != letter:
                break
            shared += 1
        del self._ran[shared:]
        monitor = copy(self._ran[-1].monitor if self._ran else self._fresh)
        for letter in letters[shared:]:
            self.runs += 1
            result = monitor.step_atoms(values(self._spec, letter))
            self._ran.append(_Ran(letter, result, copy(monitor)))
        return [ran.result for ran in self._ran]

    def _literals(self, letters: Sequence[Letter]) -> list[tuple[str, ...]]:
        """Return the atoms of each letter that hold.

        If none holds, return one atom that does not, because a step must name an atom.
        """
        all_literals: list[tuple[str, ...]] = []
        state = 0
        for letter in letters:
            worded = self._worded.get((state, letter))
            if worded is None:
                worded = self._worded[state, letter] = self._word(state, letter)
            state, letter_literals = worded
            all_literals.append(letter_literals)
        return all_literals

    def _word(self, state: int, letter: Letter) -> tuple[int, tuple[str, ...]]:
        """Return the state after a letter, and the literals of the letter.

        A letter without atoms gets the first atom that the edge requires not to hold.
        """
        spec, atom_values = self._spec, values(self._spec, letter)
        taken = (
            (edge, prime)
            for edge in self._leaving[state]
            for prime in edge.guard.primes
            if prime_robustness(prime, atom_values) > 0
        )
        # A letter that breaks `exclusive` may take no edge: the monitor rejects it, and so does the test.
        target, prime = next(((edge.target, prime) for edge, prime in taken), (state, ()))
        atom_names = tuple(atom.name for atom in spec.atoms if atom.name in letter)
        return target, atom_names or (f"not {bracketed(spec.atoms[prime[0][0] if prime else 0].name)}",)

    @cached_property
    def _leaving(self) -> list[list[Edge]]:
        leaving: list[list[Edge]] = [[] for _ in self._spec.states]
        for edge in self._spec.edges:
            leaving[edge.source].append(edge)
        return leaving


class _Ran(NamedTuple):
    """A step of the last trace that was run.

    It has the letter, the report of the monitor, and the monitor after the step.
    """

    letter: Letter
    result: Step
    monitor: Monitor


def test_block(title: str, spec: Fspa, letters: Iterable[Letter], expects: Expectations) -> str:
    """Return the text of one ``test`` block, as in :meth:`Blocks.block`."""
    return Blocks(spec).block(title, letters, expects)


def expectations(fspa: Fspa, letters: Iterable[Letter], steps: Iterable[int] | None = None) -> Expectations:
    """Return what to expect of one trace, as in :meth:`Blocks.expectations`."""
    return Blocks(fspa).expectations(letters, steps)


def _expected(step: Step) -> tuple[str, ...]:
    progress = floor(step.progress * 10_000 + 1e-6) / 10_000
    so_far = (f"progress >= {progress:.4g}",) if progress > 0 else ()
    return (step.verdict, *so_far, *_state(step.label))


def values(fspa: Fspa, letter: Letter) -> tuple[float, ...]:
    """Return a letter as the values of the atoms, in order, as tests give them.

    The value is 1 for atoms that hold and -1 for the others.
    """
    return tuple(1.0 if atom.name in letter else -1.0 for atom in fspa.atoms)


def _state(label: str) -> tuple[str, ...]:
    """Return the expectation of a state.

    It is empty if the label is too long to read, or contains characters that a text cannot have.
    """
    return () if len(label) > _LONGEST_LABEL or '"' in label or "\n" in label else (f'state "{label}"',)


def bracketed(name: str) -> str:
    """Return the name of an atom as an operand: a comparison gets brackets."""
    return operand_text(atom(name))


def _step(literals: Sequence[str], times: int) -> list[str]:
    """Return the lines of a ``step``, broken after commas."""
    lines = [f"{_INDENT}step {f'{times}x ' if times > 1 else ''}{literals[0]}"]
    for literal in literals[1:]:
        if len(lines[-1]) + len(literal) + 3 > _WIDTH:
            lines[-1] += ","
            lines.append(f"{_INDENT * 2}{literal}")
        else:
            lines[-1] += f", {literal}"
    return lines


def _one_line(title: str) -> str:
    return " ".join(title.replace('"', "'").split())
