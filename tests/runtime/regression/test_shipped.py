"""The shipped suite: its baseline matches the shipped levels and policies, and its verdicts are as designed."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tltl_runtime.game.level_name import Variant
from tltl_runtime.policies.shipped import shipped_policies
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.suite.suite import SHIPPED, Case, read_suite
from tltl_runtime.regression.suite_run import regress
from tltl_runtime.regression.verdict.baseline import read_baseline, reference_of
from tltl_runtime.regression.verdict.play import play_episodes, prepare_case
from tltl_runtime.stealth.levels.file import variants
from tltl_runtime.support.record_json import to_json
from tltlc.core.record import replace

SUITE = read_suite(SHIPPED)


def test_the_suite_has_all_variants_of_the_levels_with_policies() -> None:
    assert {case.name for case in SUITE.cases} == {
        f"{level}:{variant}" for level in shipped_policies() for variant in variants(level)
    }


@pytest.mark.parametrize("case", SUITE.cases, ids=lambda case: case.name)
def test_the_baseline_matches_the_policy_and_the_spec(case: Case) -> None:
    played = prepare_case(case, SUITE.seed, Variant(case.reference)).played
    reference = reference_of(read_baseline(SUITE.baseline), played, SUITE)
    assert reference.played.level_hash == played.level_hash, "record it again"
    assert len(reference.episodes) == case.episodes
    passed = sum(explained.summary.success for explained in reference.episodes)
    assert passed / case.episodes >= 0.98


def test_an_episode_of_the_baseline_can_be_reproduced() -> None:
    case = replace(SUITE.cases[0], episodes=1)
    ready_case = prepare_case(case, SUITE.seed)
    (recorded,) = play_episodes(ready_case, 1)
    reference = reference_of(read_baseline(SUITE.baseline), ready_case.played, SUITE)
    if reference.played.versions != ready_case.played.versions:
        pytest.skip("the baseline was recorded with other versions")
    assert to_json(recorded.explained) == to_json(reference.episodes[0])


@pytest.fixture(name="judged", scope="module")
def _judged(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, CaseReport]:
    """The reports on all cases, by name; one process per core plays them."""
    references = read_baseline(SUITE.baseline)
    running = regress(SUITE, SUITE.cases, references, tmp_path_factory.mktemp("judged"), 0, lambda *_: None)
    return {done.report.name: done.report for done in running}


@pytest.mark.slow
def test_the_unchanged_levels_pass(judged: Mapping[str, CaseReport]) -> None:
    assert set(judged) == {case.name for case in SUITE.cases}
    for level in shipped_policies():
        report = judged[f"{level}:v0"]
        assert report.verdict == "pass", report.reasons


@pytest.mark.slow
def test_a_closed_corridor_is_named(judged: Mapping[str, CaseReport]) -> None:
    report = judged["navigation:v2"]
    assert report.verdict == "fail"
    assert any(
        "nobody can reach `s2`" in reason and "ends at `corridor_block_2`" in reason for reason in report.reasons
    )
    stuck = "runs out of time in the corridor, mostly at `corridor_block_2`"
    ends = [finding for finding in report.explanation if finding.text.startswith(stuck)]
    assert [len(finding.episodes) for finding in ends] == [len(report.episodes)]


@pytest.mark.slow
def test_a_corridor_with_more_bends_does_not_fail(judged: Mapping[str, CaseReport]) -> None:
    assert judged["navigation:v1"].verdict != "fail"


@pytest.mark.slow
@pytest.mark.parametrize("level", ["cover_and_hide", "branching"])
def test_a_level_whose_guard_looks_into_covers_does_not_pass(judged: Mapping[str, CaseReport], level: str) -> None:
    report = judged[f"{level}:v2"]
    assert report.verdict != "pass"
    (death, *_) = [finding.text for finding in report.explanation if finding.text.startswith("dies ")]
    assert " by `guard" in death and ", breaking `keep alive`," in death
