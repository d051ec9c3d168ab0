"""Counterexamples that are generated from traces."""

from __future__ import annotations

from hypothesis import given

from tests.tools.mine.conftest import evidences
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.mutants import with_mutants


@given(evidences(longest=10))
def test_mutants_are_deterministic_and_differ_from_all_traces(given_evidence: Evidence) -> None:
    with_counterexamples = with_mutants(given_evidence.traces)
    assert with_counterexamples == with_mutants(given_evidence.traces)
    assert with_counterexamples.counterexamples == with_mutants(given_evidence.traces[::-1]).counterexamples
    assert with_counterexamples.made_up
    good = {trace.letters for trace in with_counterexamples.traces}
    bad = [trace.letters for trace in with_counterexamples.counterexamples]
    assert not good.intersection(bad)
    assert len(set(bad)) == len(bad)
    assert all(bad)


def test_a_trace_has_a_mutant_of_each_kind() -> None:
    a, b, kept = frozenset({"a", "k"}), frozenset({"b", "k"}), frozenset({"k"})
    with_counterexamples = with_mutants([LabelledTrace("run", (kept, a, kept, b, kept))])
    mutants = {trace.name: trace.letters for trace in with_counterexamples.counterexamples}
    assert mutants["run, cut short"] == (kept, a, kept)
    assert mutants["run, without a"] == (kept, kept, kept, b, kept)
    assert mutants["run, without b"] == (kept, a, kept, kept, kept)
    broken = mutants["run, with k broken"]
    assert sum("k" not in letter for letter in broken) == 1
    assert any(name.startswith("run, in another order") for name in mutants)
