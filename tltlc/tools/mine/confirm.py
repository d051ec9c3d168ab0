"""Proposals as the compiler has them: each is compiled, and its automaton judges every trace."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.automaton.compare import Letter, are_equivalent
from tltlc.automaton.fspa import Edge, Fspa
from tltlc.automaton.infinite.work import OutOfWork
from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.monitor.guards import holds
from tltlc.monitor.tables import tables
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.mine.clause import Conjunction
from tltlc.tools.mine.evidence import Evidence, Recorded
from tltlc.tools.mine.measure import Figures
from tltlc.tools.mine.vocabulary import Words
from tltlc.tools.witness.blocks import values

_NAME: Final = "mined_candidate_"
"""Of specs that are only compiled."""


@record
class Judgement:
    """What an automaton says of a trace: whether it accepts it, and the sample, from 1, at which it was violated."""

    trace: Recorded
    accepted: bool
    violated_at: int | None


@record
class Proposal:
    """A spec with its automaton and what that says of the traces and the counterexamples, in order."""

    clauses: Conjunction
    fspa: Fspa
    traces: tuple[Judgement, ...]
    counterexamples: tuple[Judgement, ...]

    @property
    def figures(self) -> Figures:
        """Its figures, by the automaton."""
        return Figures(
            sum(each.accepted for each in self.traces),
            len(self.traces),
            sum(not each.accepted for each in self.counterexamples),
            len(self.counterexamples),
        )


def confirmed(
    ranked: Sequence[Conjunction], evidence: Evidence, words: Words, options: CompileOptions, top: int
) -> tuple[Proposal, ...]:
    """The first ``top`` of the ranked conjunctions that say different things, judged by their automata.

    One that accepts the same traces of the world, not only of the evidence, as an earlier one is left out.

    Raises:
        TltlError: an automaton is too large; what is wrong with the library.
    """
    found: list[Proposal] = []
    for first in range(0, len(ranked), 2 * top):
        several = ranked[first : first + 2 * top]
        for clauses, fspa in zip(several, _compiled(several, words, options), strict=True):
            if len(found) == top:
                return tuple(found)
            if not any(_same(fspa, other.fspa) for other in found):
                good, bad = (
                    tuple(judge(fspa, trace) for trace in part) for part in (evidence.traces, evidence.counterexamples)
                )
                found.append(Proposal(clauses, fspa, good, bad))
    return tuple(found)


def judge(fspa: Fspa, trace: Recorded) -> Judgement:
    """What the automaton says of a trace in atoms."""
    run = _Run(fspa)
    violated_at = None
    for number, letter in enumerate(trace.letters, start=1):
        run.step(letter)
        if violated_at is None and run.state.verdict == "violated":
            violated_at = number
    return Judgement(trace, run.state.accepting, violated_at)


class _Run:
    """An automaton on letters; what it did on one it does again without a look at the guards."""

    def __init__(self, fspa: Fspa) -> None:
        self._fspa = fspa
        self._edges = tables(fspa).edges
        self._known: dict[tuple[int, Letter], int] = {}
        self.state = fspa.states[0]

    def step(self, letter: Letter) -> None:
        key = (self.state.id, letter)
        target = self._known.get(key)
        if target is None:
            given = values(self._fspa, letter)
            taken: Edge = next(edge for edge in self._edges[self.state.id] if holds(edge.guard, given))
            target = self._known[key] = taken.target
        self.state = self._fspa.states[target]


def _compiled(several: Sequence[Conjunction], words: Words, options: CompileOptions) -> tuple[Fspa, ...]:
    text = words.library.text + "".join(
        f"\nspec {_NAME}{number} {{\n" + "".join(f"    {clause.text}\n" for clause in clauses) + "}\n"
        for number, clauses in enumerate(several)
    )
    source = SourceFile(words.library.name, text)
    names = tuple(f"{_NAME}{number}" for number in range(len(several)))
    return compile_source(source, replace(options, specs=names)).automata


def _same(one: Fspa, other: Fspa) -> bool:
    """Whether two automata accept the same traces; where that takes too long, as if not."""
    if one.spec_size != other.spec_size or len(one.states) != len(other.states):
        return False
    try:
        return are_equivalent(one, other)
    except OutOfWork:
        return False
