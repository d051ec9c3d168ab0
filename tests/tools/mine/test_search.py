from __future__ import annotations

from itertools import chain, islice
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.mine_traces import ATOMS, Planted, evidence, of_the_paper, planted
from tests.tools.mine.conftest import evidences, words
from tltlc.automaton.compare import are_equivalent
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.mine.bits import Bits
from tltlc.tools.mine.clause import Conjunction, accepted_by, atoms_of
from tltlc.tools.mine.confirm import Proposal, confirmed, judge
from tltlc.tools.mine.evidence import Evidence, Recorded
from tltlc.tools.mine.measure import figures
from tltlc.tools.mine.search import Options, Search
from tltlc.tools.mine.sequences import sequences
from tltlc.tools.mine.templates import KINDS, clauses


def proposals(given_: Evidence, options: Options | None = None, top: int = 5) -> tuple[Proposal, ...]:
    search = Search(given_, options or Options())
    list(search.run())
    atoms = given_.atoms() or ("a",)
    return confirmed(search.ranked(), given_, words(atoms), CompileOptions(), top)


def verdicts(given_: Evidence, accepts: int) -> list[bool]:
    return [bool(accepts >> (8 * number) & 0x80) for number in range(len(given_.all))]


@settings(max_examples=25, deadline=None)
@given(evidences())
def test_the_masks_say_what_the_automata_say(given_: Evidence) -> None:
    forwards, backwards = Bits(given_), Bits(given_, backwards=True)
    atoms = list(forwards.holds)
    found = [
        *chain.from_iterable(clauses(forwards, backwards, atoms, 1)),
        *(each for portion in islice(sequences(forwards, atoms, 1, 4), 6) for each in portion[:10]),
    ]
    text = words().library.text + "".join(f"spec s{i} {{ {each.text} }}\n" for i, each in enumerate(found))
    automata = compile_source(SourceFile("all.tltl", text)).automata if found else ()
    for each, fspa in zip(found, automata, strict=True):
        assert [judge(fspa, trace).accepted for trace in given_.all] == verdicts(given_, each.accepts), each.text


def test_every_template_is_tried() -> None:
    kinds = {"reach"}
    for number in (1, 4, 8):
        given_ = evidence(planted(number), 10, 10, seed=3)
        forwards, backwards = Bits(given_), Bits(given_, backwards=True)
        found = clauses(forwards, backwards, list(forwards.holds), 10)
        kinds |= {each.kind for each in chain.from_iterable(found)}
    assert kinds == set(KINDS)


@settings(max_examples=12, deadline=None)
@given(evidences(longest=8))
def test_figures_are_those_of_the_automata_and_of_the_masks(given_: Evidence) -> None:
    search = Search(given_, Options(min_support=0.5))
    list(search.run())
    for proposal in confirmed(search.ranked(), given_, words(), CompileOptions(), 5):
        accepts = accepted_by(proposal.clauses, search.bits)
        said = [each.accepted for each in (*proposal.traces, *proposal.counterexamples)]
        assert said == verdicts(given_, accepts)
        assert proposal.figures.support >= 0.5
        assert proposal.figures.rejected >= 1


@settings(max_examples=12, deadline=None)
@given(evidences(longest=8))
def test_support_of_one_means_that_all_traces_are_accepted(given_: Evidence) -> None:
    for proposal in proposals(given_):
        assert proposal.figures.support == 1.0
        assert all(judge(proposal.fspa, trace).accepted for trace in given_.traces)


@settings(max_examples=15, deadline=None)
@given(st.integers(1, 8), st.integers(0, 10_000))
def test_a_planted_sequence_of_any_length_is_recovered(length: int, seed: int) -> None:
    steps = Random(seed).sample(ATOMS, length)
    spec = Planted("sequence", ("reach " + " then ".join(steps),), dict.fromkeys(ATOMS, 0.15))
    # With sequences that fail for want of one step each, or in another order, nothing shorter tells all apart.
    found = proposals(_with_all_orders(spec, steps, evidence(spec, 20, 40, seed)))
    assert are_equivalent(found[0].fspa, spec.automaton())


def _with_all_orders(spec: Planted, steps: list[str], given_: Evidence) -> Evidence:
    others = [steps[:place] + steps[place + 1 :] for place in range(len(steps))]
    others += [[*steps[:place], steps[place + 1], steps[place], *steps[place + 2 :]] for place in range(len(steps) - 1)]
    letters = [tuple(frozenset({step}) for step in other) or (frozenset(),) for other in others]
    # Any other atom may have come in between, and none of them helps.
    filler = [frozenset(ATOMS) - set(steps)] * 9
    missed = tuple(
        Recorded(f"missed {number}", tuple(part for letter in each for part in (*filler, letter)) + tuple(filler))
        for number, each in enumerate(letters)
    )
    return Evidence(given_.traces, (*given_.counterexamples, *missed))


@pytest.mark.parametrize("spec", of_the_paper(), ids=lambda spec: spec.name)
def test_the_plans_of_the_paper_are_recovered(spec: Planted) -> None:
    found = proposals(evidence(spec, 40, 80, seed=1), top=1)
    assert are_equivalent(found[0].fspa, spec.automaton())


def test_wrong_labels_are_tolerated_where_that_is_asked_for() -> None:
    spec = planted(0)
    given_ = evidence(spec, 40, 80, seed=1, noise=0.05)
    found = proposals(given_, Options(min_support=0.9))
    assert are_equivalent(found[0].fspa, spec.automaton())
    assert all(proposal.figures.support == 1.0 for proposal in proposals(given_))


def test_the_order_is_the_same_each_time() -> None:
    given_ = evidence(planted(3), 20, 30, seed=5)
    first, second = ([proposal.clauses for proposal in proposals(given_)] for _ in range(2))
    assert _texts(first) == _texts(second)
    turned = Evidence(given_.traces[::-1], given_.counterexamples[::-1])
    assert _texts([proposal.clauses for proposal in proposals(turned)]) == _texts(first)


def _texts(found: list[Conjunction]) -> list[list[str]]:
    return [[each.text for each in conjunction] for conjunction in found]


def test_the_best_so_far_can_be_had_at_any_moment() -> None:
    given_ = evidence(planted(1), 20, 30, seed=5)
    search = Search(given_, Options())
    best = -2.0
    assert search.ranked() == []
    for _ in search.run():
        ranked = search.ranked()
        if ranked:
            score = figures(search.bits, accepted_by(ranked[0], search.bits)).score(atoms_of(ranked[0]))
            assert score >= best
            best = score
    assert best > 0.9


def test_no_proposal_is_longer_than_allowed() -> None:
    given_ = evidence(planted(1), 20, 30, seed=5)
    search = Search(given_, Options(max_length=3))
    list(search.run())
    assert search.ranked()
    assert max(map(atoms_of, search.ranked())) <= 3


def test_what_is_proposed_is_better_or_shorter_than_what_comes_behind() -> None:
    found = [proposal.clauses for proposal in proposals(evidence(planted(2), 20, 40, seed=2))]
    sizes = [atoms_of(each) for each in found]
    assert sizes == sorted(sizes, reverse=True)
    assert len(found) > 1
