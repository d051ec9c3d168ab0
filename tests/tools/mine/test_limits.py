"""Traces with thousands of columns: the work is limited, and a warning says what is left out."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from itertools import combinations
from pathlib import Path
from random import Random

import pytest

from tests.interfaces.cli.conftest import Outcome
from tltlc.automaton.work import Work
from tltlc.core.source import SourceFile
from tltlc.io.limits import WORK
from tltlc.resolve.options import ResolveOptions
from tltlc.tools.mine import candidates
from tltlc.tools.mine.bits import Bits
from tltlc.tools.mine.candidates import Candidates
from tltlc.tools.mine.clause import Conjunction, MinedClause
from tltlc.tools.mine.conjunctions import best_candidates
from tltlc.tools.mine.events import MOST_EVENTS, best_events
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.evidence_reader import read_evidence
from tltlc.tools.mine.search import MiningOptions, SpecSearch
from tltlc.tools.mine.sequences import sequences
from tltlc.tools.mine.templates import clauses
from tltlc.tools.mine.trace_letters import TraceFile

Run = Callable[..., Outcome]


def letters(*names: str) -> tuple[frozenset[str], ...]:
    """Return the letters of a trace; each string lists the atoms that hold at a sample."""
    return tuple(frozenset(sample.split()) for sample in names)


def random_trace(columns: int, rows: int, seed: int, steps: tuple[str, ...] = ()) -> tuple[frozenset[str], ...]:
    """Return a trace in which columns hold at random, followed by a sample for each of ``steps``."""
    random = Random(seed)
    names = [f"c{number}" for number in range(columns)]
    samples = [{name for name in names if random.random() < 0.5} for _ in range(rows)]
    return tuple(map(frozenset, samples)) + tuple(frozenset((step,)) for step in steps)


def csv(trace: tuple[frozenset[str], ...], columns: int) -> str:
    names = [f"c{number}" for number in range(columns)]
    rows = [",".join(str(int(name in letter)) for name in names) for letter in trace]
    return "\n".join([",".join(names), *rows]) + "\n"


def random_evidence(columns: int) -> Evidence:
    good, bad = (LabelledTrace(f"t{seed}", random_trace(columns, 10, seed)) for seed in (1, 2))
    return Evidence((good,), (bad,))


@cache
def searched(columns: int) -> tuple[SpecSearch, int]:
    """A finished search over two random traces, and the most candidates that it tried between two points where it
    can stop."""
    search = SpecSearch(random_evidence(columns), MiningOptions())
    previous = largest = 0
    for _ in search.run():
        largest = max(largest, search.tried_count - previous)
        previous = search.tried_count
    return search, largest


@pytest.mark.slow
def test_the_work_does_not_grow_with_the_columns() -> None:
    work = []
    for columns in (1_000, 2_000):
        search, _ = searched(columns)
        work.append(search.tried_count - 2 * columns)
        assert search.ranking()
    pairs = MOST_EVENTS**2
    assert max(work) <= 8 * pairs + WORK["mined sequences"] + 500_000
    assert abs(work[0] - work[1]) < max(work) / 5


def test_the_search_can_be_stopped_every_few_candidates() -> None:
    """Between two points at which the search can stop, it tries few candidates, so ``--time`` is
    precise."""
    _, largest = searched(1_000)
    assert largest <= 20_000


@pytest.mark.slow
def test_the_events_that_separate_best_are_combined() -> None:
    planted = ("key", "door")
    good = [LabelledTrace(f"g{seed}", random_trace(300, 10, seed, planted)) for seed in range(10)]
    bad = [LabelledTrace(f"b{seed}", random_trace(300, 10, 100 + seed, planted[::-1])) for seed in range(10)]
    given_evidence = Evidence(tuple(good), tuple(bad))
    assert set(planted) <= set(best_events(given_evidence, given_evidence.atoms()))
    search = SpecSearch(given_evidence, MiningOptions())
    list(search.run())
    assert [clause.text for clause in search.ranking()[0]] == ["keep door implies once key"]


def test_all_events_are_combined_if_there_are_few() -> None:
    given_evidence = random_evidence(50)
    assert best_events(given_evidence, given_evidence.atoms()) == list(given_evidence.atoms())


def test_sequences_stop_at_the_work_limit() -> None:
    bits = Bits(random_evidence(20))
    full_count = sum(map(len, sequences(bits, tuple(bits.holds), 1, 4)))
    limited_count = sum(map(len, sequences(bits, tuple(bits.holds), 1, 4, work=Work(500))))
    assert 0 < limited_count < full_count


def every_clause(bits: Bits) -> list[MinedClause]:
    backwards = Bits(random_evidence(30), backwards=True)
    return [clause for portion in clauses(bits, backwards, tuple(bits.holds)) for clause in portion]


def test_candidates_that_were_dropped_are_not_among_the_best() -> None:
    bits = Bits(random_evidence(30))
    conjunctions: dict[Conjunction, int] = {(clause,): clause.accepts for clause in every_clause(bits)}
    conjunctions |= {(a, b): a.accepts & b.accepts for a, b in combinations(every_clause(bits)[:60], 2)}
    kept = Candidates(bits)
    for conjunction, accepts in conjunctions.items():
        kept.add(conjunction, accepts)
    assert len(list(kept.items())) < len(conjunctions) / 10
    assert best_candidates(kept.items(), bits) == best_candidates(conjunctions.items(), bits)
    assert not kept.is_cut


def test_the_best_candidates_are_kept_if_there_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(candidates, "_MOST", 2)
    traces = [LabelledTrace(f"t{number}", letters("a", "b")) for number in range(4)]
    bits = Bits(Evidence(tuple(traces), (LabelledTrace("bad", letters("c")),)))
    kept = Candidates(bits)
    for number in range(5):
        accepts = sum(0x80 << 8 * place for place in range(number))
        kept.add((MinedClause("reach", 0, f"reach {number}", 1, accepts, accepts),), accepts)
    assert kept.is_cut
    assert {conjunction[0].text for conjunction, _ in kept.items()} == {"reach 3", "reach 4"}


# --- the command ----------------------------------------------------------------------------------


@pytest.mark.slow
def test_many_columns_are_mined_with_a_warning(tltlc: Run, inside: Path) -> None:
    for name, seed in (("good.csv", 1), ("bad.csv", 2)):
        (inside / name).write_text(csv(random_trace(300, 10, seed), 300))
    outcome = tltlc("mine", "good.csv", "--against", "bad.csv", "--json")
    assert outcome.status == 0
    document = json.loads(outcome.out)
    assert document["proposals"]
    assert document["complete"] is False
    assert "warning[TLT0624]: only 244 atoms are related to each other" in outcome.err


def test_few_columns_are_mined_without_a_warning(tltlc: Run, inside: Path) -> None:
    for name, seed in (("good.csv", 1), ("bad.csv", 2)):
        (inside / name).write_text(csv(random_trace(12, 10, seed), 12))
    outcome = tltlc("mine", "good.csv", "--against", "bad.csv", "--json", "--max-length", "3")
    assert json.loads(outcome.out)["complete"] is True
    assert "TLT0624" not in outcome.err


def test_the_first_columns_are_read_if_there_are_too_many() -> None:
    columns = WORK["mined columns"] + 7
    files = [TraceFile(f"t{seed}", csv(random_trace(columns, 2, seed), columns).encode()) for seed in (1, 2)]
    vocabulary, evidence, _ = read_evidence(files[:1], files[1:], None, ResolveOptions((), {}))
    assert vocabulary.unread_count == 7
    assert not vocabulary.left_out
    assert len(vocabulary.reader.atoms) == WORK["mined columns"]
    assert f"c{WORK['mined columns']}" not in evidence.atoms()


def test_the_first_instances_are_read_if_a_predicate_has_too_many() -> None:
    library = SourceFile("lib.tltl", "signal at(x: entity, y: entity): bool\n")
    data = "".join(f'"at(e{a}, e{a + 1})",' for a in range(49)) + "time\n" + "0," * 49 + "1\n"
    file = TraceFile("t", data.encode())
    vocabulary, _, _ = read_evidence([file], [], library, ResolveOptions((), {}))
    assert vocabulary.unread_count == 50 * 50 - WORK["mined instances"]
