"""The search for specs: it recovers planted specs, and its masks agree with the automata."""

from __future__ import annotations

from itertools import chain, islice
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.mine_traces import ATOMS, PlantedSpec, evidence, paper_specs, random_spec
from tests.fuzzing import times
from tests.tools.mine.conftest import evidences, vocabulary
from tltlc.automaton.compare import are_equivalent
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.mine.bits import Bits
from tltlc.tools.mine.clause import Conjunction, accepted_traces, count_atoms
from tltlc.tools.mine.confirm import Proposal, confirm, judge
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.reasons import reasons
from tltlc.tools.mine.score import figures
from tltlc.tools.mine.search import MiningOptions, SpecSearch
from tltlc.tools.mine.sequences import sequences
from tltlc.tools.mine.templates import KINDS, TIMED, clauses


def proposals(given_evidence: Evidence, options: MiningOptions | None = None, top: int = 5) -> tuple[Proposal, ...]:
    search = SpecSearch(given_evidence, options or MiningOptions())
    list(search.run())
    atoms = given_evidence.atoms() or ("a",)
    return confirm(search.ranking(), given_evidence, vocabulary(atoms), CompileOptions(), top)


def verdicts(given_evidence: Evidence, accepts: int) -> list[bool]:
    return [bool(accepts >> (8 * number) & 0x80) for number in range(len(given_evidence.all))]


@settings(max_examples=25, deadline=None)
@given(evidences())
def test_bit_masks_agree_with_the_automata(given_evidence: Evidence) -> None:
    forwards, backwards = Bits(given_evidence), Bits(given_evidence, backwards=True)
    atoms = list(forwards.holds)
    mined_clauses = [
        *chain.from_iterable(clauses(forwards, backwards, atoms)),
        *(clause for portion in islice(sequences(forwards, atoms, 1, 4), 6) for clause in portion[:10]),
    ]
    text = vocabulary().library.text + "".join(
        f"spec s{i} {{ {clause.text} }}\n" for i, clause in enumerate(mined_clauses)
    )
    automata = compile_source(SourceFile("all.tltl", text)).automata if mined_clauses else ()
    for clause, fspa in zip(mined_clauses, automata, strict=True):
        assert [judge(fspa, trace).accepted for trace in given_evidence.all] == verdicts(
            given_evidence, clause.accepts
        ), clause.text


def test_every_template_has_an_instance_in_some_evidence() -> None:
    kinds = {"reach"}
    for number in (1, 4, 8):
        given_evidence = evidence(random_spec(number), 10, 10, seed=3)
        forwards, backwards = Bits(given_evidence), Bits(given_evidence, backwards=True)
        portions = clauses(forwards, backwards, list(forwards.holds))
        kinds |= {clause.kind for clause in chain.from_iterable(portions)}
    assert kinds == set(KINDS) - set(TIMED)


@settings(max_examples=12, deadline=None)
@given(evidences(longest=8))
def test_figures_agree_with_automata_and_masks(given_evidence: Evidence) -> None:
    search = SpecSearch(given_evidence, MiningOptions(min_support=0.5))
    list(search.run())
    for proposal in confirm(search.ranking(), given_evidence, vocabulary(), CompileOptions(), 5):
        accepts = accepted_traces(proposal.clauses, search.bits)
        accepted = [judgement.accepted for judgement in (*proposal.traces, *proposal.counterexamples)]
        assert accepted == verdicts(given_evidence, accepts)
        assert proposal.figures.support >= 0.5
        assert proposal.figures.rejected >= 1


@settings(max_examples=12, deadline=None)
@given(evidences(longest=8))
def test_a_support_of_one_means_that_all_traces_are_accepted(given_evidence: Evidence) -> None:
    for proposal in proposals(given_evidence):
        assert proposal.figures.support == 1.0
        assert all(judge(proposal.fspa, trace).accepted for trace in given_evidence.traces)


@times(8)
@given(st.integers(1, 8), st.integers(0, 10_000))
def test_a_planted_sequence_of_any_length_is_recovered(length: int, seed: int) -> None:
    steps = Random(seed).sample(ATOMS, length)
    spec = PlantedSpec("sequence", ("reach " + " then ".join(steps),), dict.fromkeys(ATOMS, 0.15))
    # The added counterexamples lack one step, or swap two steps, so that no shorter spec separates the traces.
    proposed = proposals(_with_all_orders(spec, steps, evidence(spec, 20, 40, seed)))
    assert are_equivalent(proposed[0].fspa, spec.automaton())


