"""Compile proposals and let their automata judge every trace."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.automaton.compare import Letter, are_equivalent
from tltlc.automaton.fspa import Edge, Fspa
from tltlc.automaton.work import OutOfWork
from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.monitor.guards import holds
from tltlc.monitor.tables import tables
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.mine.clause import Conjunction
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.measure import Support
from tltlc.tools.mine.vocabulary import MiningVocabulary
from tltlc.tools.witness.blocks import letter_values

_NAME: Final = "mined_candidate_"
"""The name prefix of specs that are only compiled."""


@record
class TraceVerdict:
    """The verdict of an automaton on a trace.

    It says whether the automaton accepts the trace, and at which sample (from 1) it was violated.
    """

    trace: LabelledTrace
    accepted: bool
    violated_at: int | None


@record
class Proposal:
    """A spec with its automaton and the judgements on traces and counterexamples, in order."""

    clauses: Conjunction
    fspa: Fspa
    traces: tuple[TraceVerdict, ...]
    counterexamples: tuple[TraceVerdict, ...]

    @property
    def figures(self) -> Support:
        """Its figures according to the automaton."""
        return Support(
            sum(judgement.accepted for judgement in self.traces),
            len(self.traces),
            sum(not judgement.accepted for judgement in self.counterexamples),
            len(self.counterexamples),
        )


def confirmed(
    ranked: Sequence[Conjunction], evidence: Evidence, words: MiningVocabulary, options: CompileOptions, top: int
) -> tuple[Proposal, ...]:
    """Return the first ``top`` conjunctions that differ in meaning, judged by their automata.

    A conjunction is left out if it accepts the same traces as an earlier one, considering all
    possible traces and not only the evidence.

    Raises:
        TltlError: an automaton is too large, or the library has an error.
    """
    proposals: list[Proposal] = []
    for first in range(0, len(ranked), 2 * top):
        batch = ranked[first : first + 2 * top]
        for clauses, fspa in zip(batch, _compiled(batch, words, options), strict=True):
            if len(proposals) == top:
                return tuple(proposals)
            if not any(_same(fspa, proposal.fspa) for proposal in proposals):
                good, bad = (
                    tuple(judge(fspa, trace) for trace in part) for part in (evidence.traces, evidence.counterexamples)
                )
                proposals.append(Proposal(clauses, fspa, good, bad))
    return tuple(proposals)


def judge(fspa: Fspa, trace: LabelledTrace) -> TraceVerdict:
    """Return the judgement of the automaton on a trace of atoms."""
    run = _Run(fspa)
    violated_at = None
    for number, letter in enumerate(trace.letters, start=1):
        run.step(letter)
        if violated_at is None and run.state.verdict == "violated":
            violated_at = number
    return TraceVerdict(trace, run.state.accepting, violated_at)


class _Run:
    """A run of an automaton on letters; it caches the transition of each state and letter."""

    def __init__(self, fspa: Fspa) -> None:
        self._fspa = fspa
        self._edges = tables(fspa).edges
        self._known: dict[tuple[int, Letter], int] = {}
        self.state = fspa.states[0]

    def step(self, letter: Letter) -> None:
        key = (self.state.id, letter)
        target = self._known.get(key)
        if target is None:
            truth = letter_values(self._fspa, letter)
            taken: Edge = next(edge for edge in self._edges[self.state.id] if holds(edge.guard, truth))
            target = self._known[key] = taken.target
        self.state = self._fspa.states[target]


def _compiled(batch: Sequence[Conjunction], words: MiningVocabulary, options: CompileOptions) -> tuple[Fspa, ...]:
    text = words.library.text + "".join(
        f"\nspec {_NAME}{number} {{\n" + "".join(f"    {clause.text}\n" for clause in clauses) + "}\n"
        for number, clauses in enumerate(batch)
    )
    source = SourceFile(words.library.name, text)
    names = tuple(f"{_NAME}{number}" for number in range(len(batch)))
    return compile_source(source, replace(options, specs=names)).automata


def _same(one: Fspa, other: Fspa) -> bool:
    """Whether two automata accept the same traces; False if the comparison takes too long."""
    if one.spec_size != other.spec_size or len(one.states) != len(other.states):
        return False
    try:
        return are_equivalent(one, other)
    except OutOfWork:
        return False
