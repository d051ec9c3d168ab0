"""The suite that comes with the package has its baseline, of the policies and the specs that come with it, too."""

from __future__ import annotations

import pytest

from tltl_runtime.record_json import to_json
from tltl_runtime.regression.baseline import baseline_path, read_baseline, reference_of
from tltl_runtime.regression.play import episodes, ready
from tltl_runtime.regression.suite import SHIPPED, Case, read_suite
from tltl_runtime.stealth.levels.file import level_names, variants
from tltlc.record import replace

SUITE = read_suite(SHIPPED)


def test_it_has_all_levels_in_all_variants() -> None:
    assert {case.name for case in SUITE.cases} == {
        f"{level}:{variant}" for level in level_names() for variant in variants(level)
    }


@pytest.mark.parametrize("case", SUITE.cases, ids=lambda case: case.name)
def test_its_baseline_is_of_the_policy_and_the_spec(case: Case) -> None:
    played = ready(case, SUITE.seed, case.reference).played
    reference = reference_of(read_baseline(baseline_path(SHIPPED)), played, SHIPPED)
    assert reference.played.level_hash == played.level_hash, "record it again"
    assert len(reference.accounts) == case.episodes
    passed = sum(each.success for each in reference.accounts)
    assert passed / case.episodes >= 0.98


def test_an_episode_of_the_baseline_is_played_again() -> None:
    case = replace(SUITE.cases[0], episodes=1)
    made = ready(case, SUITE.seed)
    (again,) = episodes(made, 1)
    reference = reference_of(read_baseline(baseline_path(SHIPPED)), made.played, SHIPPED)
    if reference.played.versions != made.played.versions:
        pytest.skip("the baseline was recorded with other versions")
    assert to_json(again.account) == to_json(reference.accounts[0])
