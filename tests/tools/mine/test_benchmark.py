"""Parts of the benchmark: the competing learners, the generated evidence, and the report."""

from __future__ import annotations

import pytest

from benchmarks import mine
from benchmarks.mine_peers import enumerate_formulas, has_scarlet, scarlet
from benchmarks.mine_traces import PlantedSpec, evidence, paper_specs, random_spec
from tests.tools.mine.conftest import vocabulary
from tests.waiting import HANG_S
from tltlc.automaton.compare import are_equivalent
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.pipeline import compile_source
from tltlc.tools.mine.confirm import judge
from tltlc.tools.mine.evidence import Evidence

SHORT = PlantedSpec("short", ("reach p0 then p1",), dict.fromkeys(("p0", "p1", "p2"), 0.2))


def learned(formula: str, spec: PlantedSpec) -> Fspa:
    text = vocabulary(tuple(spec.probabilities)).library.text + f"spec found = {formula}\n"
    return compile_source(SourceFile("found.tltl", text)).automata[0]


def separates(fspa: Fspa, given_evidence: Evidence) -> bool:
    return all(judge(fspa, trace).accepted for trace in given_evidence.traces) and not any(
        judge(fspa, trace).accepted for trace in given_evidence.counterexamples
    )


@pytest.mark.parametrize(
    "clauses", [("reach p0",), ("keep not p0",), ("require p0 until p1",), ("require X p1",), ("reach p0 and p1",)]
)
def test_enumeration_finds_a_formula_that_separates_the_traces(clauses: tuple[str, ...]) -> None:
    spec = PlantedSpec("tiny", clauses, SHORT.probabilities)
    given_evidence = evidence(spec, 20, 40, seed=1)
    result = enumerate_formulas(given_evidence, timeout_s=HANG_S)
    assert result.formula is not None
    assert separates(learned(result.formula, spec), given_evidence)


def test_enumeration_stops_at_the_timeout() -> None:
    result = enumerate_formulas(evidence(random_spec(0), 20, 40, seed=1), timeout_s=0.0)
    # The clock is checked after every 64 formulas.
    assert (result.formula, result.tried) == (None, 64)


@pytest.mark.skipif(not has_scarlet(), reason="Scarlet is not installed")
def test_the_translated_formula_of_scarlet_separates_the_traces() -> None:
    given_evidence = evidence(SHORT, 20, 40, seed=1)
    result = scarlet(given_evidence, timeout_s=HANG_S)
    assert result.formula is not None
    assert separates(learned(result.formula, SHORT), given_evidence)


@pytest.mark.parametrize("spec", [*paper_specs(), *map(random_spec, range(10))], ids=lambda spec: spec.name)
def test_the_planted_spec_separates_the_generated_evidence(spec: PlantedSpec) -> None:
    given_evidence = evidence(spec, 6, 8, seed=2)
    assert separates(spec.automaton(), given_evidence)
    assert given_evidence == evidence(spec, 6, 8, seed=2)
    noisy = evidence(spec, 6, 8, seed=2, noise=0.5)
    assert sum(not judge(spec.automaton(), trace).accepted for trace in noisy.traces) == 3


def test_two_random_specs_are_not_equivalent() -> None:
    automata = [random_spec(number).automaton() for number in range(0, 20, 10)]
    assert not are_equivalent(*automata)


def test_the_report_has_a_row_and_a_summary_of_the_records() -> None:
    ours = {"seconds": 0.1, "rank": 1, "tried": 100}
    records = {
        name: {
            "clauses": list(spec.clauses),
            "limit_s": 5.0,
            "ours": ours,
            "noisy": {**ours, "rank": None},
            "enumeration": {"seconds": 5.0, "formula": None, "equal": False, "tried": 9},
        }
        for name, spec in mine.SPECS.items()
    }
    text = mine.section(records)
    assert f"ours at rank 1 {len(mine.SPECS)} of {len(mine.SPECS)}; with noise 0 of {len(mine.SPECS)}" in text
    assert "| 0.10 | 1 | – | > 5.0 | – |" in text
    assert "Both are stopped after 5 s." in text
    rows = list(mine.goals(records))
    assert [row[2] for row in rows] == ["met", "met"]
    assert "50 times" in rows[1][1]
    assert mine.section({}) == ""
    assert list(mine.goals({})) == []
