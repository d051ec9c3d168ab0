"""Traces as ``test`` blocks that can be pasted into the file of their spec."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from math import floor
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Edge, Fspa
from tltlc.monitor import Monitor
from tltlc.monitor.guards import prime_robustness

if TYPE_CHECKING:
    from tltlc.comparison import Letter

Expectations = Mapping[int, Sequence[str]]
"""What to ``expect`` (``pending``, ``progress >= 0.5``, ``state "G a"``) behind a step, by its number from 1."""

_WIDTH = 100
_INDENT = "    "
_LONGEST_LABEL = 300


def test_block(title: str, spec: Fspa, letters: Iterable[Letter], expects: Expectations) -> str:
    """The text of a ``test`` block, ended by a newline: a step for each letter, equal ones in a row as one.

    Letters hold names of atoms; those that are none of the spec's are left out.  Where a test is to pass, the letters
    must not break the spec's ``exclusive``.

    Raises:
        ValueError: no letter, no expectation, or a spec without atoms, of which there can be no test.
    """
    steps = list(enumerate(letters, start=1))
    if not spec.atoms or not steps or not any(expects.get(number) for number, _ in steps):
        raise ValueError("a test names atoms, takes at least one step and expects something")
    lines = [f'test "{_one_line(title)}" for {spec.name} {{']
    # A step behind which something is expected ends its run of equal ones.
    ends = sorted(number for number in expects if expects[number])
    literals = _literals(spec, [letter for _, letter in steps])
    for (_, named), run in groupby(steps, lambda step: (bisect_left(ends, step[0]), literals[step[0] - 1])):
        numbers = [number for number, _ in run]
        lines += _step(named, len(numbers))
        lines += [f"{_INDENT}expect {expected}" for expected in expects.get(numbers[-1], ())]
    return "\n".join([*lines, "}", ""])


def expectations(fspa: Fspa, letters: Iterable[Letter], steps: Iterable[int] | None = None) -> Expectations:
    """What the monitor says of a trace behind some steps, by their numbers from 1; by default the last one.

    The verdict, the progress, rounded down to four decimals, and the state unless its label is very long.
    """
    monitor = Monitor(fspa)
    said: dict[int, tuple[str, ...]] = {}
    for number, letter in enumerate(letters, start=1):
        step = monitor.step_atoms(values(fspa, letter))
        progress = floor(step.progress * 10_000 + 1e-6) / 10_000
        so_far = (f"progress >= {progress:.4g}",) if progress > 0 else ()
        said[number] = (step.verdict, *so_far, *_state(step.label))
    wanted = {max(said, default=0)} if steps is None else set(steps)
    return {number: expected for number, expected in said.items() if number in wanted}


def values(fspa: Fspa, letter: Letter) -> tuple[float, ...]:
    """A letter as the values of the atoms, in order, as tests give them: 1 for those that hold, -1 for the others."""
    return tuple(1.0 if atom.name in letter else -1.0 for atom in fspa.atoms)


def _state(label: str) -> tuple[str, ...]:
    """The expectation of a state, none where nobody would read its label, or no text can hold it."""
    return () if len(label) > _LONGEST_LABEL or '"' in label or "\n" in label else (f'state "{label}"',)


def _literals(spec: Fspa, letters: Sequence[Letter]) -> list[tuple[str, ...]]:
    """Of each letter the atoms that hold; where none does, one that does not, since a step names one.

    That one is the first that the edge asks not to hold.
    """
    leaving: dict[int, list[Edge]] = {}
    for edge in spec.edges:
        leaving.setdefault(edge.source, []).append(edge)
    found: list[tuple[str, ...]] = []
    state = 0
    for letter in letters:
        given = values(spec, letter)
        taken = ((e, prime) for e in leaving[state] for prime in e.guard.primes if prime_robustness(prime, given) > 0)
        # A letter that breaks `exclusive` may take no edge: the monitor refuses it, and so will the test.
        target, prime = next(((edge.target, prime) for edge, prime in taken), (state, ()))
        named = tuple(atom.name for atom in spec.atoms if atom.name in letter)
        found.append(named or (f"not {bracketed(spec.atoms[prime[0][0] if prime else 0].name)}",))
        state = target
    return found


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
