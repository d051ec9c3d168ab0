"""Compile proposals and let their automata judge every trace."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.automaton.compare import Letter, are_equivalent
from tltlc.automaton.fspa import Edge, Fspa
from tltlc.automaton.work import OutOfWork
from tltlc.core.record import record, replace
from tltlc.monitor.guards import holds
from tltlc.monitor.samples import Samples
from tltlc.monitor.tables import tables
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.mine.clause import Conjunction
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.score import Support
from tltlc.tools.mine.vocabulary import MiningVocabulary
from tltlc.tools.witness.blocks import given_values, letter_values
from tltlc.tools.witness.step_lengths import length_of

_NAME: Final = "mined_candidate_"
"""The prefix of the names that candidates have while they are compiled."""


@record
class ProposalVerdict:
    """Whether the automaton of a proposal accepts a trace, and if not, where the trace violates it.

    ``violated_at`` is the number, from 1, of the first sample after which the verdict is
    ``violated``. It is None if the trace does not violate the spec. Such a trace may still be
    rejected, because a goal is not reached.
    """

    trace: LabelledTrace
    accepted: bool
    violated_at: int | None


@record
class Proposal:
    """A spec with its automaton, and the verdicts on the traces and counterexamples, in order."""

    clauses: Conjunction
    fspa: Fspa
    traces: tuple[ProposalVerdict, ...]
    counterexamples: tuple[ProposalVerdict, ...]

    @property
    def figures(self) -> Support:
        """How many traces and counterexamples the automaton accepts and rejects."""
        return Support(
            sum(judgement.accepted for judgement in self.traces),
            len(self.traces),
            sum(not judgement.accepted for judgement in self.counterexamples),
            len(self.counterexamples),
        )


def confirm(
    ranked: Sequence[Conjunction], evidence: Evidence, vocabulary: MiningVocabulary, options: CompileOptions, top: int
) -> tuple[Proposal, ...]:
    """Compile the first conjunctions of ``ranked``, the best first, and return at most ``top`` proposals.

    A conjunction is left out if it is equivalent to an earlier one: both accept the same traces. All
    possible traces count for this, not only those in ``evidence``.

    Raises:
        TltlError: an automaton is too large, or the library has an error.
    """
    proposals: list[Proposal] = []
    for first in range(0, len(ranked), 2 * top):
        batch = ranked[first : first + 2 * top]
        for clauses, fspa in zip(batch, _compile(batch, vocabulary, options), strict=True):
            if len(proposals) == top:
                return tuple(proposals)
            if not any(_are_equivalent(fspa, proposal.fspa) for proposal in proposals):
                good, bad = (
                    tuple(judge(fspa, trace) for trace in part) for part in (evidence.traces, evidence.counterexamples)
                )
                proposals.append(Proposal(clauses, fspa, good, bad))
    return tuple(proposals)


def judge(fspa: Fspa, trace: LabelledTrace) -> ProposalVerdict:
    """Run an automaton on a trace, and return whether it accepts the trace."""
    run = _MemoryRun(fspa) if fspa.registers else _Run(fspa)
    violated_at = None
    for number, letter in enumerate(trace.letters, start=1):
        run.step(letter)
        if violated_at is None and run.state.verdict == "violated":
            violated_at = number
    return ProposalVerdict(trace, run.state.accepting, violated_at)


class _Run:
    """A run of an automaton, letter by letter. ``state`` is the current state.

    The next state for each state and letter is cached.
    """

    def __init__(self, fspa: Fspa) -> None:
        self._fspa = fspa
        self._edges = tables(fspa).edges
        self._targets: dict[tuple[int, Letter], int] = {}
        self.state = fspa.states[0]

    def step(self, letter: Letter) -> None:
        key = (self.state.id, letter)
        target = self._targets.get(key)
        if target is None:
            target = self._targets[key] = self._target(letter_values(self._fspa, letter))
        self.state = self._fspa.states[target]

    def _target(self, atom_values: Sequence[float]) -> int:
        enabled: Edge = next(edge for edge in self._edges[self.state.id] if holds(edge.guard, atom_values))
        return enabled.target


class _MemoryRun(_Run):
    """A run of an automaton with registers: the atoms that follow from others are computed, not read."""

    def __init__(self, fspa: Fspa) -> None:
        super().__init__(fspa)
        self._samples = Samples(fspa, None, [])
        self._registers = self._samples.initial

    def step(self, letter: Letter) -> None:
        length = self._samples.step_length(length_of(letter, self._fspa), 1)
        values = self._samples.from_atoms(given_values(self._fspa, letter), self._registers, length, 1)
        self._registers = values.registers
        self.state = self._fspa.states[self._target(values.atoms)]


def _compile(batch: Sequence[Conjunction], vocabulary: MiningVocabulary, options: CompileOptions) -> tuple[Fspa, ...]:
    text = vocabulary.library.text + "".join(
        f"\nspec {_NAME}{number} {{\n" + "".join(f"    {clause.text}\n" for clause in clauses) + "}\n"
        for number, clauses in enumerate(batch)
    )
    source = vocabulary.library.with_text(text)
    names = tuple(f"{_NAME}{number}" for number in range(len(batch)))
    return compile_source(source, replace(options, specs=names)).automata


def _are_equivalent(first: Fspa, second: Fspa) -> bool:
    """Whether two automata accept the same traces. False as well if the comparison takes too long."""
    if first.spec_size != second.spec_size or len(first.states) != len(second.states):
        return False
    try:
        return are_equivalent(first, second)
    except OutOfWork:
        return False
