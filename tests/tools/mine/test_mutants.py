from __future__ import annotations

from hypothesis import given

from tests.tools.mine.conftest import evidences
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.mutants import with_mutants


@given(evidences(longest=10))
def test_mutants_are_deterministic_and_differ_from_all_traces(given_: Evidence) -> None:
    made = with_mutants(given_.traces)
    assert made == with_mutants(given_.traces)
    assert made.counterexamples == with_mutants(given_.traces[::-1]).counterexamples
    assert made.made_up
    good = {trace.letters for trace in made.traces}
    bad = [trace.letters for trace in made.counterexamples]
    assert not good.intersection(bad)
    assert len(set(bad)) == len(bad)
    assert all(bad)


def test_every_kind_of_mutant_is_made() -> None:
    a, b, kept = frozenset({"a", "k"}), frozenset({"b", "k"}), frozenset({"k"})
    made = with_mutants([LabelledTrace("run", (kept, a, kept, b, kept))])
    mutants = {trace.name: trace.letters for trace in made.counterexamples}
    assert mutants["run, cut short"] == (kept, a, kept)
    assert mutants["run, without a"] == (kept, kept, kept, b, kept)
    assert mutants["run, without b"] == (kept, a, kept, kept, kept)
    broken = mutants["run, with k broken"]
    assert sum("k" not in letter for letter in broken) == 1
    assert any(name.startswith("run, in another order") for name in mutants)
