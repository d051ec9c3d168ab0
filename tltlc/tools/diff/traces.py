"""Show traces that distinguish two specs, in words and as ``test`` blocks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from tltlc.automaton.compare import Letter, Trace
from tltlc.core.record import record
from tltlc.monitor.guards import holds
from tltlc.monitor.samples import Samples
from tltlc.monitor.tables import tables
from tltlc.resolve.registers import following_atoms
from tltlc.resolve.values import number_text
from tltlc.tools.diff.relation import OF_A, OF_B, own_letter
from tltlc.tools.witness.blocks import given_values, test_block
from tltlc.tools.witness.step_lengths import length_of

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa, State
    from tltlc.tools.diff.pairs import SpecPair


@record
class TraceDescription:
    """A trace that only one of the specs A and B accepts, and the states of A and B after the trace.

    For an infinite trace, these are the states after its prefix and one round of its cycle.
    """

    trace: Trace
    a: State
    b: State


def trace_description(pair: SpecPair, trace: Trace) -> TraceDescription:
    """Return a description of ``trace``, which is over the atoms of both specs."""
    letters = (*trace.prefix, *trace.cycle)
    split_names = pair.comparison.split_names
    a = _state(pair.a, [own_letter(letter, split_names, pair.a, OF_A) for letter in letters])
    return TraceDescription(
        trace, a, _state(pair.b, [own_letter(letter, split_names, pair.b, OF_B) for letter in letters])
    )


def difference_test(pair: SpecPair, description: TraceDescription, title: str) -> tuple[str, str] | None:
    """Write a ``test`` block that shows how two specs differ on a trace; also return its spec, ``A`` or ``B``.

    The test is for B, or for A if only A has all atoms of the trace. Return None if no test can show
    the difference, because the verdicts are the same, or because an atom of the trace has different
    meanings in A and B. For an infinite trace, the test has the prefix and one round of the cycle.
    """
    letters = (*description.trace.prefix, *description.trace.cycle)
    named = frozenset[str]().union(*letters)
    atoms_a, atoms_b = ({atom.name for atom in fspa.atoms} for fspa in (pair.a, pair.b))
    side, fspa, state = "B", pair.b, description.b
    if not atoms_b or (named <= atoms_a and not named <= atoms_b):
        side, fspa, state = "A", pair.a, description.a
    if description.a.verdict == description.b.verdict or not fspa.atoms or not named <= atoms_a | atoms_b:
        return None
    return side, test_block(title, fspa, letters, {len(letters): (state.verdict,)})


def step_lines(pair: SpecPair, letters: Sequence[Letter]) -> list[str]:
    """Return lines that say which atoms hold at each step; equal consecutive steps share a line.

    Lines look like ``step 1: alive`` and ``steps 2 to 9 (0.8 s): nothing holds``. The time is that of
    all these steps, if both specs have the same clock; if it varies, a single step has its time, too.
    Atoms that follow from others are left out.
    """
    following = {
        atom.name + (suffix if atom.name in pair.comparison.split_names else "")
        for fspa, suffix in ((pair.a, OF_A), (pair.b, OF_B))
        for atom in fspa.atoms
        if atom.name in following_atoms(fspa.atoms, fspa.registers)
    }
    clock_s = pair.a.clock_s if pair.a.clock_s == pair.b.clock_s else None
    lines = []
    for letter, run in groupby(enumerate((letter - following for letter in letters), start=1), lambda step: step[1]):
        numbers = [number for number, _ in run]
        step_s = (length_of(letter, pair.a) or None) if pair.a.clock_varies else clock_s
        time = "" if step_s is None else f" ({number_text(round(len(numbers) * step_s, 3))} s)"
        steps = f"steps {numbers[0]} to {numbers[-1]}{time}"
        if len(numbers) == 1:
            steps = f"step {numbers[0]}{time if pair.a.clock_varies and numbers[0] > 1 else ''}"
        lines.append(f"{steps}: {', '.join(ordered_atoms(pair, letter)) or 'nothing holds'}")
    return lines


def ordered_atoms(pair: SpecPair, letter: Letter) -> list[str]:
    """Return the atoms of a letter: first those of A in their order, then those that only B has."""
    split_names = pair.comparison.split_names
    names = [atom.name + (OF_A if atom.name in split_names else "") for atom in pair.a.atoms]
    names += [atom.name + (OF_B if atom.name in split_names else "") for atom in pair.b.atoms]
    return [name for name in dict.fromkeys(names) if name in letter]


def _state(fspa: Fspa, letters: Iterable[Letter]) -> State:
    """Return the state of an automaton after a trace.

    No two atoms of an ``exclusive`` group of the automaton may hold together in the trace. Atoms that
    follow from others are computed, not read.
    """
    leaving, samples = tables(fspa).edges, Samples(fspa, None, [])
    state, registers = 0, samples.initial
    for letter in letters:
        length = samples.step_length(length_of(letter, fspa), 1)
        values = samples.from_atoms(given_values(fspa, letter), registers, length, 1)
        state = next(edge.target for edge in leaving[state] if holds(edge.guard, values.atoms))
        registers = values.registers
    return fspa.states[state]