def _with_all_orders(spec: PlantedSpec, steps: list[str], given_evidence: Evidence) -> Evidence:
    wrong_orders = [steps[:place] + steps[place + 1 :] for place in range(len(steps))]
    wrong_orders += [
        [*steps[:place], steps[place + 1], steps[place], *steps[place + 2 :]] for place in range(len(steps) - 1)
    ]
    letters = [tuple(frozenset({step}) for step in wrong_order) or (frozenset(),) for wrong_order in wrong_orders]
    # All other atoms hold between the steps, so they do not help to separate the traces.
    filler = [frozenset(ATOMS) - set(steps)] * 9
    missed = tuple(
        LabelledTrace(
            f"missed {number}", tuple(part for letter in letters_of_trace for part in (*filler, letter)) + tuple(filler)
        )
        for number, letters_of_trace in enumerate(letters)
    )
    return Evidence(given_evidence.traces, (*given_evidence.counterexamples, *missed))


@pytest.mark.parametrize("spec", paper_specs(), ids=lambda spec: spec.name)
def test_the_plans_of_the_paper_are_recovered(spec: PlantedSpec) -> None:
    proposed = proposals(evidence(spec, 40, 80, seed=1), top=1)
    assert are_equivalent(proposed[0].fspa, spec.automaton())


def test_a_planted_spec_is_recovered_despite_wrong_labels_if_support_is_below_one() -> None:
    spec = random_spec(0)
    given_evidence = evidence(spec, 40, 80, seed=1, noise=0.05)
    proposed = proposals(given_evidence, MiningOptions(min_support=0.9))
    assert are_equivalent(proposed[0].fspa, spec.automaton())
    assert all(proposal.figures.support == 1.0 for proposal in proposals(given_evidence))


def test_the_order_of_proposals_does_not_depend_on_the_order_of_traces() -> None:
    given_evidence = evidence(random_spec(3), 20, 30, seed=5)
    first, second = ([proposal.clauses for proposal in proposals(given_evidence)] for _ in range(2))
    assert _texts(first) == _texts(second)
    reversed_evidence = Evidence(given_evidence.traces[::-1], given_evidence.counterexamples[::-1])
    assert _texts([proposal.clauses for proposal in proposals(reversed_evidence)]) == _texts(first)


def _texts(conjunctions: list[Conjunction]) -> list[list[str]]:
    return [[clause.text for clause in conjunction] for conjunction in conjunctions]


def test_the_best_proposal_so_far_is_available_at_any_time() -> None:
    given_evidence = evidence(random_spec(1), 20, 30, seed=5)
    search = SpecSearch(given_evidence, MiningOptions())
    best = -2.0
    assert search.ranking() == []
    for _ in search.run():
        ranked = search.ranking()
        if ranked:
            score = figures(search.bits, accepted_traces(ranked[0], search.bits)).score(count_atoms(ranked[0]))
            assert score >= best
            best = score
    assert best > 0.9


def test_no_proposal_is_longer_than_allowed() -> None:
    given_evidence = evidence(random_spec(1), 20, 30, seed=5)
    search = SpecSearch(given_evidence, MiningOptions(max_length=3))
    list(search.run())
    assert search.ranking()
    assert max(map(count_atoms, search.ranking())) <= 3


def test_a_later_proposal_never_has_more_atoms() -> None:
    proposed = [proposal.clauses for proposal in proposals(evidence(random_spec(2), 20, 40, seed=2))]
    sizes = [count_atoms(conjunction) for conjunction in proposed]
    assert sizes == sorted(sizes, reverse=True)
    assert len(proposed) > 1


def test_a_trace_that_breaks_a_clause_does_not_count_as_vacuous() -> None:
    a, b, neither = frozenset("a"), frozenset("b"), frozenset[str]()
    given_evidence = Evidence(
        (LabelledTrace("met", (a, b)), LabelledTrace("vacuous", (b,)), LabelledTrace("broken", (neither, b))),
        (LabelledTrace("counterexample", (neither, neither)),),
    )
    forwards, backwards = Bits(given_evidence), Bits(given_evidence, backwards=True)
    mined_clauses = chain.from_iterable(clauses(forwards, backwards, ["a", "b"]))
    clause = next(clause for clause in mined_clauses if clause.text == "require a until b")
    (proposal,) = confirm([(clause,)], given_evidence, vocabulary(("a", "b")), CompileOptions(), 1)
    *_, last = reasons(proposal, given_evidence, forwards)
    assert last == "`require a until b`: in 1 of 3 traces nothing triggers it"
