"""Traces as ``test`` blocks that can be pasted into the file of their spec."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from functools import cached_property
from itertools import groupby
from math import floor
from typing import TYPE_CHECKING, NamedTuple

from tltlc.automaton.fspa import Edge, Fspa
from tltlc.monitor import Monitor, Step
from tltlc.monitor.guards import prime_robustness

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

Expectations = Mapping[int, Sequence[str]]
"""What to ``expect`` (``pending``, ``progress >= 0.5``, ``state "G a"``) behind a step, by its number from 1."""

_WIDTH = 100
_INDENT = "    "
_LONGEST_LABEL = 300


class Blocks:
    """Writes the ``test`` blocks of one spec.

    A trace that begins as the one before it is run from where they part, and each letter is worded once for each state,
    so that many traces with long beginnings in common take few steps of the monitor. ``runs`` counts those.
    """

    def __init__(self, spec: Fspa) -> None:
        self.runs = 0
        self._spec = spec
        self._fresh = Monitor(spec)
        self._ran: list[_Ran] = []
        self._worded: dict[tuple[int, Letter], tuple[int, tuple[str, ...]]] = {}

    def block(self, title: str, letters: Iterable[Letter], expects: Expectations) -> str:
        """The text of a ``test`` block, ended by a newline: a step for each letter, equal ones in a row as one.

        Letters hold names of atoms; those that are none of the spec's are left out.  Where a test is to pass, the
        letters must not break the spec's ``exclusive``.

        Raises:
            ValueError: no letter, no expectation, or a spec without atoms, of which there can be no test.
        """
        steps = list(enumerate(letters, start=1))
        if not self._spec.atoms or not steps or not any(expects.get(number) for number, _ in steps):
            raise ValueError("a test names atoms, takes at least one step and expects something")
        lines = [f'test "{_one_line(title)}" for {self._spec.name} {{']
        # A step behind which something is expected ends its run of equal ones.
        ends = sorted(number for number in expects if expects[number])
        literals = self._literals([letter for _, letter in steps])
        for (_, named), run in groupby(steps, lambda step: (bisect_left(ends, step[0]), literals[step[0] - 1])):
            numbers = [number for number, _ in run]
            lines += _step(named, len(numbers))
            lines += [f"{_INDENT}expect {expected}" for expected in expects.get(numbers[-1], ())]
        return "\n".join([*lines, "}", ""])

    def expectations(self, letters: Iterable[Letter], steps: Iterable[int] | None = None) -> Expectations:
        """What the monitor says of a trace behind some steps, by their numbers from 1; by default the last one.

        The verdict, the progress, rounded down to four decimals, and the state unless its label is very long.
        """
        results = self.results(letters)
        wanted = {len(results)} if steps is None else set(steps)
        return {number: _expected(results[number - 1]) for number in sorted(wanted) if 1 <= number <= len(results)}

    def results(self, letters: Iterable[Letter]) -> list[Step]:
        """What the monitor says behind each step of a trace."""
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
        """The atoms of each letter that hold; where none does, one that does not, since a step names one."""
        found: list[tuple[str, ...]] = []
        state = 0
        for letter in letters:
            worded = self._worded.get((state, letter))
            if worded is None:
                worded = self._worded[state, letter] = self._word(state, letter)
            state, named = worded
            found.append(named)
        return found

    def _word(self, state: int, letter: Letter) -> tuple[int, tuple[str, ...]]:
        """The state after a letter, and its literals.

        For a letter without atoms that is the first atom that the edge asks not to hold.
        """
        spec, given = self._spec, values(self._spec, letter)
        taken = ((e, p) for e in self._leaving[state] for p in e.guard.primes if prime_robustness(p, given) > 0)
        # A letter that breaks `exclusive` may take no edge: the monitor refuses it, and so will the test.
        target, prime = next(((edge.target, prime) for edge, prime in taken), (state, ()))
        named = tuple(atom.name for atom in spec.atoms if atom.name in letter)
        return target, named or (f"not {bracketed(spec.atoms[prime[0][0] if prime else 0].name)}",)

    @cached_property
    def _leaving(self) -> list[list[Edge]]:
        found: list[list[Edge]] = [[] for _ in self._spec.states]
        for edge in self._spec.edges:
            found[edge.source].append(edge)
        return found


class _Ran(NamedTuple):
    """A step of the last trace that was run: its letter, what the monitor said, and the monitor behind it."""

    letter: Letter
    result: Step
    monitor: Monitor


def test_block(title: str, spec: Fspa, letters: Iterable[Letter], expects: Expectations) -> str:
    """The text of one ``test`` block, as :meth:`Blocks.block` writes it."""
    return Blocks(spec).block(title, letters, expects)


def expectations(fspa: Fspa, letters: Iterable[Letter], steps: Iterable[int] | None = None) -> Expectations:
    """What to expect of one trace, as :meth:`Blocks.expectations` finds it."""
    return Blocks(fspa).expectations(letters, steps)


def _expected(step: Step) -> tuple[str, ...]:
    progress = floor(step.progress * 10_000 + 1e-6) / 10_000
    so_far = (f"progress >= {progress:.4g}",) if progress > 0 else ()
    return (step.verdict, *so_far, *_state(step.label))


def values(fspa: Fspa, letter: Letter) -> tuple[float, ...]:
    """A letter as the values of the atoms, in order, as tests give them: 1 for those that hold, -1 for the others."""
    return tuple(1.0 if atom.name in letter else -1.0 for atom in fspa.atoms)


def _state(label: str) -> tuple[str, ...]:
    """The expectation of a state, none where nobody would read its label, or no text can hold it."""
    return () if len(label) > _LONGEST_LABEL or '"' in label or "\n" in label else (f'state "{label}"',)


def bracketed(name: str) -> str:
    """The name of an atom as an operand: a comparison in brackets."""
    return f"({name})" if "<" in name or ">" in name else name


def _step(literals: Sequence[str], times: int) -> list[str]:
    """The lines of a ``step``, broken behind commas."""
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
