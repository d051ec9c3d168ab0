"""The simulation of verdicts: its random episodes, their judgement, and the report."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from benchmarks import verdicts, verdicts_report
from benchmarks.store import ROOT, Store
from benchmarks.verdicts import (
    ERROR,
    Plan,
    Play,
    Scenario,
    draw_episodes,
    first_verdict,
    measure_scenario,
    probability_in_suite,
    upper_limit,
)

np = pytest.importorskip("numpy")


@pytest.mark.parametrize(
    ("pairing", "least", "most"), [("identical", 1.0, 1.0), ("half", 0.4, 0.6), ("independent", 0, 0)]
)
def test_the_share_of_equal_episodes_matches_the_pairing(pairing: verdicts.Pairing, least: float, most: float) -> None:
    now, before = draw_episodes(Scenario(Play(0.9), Play(0.9), pairing), np.random.default_rng(1))
    same = [new == old for new, old in zip(now, before, strict=True)]
    assert least <= np.mean(same) <= most


def test_episodes_are_drawn_from_the_scenario() -> None:
    now, before = draw_episodes(Scenario(Play(0.6, 0.5, 0.01), Play(1.0)), np.random.default_rng(1))
    assert all(episode.success and episode.progress == 1.0 for episode in before)
    assert np.mean([episode.success for episode in now]) == pytest.approx(0.6, abs=0.1)
    assert np.mean([episode.reward for episode in now if episode.success]) == pytest.approx(0.5, abs=0.005)
    assert {episode.progress for episode in now if not episode.success} == {0.25, 0.5, 0.75}
    assert np.mean([episode.reward for episode in before]) == pytest.approx(0.79, abs=0.02)


@pytest.mark.parametrize(("rate", "verdict"), [(1.0, "pass"), (0.0, "fail")])
def test_clear_cases_are_judged_early_and_with_certainty(rate: float, verdict: str) -> None:
    now, before = draw_episodes(Scenario(Play(rate), Play(1.0)), np.random.default_rng(1))
    judgement, episodes = first_verdict(now, before, ERROR / 9)
    assert (judgement.verdict, judgement.certain) == (verdict, True)
    assert episodes < 100


def test_a_quick_run_is_resumed_and_reproducible(tmp_path: Path) -> None:
    scenarios = (Scenario(Play(0.99), Play(0.99)), Scenario(Play(0.99, 0.6), Play(0.99)))
    plan = Plan(scenarios=scenarios, trials=6, few=4, sizes=(1, 9))
    store, messages = Store(tmp_path / "results.json"), list[str]()
    for _ in range(2):
        verdicts.measure(store, 0.0, messages.append, plan)
    assert [line.partition(":")[0] for line in messages] == [scenario_.name for scenario_ in scenarios]
    records = store.section(verdicts.SECTION)
    assert [record["trials"] for record in records.values()] == [6, 4]
    for scenario in scenarios:
        assert records[scenario.name] == measure_scenario(scenario, records[scenario.name]["trials"], (1, 9))
    for record in records.values():
        for shares in record["suites"].values():
            assert sum(shares[verdict] for verdict in ("pass", "review", "fail")) == pytest.approx(1.0, abs=1e-4)
    text = verdicts_report.section(records)
    assert "| 0.99 | independent | 6 | 9 |" in text
    assert "| reward 0.79 to 0.6, ± 0.05 | 4 | 1 |" in text


def test_a_suite_shows_an_event_if_any_of_its_cases_does() -> None:
    assert probability_in_suite(0.01, 1) == pytest.approx(0.01)
    assert probability_in_suite(0.5, 2) == pytest.approx(0.75)
    assert probability_in_suite(0.0, 30) == 0.0


def test_the_upper_limit_is_a_one_sided_95_percent_bound() -> None:
    # The rule of three, and its exact form.
    assert upper_limit(0.0, 4000) == pytest.approx(1 - 0.05 ** (1 / 4000)) == pytest.approx(3 / 4000, rel=0.01)
    assert upper_limit(1.0, 10) == 1.0
    seen = np.random.default_rng(3).binomial(500, upper_limit(0.02, 500), 4000) <= 10
    assert np.mean(seen) == pytest.approx(0.05, abs=0.01)


def test_a_change_below_its_threshold_is_slight() -> None:
    assert Scenario(Play(0.98, 0.745), Play(0.98, 0.79)).is_slight
    assert not Scenario(Play(0.98, 0.73), Play(0.98, 0.79)).is_slight
    assert not Scenario(Play(0.98), Play(0.98)).is_slight
    assert not Scenario(Play(0.9), Play(0.98)).is_slight
    rare = {scenario.name for scenario in Plan().scenarios if scenario.is_rare}
    assert {"0.849 identical", "reward 0.79 to 0.75, ± 0.05", "0.97 half"} < rare
    assert not {"0.95 half", "reward 0.74 to 0.65, ± 0.05", "0.8 identical"} & rare


def test_false_alarms_and_misses_are_goals() -> None:
    good = {"pass": 1.0, "review": 0.0, "fail": 0.0, "certain_change": 0.0}
    alarm = {"pass": 0.99, "review": 0.01, "fail": 0.0, "certain_change": 0.01}

    def record(rate: float, shares: dict[str, float], trials: int = 100_000, slight: bool = False) -> dict[str, object]:
        suites = {"1": {**shares, "pass": min(1.0, shares["pass"] + 0.001)}, "9": shares}
        return {"changed": slight, "slight": slight, "rates": [rate, rate], "trials": trials, "suites": suites}

    records = {
        "0.98 half": record(0.98, alarm),
        "0.849 identical": record(0.849, {**alarm, "pass": 0.001}),
        "reward": record(0.98, alarm, slight=True),
    }
    alarms, misses, slight = verdicts_report.goals(records)
    assert alarms[1:] == ("most 9.1% (8.6% were seen), in suites of 9 cases of 0.98 half", "**missed**")
    assert misses[1:] == ("most 1.1% (0.9% were seen), in suites of 9 cases of 0.849 identical", "met")
    assert slight[1:] == ("most 9.1% (8.6% were seen), in suites of 9 cases of reward", "**missed**")
    # A rate of zero in a few trials does not meet the goal.
    for trials, verdict in ((4000, "met"), (100, "**missed**")):
        ((_, figure, result),) = verdicts_report.goals({"1 half": record(1.0, good, trials)})
        assert "(0.0% were seen)" in figure and result == verdict
    earlier = {"changed": False, "rates": [1.0, 1.0], "suites": {"1": good}}
    assert list(verdicts_report.goals({"1 half": earlier})) == [] == list(verdicts_report.goals({}))
    assert verdicts_report.section({"1 half": earlier}) == ""


def test_the_documentation_has_the_measured_rates_of_false_alarms() -> None:
    """Each row of the table shows the worst of its scenarios."""
    rows = {
        "99 % or more": [
            *(f"{rate} {pairing}" for rate in ("1", "0.99") for pairing in ("identical", "half", "independent")),
            *("0.98 identical", "0.98 half"),
        ],
        "98 %, all": ["0.98 independent"],
        "97 %, half": ["0.97 half"],
        "97 %, none": ["0.97 identical"],
        "97 %, all": ["0.97 independent"],
        "95 %": ["0.95 identical", "0.95 half", "0.95 independent"],
    }
    records = Store().section(verdicts.SECTION)
    lines = (ROOT / "docs" / "regression.md").read_text(encoding="utf-8").splitlines()
    for begin, names in rows.items():
        (line,) = (candidate for candidate in lines if candidate.startswith(f"| {begin}"))
        for cell, size in zip(line.split("|")[2:4], (9, 30), strict=True):
            alarms = [1.0 - records[name]["suites"][str(size)]["pass"] for name in names]
            most = [
                probability_in_suite(upper_limit(alarm, records[name]["trials"]), size)
                for alarm, name in zip(alarms, names, strict=True)
            ]
            *seen, limit = (float(number) / 100 for number in re.findall(r"[\d.]+", cell))
            digits = 3 if "." in cell else 2
            ends = {round(probability_in_suite(alarm, size), digits) for alarm in (min(alarms), max(alarms))}
            assert {round(rate, digits) for rate in seen} == ends, line
            assert limit == pytest.approx(round(max(most), digits)), line
