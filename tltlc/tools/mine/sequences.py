"""Sequences of goals, `reach a then b then c`, found by a beam search.

The search inserts every possible step at every position of the best sequences of each length. A
trace meets the sequence above if it has an `a`, a `b` after the first `a`, and a `c` after the first
such `b`. So testing a sequence on all traces takes a few integer operations for each step. A trace
that meets the longer sequence also meets the shorter one. So a sequence that too few traces meet is
not extended.

A step is an atom, two atoms at once, or a choice between two such steps. Two steps are combined
into a choice only if too few traces meet the sequence with either one alone. A trace meets a
sequence with a choice if it meets the sequence with either option. No step directly follows an
equal one: if an atom just goes on holding, the next sample would meet the second step.
"""

from __future__ import annotations

from collections.abc import Collection, Generator, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Final

from tltlc.automaton.work import OutOfWork, Work
from tltlc.io.limits import WORK
from tltlc.tools.mine.bits import Bits, SampleMask, TraceMask, count
from tltlc.tools.mine.clause import MinedClause
from tltlc.tools.mine.score import figures
from tltlc.tools.mine.templates import template_clause
from tltlc.tools.witness.blocks import atom_operand

BEAM: Final = 60
"""The most sequences of one length that are extended.

The limit holds for the sequences of single atoms, and again for the sequences with pairs or choices.
"""
ALIKE: Final = 3
"""Of the sequences that exactly the same traces meet, at most this many are kept."""
MOST_PAIRS: Final = 60
"""The most pairs of atoms that are used as steps. They are the pairs that occur in the most traces."""
MOST_PARTS: Final = 16
"""The most steps that are combined with each other into choices at one position of a sequence."""


class SequenceStep:
    """A step of a sequence: its text, its number of atoms, and the samples at which it holds.

    In ``atoms``, each `and` or `or` counts as one atom, too: ``(a and b)`` has 3.
    """

    __slots__ = ("atoms", "samples", "text")

    def __init__(self, text: str, atoms: int, samples: SampleMask) -> None:
        self.text, self.atoms, self.samples = text, atoms, samples


StepSequence = tuple[SequenceStep, ...]
AcceptedSequence = tuple[StepSequence, TraceMask]
"""A sequence, and the set of traces that meet it."""


def sequences(
    bits: Bits,
    atoms: Collection[str],
    least: int,
    most_atoms: int,
    *,
    allow_repeats: bool = True,
    work: Work | None = None,
) -> Iterator[list[MinedClause]]:
    """Yield sequences of these atoms that at least ``least`` traces meet, as `reach` clauses, in portions.

    A sequence has at most ``most_atoms`` atoms, where each `and` or `or` counts as one. With
    ``allow_repeats``, a step may occur more than once. ``work`` limits the search: each sequence
    that is tried costs as much as it has steps.
    """
    possible_steps = yield from _possible_steps(bits, atoms)
    search = _Sequences(
        bits, possible_steps, least, most_atoms, allow_repeats=allow_repeats, work=work or Work(WORK["mined sequences"])
    )
    beam: list[StepSequence] = [()]
    while beam:
        extensions: dict[StepSequence, TraceMask] = {}
        for sequence in beam:
            try:
                portion = dict(search.extensions(sequence, extensions))
            except OutOfWork:
                return
            extensions |= portion
            yield [_clause(longer, accepts, bits) for longer, accepts in portion.items()]
        beam = _beam(extensions, bits)


