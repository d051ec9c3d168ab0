"""Clauses about times and counts: hidden rules are found, chance is not taken for a rule, masks agree with automata."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import chain
from pathlib import Path
from random import Random
from unittest.mock import patch

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.interfaces.cli.conftest import Outcome
from tests.tools.mine.conftest import evidences
from tests.tools.mine.timed_traces import (
    CLOCK_S,
    Rule,
    Tracks,
    answers,
    at_random,
    counted,
    held,
    in_order,
    once_in_time,
    stays,
    timed_evidence,
)
from tltlc.automaton.work import Work
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.io.limits import WORK
from tltlc.pipeline import CompileOptions, compile_file, compile_source
from tltlc.resolve.options import ResolveOptions
from tltlc.tools.mine import timed_evidence as timed_evidence_module
from tltlc.tools.mine.bits import Bits
from tltlc.tools.mine.clause import MinedClause
from tltlc.tools.mine.confirm import confirm, judge
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.pair_times import pair_times
from tltlc.tools.mine.round_times import RoundTimes
from tltlc.tools.mine.search import MiningOptions, SpecSearch
from tltlc.tools.mine.single_times import single_times
from tltlc.tools.mine.templates import TIMED
from tltlc.tools.mine.timed_evidence import TimedEvidence, gaps, intervals
from tltlc.tools.mine.trace_clock import clock_declaration, trace_clock
from tltlc.tools.mine.trace_letters import TraceFile
from tltlc.tools.mine.vocabulary import vocabulary_of_library

Run = Callable[..., Outcome]


def timed_clauses(evidence: Evidence, work: int = WORK["mined times"]) -> list[MinedClause]:
    bits = Bits(evidence)
    timed = TimedEvidence(evidence, bits, len(evidence.traces))
    events = list(bits.holds)
    return list(chain.from_iterable((*single_times(timed, events), *pair_times(timed, events, Work(work)))))


def texts(evidence: Evidence) -> list[str]:
    return [clause.text for clause in timed_clauses(evidence)]


def library(evidence: Evidence) -> str:
    clock = "" if evidence.clock_s is None else f"clock {evidence.clock_s} s\n"
    return clock + "".join(f"signal {name}: bool\n" for name in evidence.atoms())


@settings(max_examples=40, deadline=None)
@given(evidences(atoms=("a", "b"), longest=30), st.sampled_from([None, 0.1]))
def test_masks_agree_with_the_automata(given_evidence: Evidence, clock_s: float | None) -> None:
    given_evidence = replace(given_evidence, clock_s=clock_s)
    # Every bound that the traces meet counts as real.
    with patch.object(timed_evidence_module, "LEVEL", 1e9):
        clauses = timed_clauses(given_evidence)
    text = library(given_evidence) + "".join(f"spec s{i} {{ {clause.text} }}\n" for i, clause in enumerate(clauses))
    automata = compile_source(SourceFile("all.tltl", text)).automata if clauses else ()
    for clause, fspa in zip(clauses, automata, strict=True):
        accepts = [bool(clause.accepts >> (8 * number) & 0x80) for number in range(len(given_evidence.all))]
        assert [judge(fspa, trace).accepted for trace in given_evidence.all] == accepts, clause.text
        assert all(accepts[: len(given_evidence.traces)])


def test_every_template_has_an_instance() -> None:
    kinds = set()
    for rule in (answers(5, 10), once_in_time(5, 10), counted(3), held(15, 20), stays(30, 40)):
        kinds |= {clause.kind for clause in timed_clauses(timed_evidence(rule, 1))}
    assert kinds == set(TIMED)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("rule", "expected"),
    [
        (answers(1, 20), {"keep a implies eventually within 2.5 s b"}),
        (answers(10, 20), {"keep a implies always for 0.8 s not b"}),
        # The longest delay in the traces may be one step shorter than the longest possible one.
        (once_in_time(5, 10), {"reach a then within 1 s b", "reach a then within 1.2 s b"}),
        (counted(3), {"keep times(a) <= 3"}),
        (held(10, 20), {"keep begins a implies always for 0.8 s a"}),
        (held(15, 20), {"keep time_holding(a) <= 2 s"}),
        (stays(30, 40), {"reach time_holding(a) >= 2.5 s"}),
    ],
)
def test_a_hidden_rule_is_found(rule: Rule, expected: set[str], seed: int) -> None:
    assert expected.intersection(texts(timed_evidence(rule, seed)))


@pytest.mark.parametrize("rule", [at_random, in_order])
def test_chance_is_no_rule(rule: Rule) -> None:
    assert [text for seed in range(20) for text in texts(timed_evidence(rule, seed))] == []


def test_the_work_is_limited() -> None:
    evidence = timed_evidence(answers(1, 20), 1)
    assert not any("eventually" in clause.text for clause in timed_clauses(evidence, work=100))
    search = SpecSearch(evidence, MiningOptions())
    with patch.dict(WORK, {"mined times": 100}):
        limited = SpecSearch(evidence, MiningOptions())
    list(search.run())
    list(limited.run())
    assert search.omissions() == []
    assert limited.omissions() == ["times between atoms are tried only for some pairs of atoms"]


def test_few_traces_show_no_rule() -> None:
    assert texts(timed_evidence(once_in_time(5, 10), 1, traces=3)) == []


def test_recorded_counterexamples_show_that_a_bound_is_real() -> None:
    # Ten delays from 1 to 20 steps are no evidence by themselves.
    good, bad = (
        tuple(
            LabelledTrace(f"{name} {delay}", (frozenset("a"), *[frozenset[str]()] * (delay - 1), frozenset("b")))
            for delay in delays
        )
        for name, delays in (("good", range(1, 21, 2)), ("bad", range(30, 50, 2)))
    )
    assert "keep a implies eventually within 20 steps b" in texts(Evidence(good, bad))
    assert not any("eventually" in text for text in texts(Evidence(good, bad, made_up=True)))


def test_times_that_follow_from_others_are_left_out() -> None:
    def rule(random: Random, length: int) -> Tracks:
        """Each b of an answer is followed by a c after one to five steps."""
        tracks = answers(1, 10)(random, length)
        # Each c comes one to five steps after a b, and each d is a b.
        tracks["c"] = [False] * length
        for place, holds in enumerate(tracks["b"]):
            if holds and place + 5 < length:
                tracks["c"][place + random.randint(1, 5)] = True
            elif holds:
                tracks["b"][place] = False
                tracks["a"][place - 10 : place] = [False] * 10
        return tracks

    found = [text for text in texts(timed_evidence(rule, 1)) if "eventually" in text]
    assert found == ["keep b implies eventually within 0.5 s c", "keep a implies eventually within 1.2 s b"]


def test_the_best_proposal_has_the_deadline_and_each_proposal_accepts_all_traces() -> None:
    evidence = timed_evidence(answers(1, 20), 1)
    search = SpecSearch(evidence, MiningOptions())
    list(search.run())
    words = vocabulary_of_library(SourceFile("game.tltl", library(evidence)), evidence.atoms(), ResolveOptions())
    proposals = confirm(search.ranking(), evidence, words, CompileOptions(), 5)
    assert "keep a implies eventually within 2.5 s b" in [clause.text for clause in proposals[0].clauses]
    for proposal in proposals:
        assert proposal.figures.support == 1.0
        kinds = [clause.kind for clause in proposal.clauses if clause.kind in TIMED]
        assert len(kinds) == len(set(kinds))


def test_mined_times_are_in_seconds_and_the_file_compiles(tltlc: Run, inside: Path) -> None:
    evidence = timed_evidence(answers(1, 20), 1)
    atoms = evidence.atoms()
    Path("game.tltl").write_text(library(evidence))
    Path("good").mkdir()
    for number, trace in enumerate(evidence.traces):
        rows = [",".join(atoms)]
        rows += [",".join(str(int(name in letter)) for name in atoms) for letter in trace.letters]
        Path(f"good/{number:02}.csv").write_text("\n".join(rows) + "\n")
    outcome = tltlc("mine", "good", "--predicates", "game.tltl", "-o", "mined.tltl", "--json")
    assert outcome.status == 0
    first = json.loads(outcome.out)["proposals"][0]
    assert "keep a implies eventually within 2.5 s b" in first["clauses"]
    assert first["support"] == 1.0
    assert tltlc("check", "mined.tltl").status == 0
    assert tltlc("test", "mined.tltl").status == 0
    (fspa,) = compile_file("mined.tltl", CompileOptions(specs=("mined_1",)))
    assert fspa.clock_s == CLOCK_S
    assert all(judge(fspa, trace).accepted for trace in evidence.traces)


def test_the_clock_comes_from_the_times_of_the_samples(tltlc: Run, inside: Path) -> None:
    evidence = timed_evidence(answers(1, 20), 1, traces=20)
    atoms = evidence.atoms()
    Path("good").mkdir()
    for number, trace in enumerate(evidence.traces):
        rows = [",".join(["time", *atoms])]
        for step, letter in enumerate(trace.letters):
            rows.append(",".join([f"{step / 60:.3f}", *(str(int(name in letter)) for name in atoms)]))
        Path(f"good/{number:02}.csv").write_text("\n".join(rows) + "\n")
    outcome = tltlc("mine", "good", "-o", "mined.tltl", "--json")
    assert outcome.status == 0
    assert "keep a implies eventually within 0.4 s b" in json.loads(outcome.out)["proposals"][0]["clauses"]
    assert "\nclock 60 Hz\n" in Path("mined.tltl").read_text()
    assert tltlc("test", "mined.tltl").status == 0


@pytest.mark.parametrize(
    ("times", "declaration"),
    [
        ([0, 0.1, 0.2, 0.3], "clock 10 Hz\n"),
        ([7.0, 7.017, 7.033, 7.05], "clock 60 Hz\n"),
        ([0, 2.5, 5, 7.5], "clock 2.5 s\n"),
        ([0, 1, 1.5, 7], ""),
        ([3], ""),
        ([0, float("nan"), 1], ""),
        ([], ""),
    ],
)
def test_a_clock_fits_all_times(times: list[float], declaration: str) -> None:
    rows = ["Time,a", *(f"{time},1" for time in times)]
    objects = [json.dumps({"time": time, "a": True}) for time in times if time == time]
    files = [TraceFile("t.csv", "\n".join(rows).encode())]
    assert clock_declaration(trace_clock(files)) == declaration
    if len(objects) == len(times):
        files = [TraceFile("t.jsonl", "\n".join(objects).encode())]
        assert clock_declaration(trace_clock(files)) == declaration


def test_a_trace_without_times_has_no_clock() -> None:
    timed, untimed = (TraceFile("t.csv", text.encode()) for text in ("time,a\n0,1\n1,1\n", "a\n1\n1\n"))
    assert trace_clock([timed]) == 1.0
    assert trace_clock([timed, untimed]) is None


def test_round_times_leave_room() -> None:
    steps = RoundTimes(None)
    assert [steps.above(number).steps for number in (1, 9, 10, 23, 95)] == [1, 9, 12, 25, 120]
    assert [steps.below(number).steps for number in (1, 9, 10, 23, 95)] == [1, 9, 9, 20, 80]
    seconds = RoundTimes(1 / 60)
    assert [seconds.above(number).text for number in (1, 3, 60, 299)] == ["1 step", "0.05 s", "1.2 s", "6 s"]
    assert [seconds.below(number).text for number in (1, 5, 70, 299)] == ["1 step", "5 steps", "1 s", "4 s"]
    # No round number of seconds is a whole number of these steps.
    assert RoundTimes(0.0169).above(40).text == "50 steps"


@given(st.integers(1, 5_000), st.sampled_from([None, 1 / 60, 1 / 30, 0.1, 0.016, 1.0]))
def test_round_times_are_near(steps: int, clock_s: float | None) -> None:
    times = RoundTimes(clock_s)
    above, below = times.above(steps), times.below(steps)
    assert below.steps <= steps <= above.steps <= max(2 * steps, 3)
    assert 2 * below.steps >= steps


def test_gaps_and_intervals_stay_within_a_trace() -> None:
    assert gaps([(0, 1), (0, 4), (1, 0), (2, 5)], [(0, 1), (0, 3), (1, 7), (2, 5)]) == [(0, 2), (1, 7)]
    assert sorted(intervals([(0, 2), (0, 5), (2, 0)])) == [1, 3, 3]
