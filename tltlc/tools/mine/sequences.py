"""Sequences of goals, `reach a then b then c`, grown step by step instead of enumerated.

This is a beam search: the best sequences of a length are extended by every step at every place. A
sequence is met earliest by the first `a`, then the first `b` after it, and so on. So all traces
together cost a few integer operations per step. An extension is satisfied by fewer traces, never by
more, so a sequence that lacks support is not extended.

A step is an atom, two atoms at once, or a choice between two of these. Each option of a choice
lacks the support at that place; a sequence with a choice is met by the traces that meet it with
either option. No step follows an equal one, because waiting for a sample would meet it.
"""

from __future__ import annotations

from collections.abc import Collection, Generator, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Final

from tltlc.automaton.work import OutOfWork, Work
from tltlc.io.limits import WORK
from tltlc.tools.mine.bits import Bits, Samples, Verdicts, count
from tltlc.tools.mine.clause import MinedClause
from tltlc.tools.mine.measure import figures
from tltlc.tools.mine.templates import clause
from tltlc.tools.witness.blocks import atom_operand

BEAM: Final = 60
"""The most sequences of one length that are extended: this many of atoms alone, and this many others."""
ALIKE: Final = 3
"""The most sequences that are kept for one set of accepted traces."""
MOST_PAIRS: Final = 60
"""The most steps of two atoms; those that hold in most traces are kept."""
MOST_PARTS: Final = 16
"""The most steps that are combined into choices at one place."""


class SequenceStep:
    """One step of a sequence: its text, its samples, and its atoms (`and` and `or` count as one)."""

    __slots__ = ("atoms", "samples", "text")

    def __init__(self, text: str, atoms: int, samples: Samples) -> None:
        self.text, self.atoms, self.samples = text, atoms, samples


Steps = tuple[SequenceStep, ...]
Found = tuple[Steps, Verdicts]


def sequences(
    bits: Bits, atoms: Collection[str], least: int, most_atoms: int, *, again: bool = True, work: Work | None = None
) -> Iterator[list[MinedClause]]:
    """Yield the sequences of these atoms that at least ``least`` traces satisfy, in portions.

    They name at most ``most_atoms`` atoms; `and` and `or` count as one each. ``again``: a step may
    occur more than once. ``work`` counts the steps of the sequences that are tried; the search ends
    when it is used up.
    """
    material = yield from _material(bits, atoms)
    search = _Sequences(bits, material, least, most_atoms, again=again, work=work or Work(WORK["mined sequences"]))
    beam: list[Steps] = [()]
    while beam:
        extensions: dict[Steps, Verdicts] = {}
        for sequence in beam:
            try:
                portion = dict(search.extended(sequence, extensions))
            except OutOfWork:
                return
            extensions |= portion
            yield [_clause(longer, accepts, bits) for longer, accepts in portion.items()]
        beam = _beam(extensions, bits)


