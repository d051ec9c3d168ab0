"""The diagrams of progress."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from tests.runtime.regression.page import samples
from tltl_runtime.regression.report.page.curves import progress_curves, progress_distribution
from tltlc.core.record import replace


def test_a_curve_for_each_recorded_episode() -> None:
    episodes = {3: samples.cover_and_hide_met()[0], 8: samples.cover_and_hide_failed()[0]}
    root = ElementTree.fromstring(progress_curves(episodes))
    curves = {each.get("data-episode"): each for each in root.iter("polyline")}
    assert [curves[index].get("class") for index in ("3", "8")] == ["curve success", "curve failure"]
    for index, episode in episodes.items():
        points = [tuple(map(float, point.split(","))) for point in curves[str(index)].get("points", "").split()]
        assert points == sorted(points, key=lambda point: (point[0], -point[1]))  # time goes on, progress never falls
        heights = {y for _, y in points}
        assert len(heights) == len(set(episode.progress.round(4).tolist()))


def test_shares_add_up() -> None:
    known = samples.account_of(0, samples.navigation()[0])
    failed = [replace(known, success=False, progress=value) for value in (0.0, 0.58, 1.0)]
    root = ElementTree.fromstring(progress_distribution([*failed, known], [known]))
    bars = list(root.iter("rect"))
    assert [each.findtext("title") for each in bars] == [
        "progress 0.0 to 0.1, now: 25% of the episodes",
        "progress 0.5 to 0.6, now: 25% of the episodes",
        "progress 0.9 to 1.0, now: 25% of the episodes",
        "progress 1, the spec is met, now: 25% of the episodes",
        "progress 1, the spec is met, before: 100% of the episodes",
    ]
    (*_, met, before) = bars
    assert (met.get("x"), met.get("width")) == (before.get("x"), before.get("width"))
    assert float(before.get("height", "nan")) == pytest.approx(4 * float(met.get("height", "nan")), abs=0.04)


def test_bars_stand_where_their_values_are_written() -> None:
    known = samples.account_of(0, samples.navigation()[0])
    root = ElementTree.fromstring(progress_distribution([replace(known, success=False, progress=0.58), known], []))
    ticks = {each.text: float(each.get("x", "nan")) for each in root.iter("text") if "tick x" in each.get("class", "")}
    (failed, met) = [(float(each.get("x", "nan")), float(each.get("width", "nan"))) for each in root.iter("rect")]
    assert ticks["0.5"] < failed[0] and sum(failed) < ticks["0.6"]
    assert met[0] < ticks["1 (met)"] == pytest.approx(met[0] + met[1] / 2, abs=0.01)
    shares = [each.text for each in root.iter("text") if "tick y" in each.get("class", "")]
    assert shares == ["0%", "25%", "50%", "75%", "100%"]


def test_no_baseline_is_no_fault() -> None:
    known = samples.account_of(0, samples.navigation()[0])
    root = ElementTree.fromstring(progress_distribution([known], []))
    assert [each.get("class") for each in root.iter("rect")] == ["share now"]