class _Sequences:
    """Finds the extensions of sequences by one step."""

    def __init__(
        self,
        bits: Bits,
        possible_steps: Sequence[SequenceStep],
        least: int,
        most_atoms: int,
        *,
        allow_repeats: bool,
        work: Work,
    ) -> None:
        self._bits, self._possible_steps, self._least, self._most_atoms = bits, possible_steps, least, most_atoms
        self._allow_repeats, self._work = allow_repeats, work
        # Sequences are compared by the identity of their steps, so each choice is created once.
        self._choices: dict[tuple[SequenceStep, SequenceStep], SequenceStep] = {}

    def extensions(self, sequence: StepSequence, known: Mapping[StepSequence, TraceMask]) -> Iterator[AcceptedSequence]:
        """Insert one more step into a sequence, at any position; yield the results that enough traces meet.

        Each comes with the set of traces that meet it. Sequences in ``known``, which maps sequences
        to these sets, are left out.

        Raises:
            OutOfWork: the limit on work is reached.
        """
        bits = self._bits
        room = self._most_atoms - sum(step.atoms for step in sequence)
        remaining = bits.all
        for place in range(len(sequence) + 1):
            before, after = sequence[:place], sequence[place:]
            unsupported = []
            for step in self._possible_steps:
                if step.atoms > room or step in ((*before[-1:], *after[:1]) if self._allow_repeats else sequence):
                    continue
                longer = (*before, step, *after)
                accepts = known.get(longer)
                if accepts is None:
                    self._work.spend(len(longer))
                    accepts = _accepted((step, *after), remaining, bits)
                    if count(accepts & bits.traces) >= self._least:
                        yield longer, accepts
                        continue
                    unsupported.append((step, accepts))
            for choice, accepts in self._supported_choices(unsupported, room):
                longer = (*before, choice, *after)
                if longer not in known:
                    yield longer, accepts
            if after:
                remaining = bits.after_first(after[0].samples & remaining)

    def _supported_choices(
        self, steps: Sequence[tuple[SequenceStep, TraceMask]], room: int
    ) -> Iterator[tuple[SequenceStep, TraceMask]]:
        """Combine two of ``steps`` to a choice such as ``(a or b)``; yield the choices that enough traces meet.

        Each of ``steps``, and each choice, comes with the set of traces that meet the sequence with
        it. ``room`` is the number of atoms that the sequence may still add.
        """
        bits = self._bits

        def sort_key(item: tuple[SequenceStep, TraceMask]) -> tuple[float, int, str]:
            step, accepts = item
            return (-figures(bits, accepts).score(step.atoms), step.atoms, step.text)

        best = sorted((item for item in steps if item[1] & bits.traces), key=sort_key)[:MOST_PARTS]
        for (first, first_accepts), (second, second_accepts) in combinations(best, 2):
            accepts = first_accepts | second_accepts
            if first.atoms + second.atoms < room and count(accepts & bits.traces) >= self._least:
                yield self._choice(first, second), accepts

    def _choice(self, first: SequenceStep, second: SequenceStep) -> SequenceStep:
        if (first.atoms, first.text) > (second.atoms, second.text):
            first, second = second, first
        choice = self._choices.get((first, second))
        if choice is None:
            text = f"({first.text} or {second.text})"
            choice = SequenceStep(text, first.atoms + second.atoms + 1, first.samples | second.samples)
            self._choices[first, second] = choice
        return choice


def _possible_steps(bits: Bits, atoms: Collection[str]) -> Generator[list[MinedClause], None, list[SequenceStep]]:
    """Return the steps of one atom and of two atoms, after yielding some empty lists.

    The empty lists let the caller stop the search. A step is left out if it holds in no trace. Of
    the steps of two atoms, only the ``MOST_PAIRS`` that hold in the most traces are returned.
    """
    single = [SequenceStep(atom_operand(name), 1, bits.holds[name]) for name in atoms]
    single = [step for step in single if bits.traces_with(step.samples) & bits.traces]
    known = {step.samples for step in single}
    pairs: list[tuple[int, str, SampleMask]] = []
    for number, first in enumerate(single):
        for second in single[number + 1 :]:
            both = first.samples & second.samples
            trace_count = count(bits.traces_with(both) & bits.traces)
            if trace_count and both not in known:
                known.add(both)
                pairs.append((-trace_count, f"({first.text} and {second.text})", both))
        pairs = sorted(pairs)[:MOST_PAIRS]
        yield []
    return [*single, *(SequenceStep(text, 3, both) for _, text, both in pairs)]


def _accepted(steps: StepSequence, remaining: SampleMask, bits: Bits) -> TraceMask:
    """Return the traces that meet the steps, one after the other, at samples in ``remaining``."""
    for step in steps[:-1]:
        remaining = bits.after_first(step.samples & remaining)
    return bits.traces_with(steps[-1].samples & remaining)


def _beam(extensions: Mapping[StepSequence, TraceMask], bits: Bits) -> list[StepSequence]:
    """Return the sequences with the best scores, to be extended next.

    Of the sequences that exactly the same traces meet, at most ``ALIKE`` are returned.
    """

    def sort_key(item: AcceptedSequence) -> tuple[float, list[str]]:
        sequence, accepts = item
        size = sum(step.atoms for step in sequence)
        return (-figures(bits, accepts).score(size), [step.text for step in sequence])

    alike: dict[tuple[bool, TraceMask], int] = {}
    # There are far more sequences with pairs or choices. In one list, they would leave no room for the others.
    plain: list[StepSequence] = []
    compound: list[StepSequence] = []
    for sequence, accepts in sorted(extensions.items(), key=sort_key):
        is_plain = all(step.atoms == 1 for step in sequence)
        alike[is_plain, accepts] = alike.get((is_plain, accepts), 0) + 1
        kept = plain if is_plain else compound
        if alike[is_plain, accepts] <= ALIKE and len(kept) < BEAM:
            kept.append(sequence)
    return plain + compound


def _clause(sequence: StepSequence, accepts: TraceMask, bits: Bits) -> MinedClause:
    text = "reach " + " then ".join(step.text for step in sequence)
    return template_clause("reach", text, sum(step.atoms for step in sequence), accepts, bits.all_traces)