class _Sequences:
    """Builds sequences from their steps."""

    def __init__(
        self, bits: Bits, material: Sequence[SequenceStep], least: int, most_atoms: int, *, again: bool, work: Work
    ) -> None:
        self._bits, self._material, self._least, self._most_atoms = bits, material, least, most_atoms
        self._again, self._work = again, work
        # Sequences are compared by the identity of their steps, so each choice is created once.
        self._choices: dict[tuple[SequenceStep, SequenceStep], SequenceStep] = {}

    def extended(self, sequence: Steps, known: Mapping[Steps, Verdicts]) -> Iterator[Found]:
        """Yield the unknown sequences with one more step, at any place, that have the support."""
        bits = self._bits
        room = self._most_atoms - sum(step.atoms for step in sequence)
        left = bits.all
        for place in range(len(sequence) + 1):
            before, after = sequence[:place], sequence[place:]
            parts = []
            for step in self._material:
                if step.atoms > room or step in ((*before[-1:], *after[:1]) if self._again else sequence):
                    continue
                longer = (*before, step, *after)
                accepts = known.get(longer)
                if accepts is None:
                    self._work.spend(len(longer))
                    accepts = _met((step, *after), left, bits)
                    if count(accepts & bits.traces) >= self._least:
                        yield longer, accepts
                        continue
                    parts.append((step, accepts))
            for choice, accepts in self._chosen(parts, room):
                longer = (*before, choice, *after)
                if longer not in known:
                    yield longer, accepts
            if after:
                left = bits.after_first(after[0].samples & left)

    def _chosen(
        self, parts: Sequence[tuple[SequenceStep, Verdicts]], room: int
    ) -> Iterator[tuple[SequenceStep, Verdicts]]:
        """Yield the choices between two steps that together have the support, with their traces."""
        bits = self._bits

        def worth(part: tuple[SequenceStep, Verdicts]) -> tuple[float, int, str]:
            return (-figures(bits, part[1]).score(part[0].atoms), part[0].atoms, part[0].text)

        best = sorted((part for part in parts if part[1] & bits.traces), key=worth)[:MOST_PARTS]
        for (one, these), (other, those) in combinations(best, 2):
            accepts = these | those
            if one.atoms + other.atoms < room and count(accepts & bits.traces) >= self._least:
                yield self._choice(one, other), accepts

    def _choice(self, one: SequenceStep, other: SequenceStep) -> SequenceStep:
        if (one.atoms, one.text) > (other.atoms, other.text):
            one, other = other, one
        choice = self._choices.get((one, other))
        if choice is None:
            text = f"({one.text} or {other.text})"
            choice = SequenceStep(text, one.atoms + other.atoms + 1, one.samples | other.samples)
            self._choices[one, other] = choice
        return choice


def _material(bits: Bits, atoms: Collection[str]) -> Generator[list[MinedClause], None, list[SequenceStep]]:
    """Return the atoms that hold in some of the traces, then the pairs that hold in most traces.

    Yields empty portions many times, so that the caller may stop.
    """
    single = [SequenceStep(atom_operand(name), 1, bits.holds[name]) for name in atoms]
    single = [step for step in single if bits.some(step.samples) & bits.traces]
    known = {step.samples for step in single}
    pairs: list[tuple[int, str, Samples]] = []
    for number, one in enumerate(single):
        for other in single[number + 1 :]:
            both = one.samples & other.samples
            met = count(bits.some(both) & bits.traces)
            if met and both not in known:
                known.add(both)
                pairs.append((-met, f"({one.text} and {other.text})", both))
        pairs = sorted(pairs)[:MOST_PAIRS]
        yield []
    return [*single, *(SequenceStep(text, 3, both) for _, text, both in pairs)]


def _met(rest: Steps, left: Samples, bits: Bits) -> Verdicts:
    """Return the traces that meet the steps in order within the ``left`` samples."""
    for step in rest[:-1]:
        left = bits.after_first(step.samples & left)
    return bits.some(rest[-1].samples & left)


def _beam(extensions: Mapping[Steps, Verdicts], bits: Bits) -> list[Steps]:
    """Return the best of the sequences, a few for each set of accepted traces."""

    def worth(item: Found) -> tuple[float, list[str]]:
        sequence, accepts = item
        size = sum(step.atoms for step in sequence)
        return (-figures(bits, accepts).score(size), [step.text for step in sequence])

    alike: dict[tuple[bool, Verdicts], int] = {}
    # Sequences with choices are far more numerous. Without a separate list they would crowd out the others.
    plain: list[Steps] = []
    compound: list[Steps] = []
    for sequence, accepts in sorted(extensions.items(), key=worth):
        is_plain = all(step.atoms == 1 for step in sequence)
        alike[is_plain, accepts] = alike.get((is_plain, accepts), 0) + 1
        kept = plain if is_plain else compound
        if alike[is_plain, accepts] <= ALIKE and len(kept) < BEAM:
            kept.append(sequence)
    return plain + compound


def _clause(sequence: Steps, accepts: Verdicts, bits: Bits) -> MinedClause:
    text = "reach " + " then ".join(step.text for step in sequence)
    return clause("reach", text, sum(step.atoms for step in sequence), accepts, bits.everything)
