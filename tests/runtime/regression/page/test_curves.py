"""The diagrams of progress."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from tests.runtime.regression.page import samples
from tltl_runtime.regression.page.curves import progress_curves, progress_distribution
from tltlc.record import replace


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
    now = [replace(known, progress=value) for value in (0.0, 0.3, 0.3, 1.0)]
    root = ElementTree.fromstring(progress_distribution(now, now[:1]))
    titles = [each.findtext("title") or "" for each in root.iter("rect")]
    assert titles == [
        "progress 0.0 to 0.1, now: 25% of the episodes",
        "progress 0.3 to 0.4, now: 50% of the episodes",
        "progress 0.9 to 1.0, now: 25% of the episodes",
        "progress 0.0 to 0.1, before: 100% of the episodes",
    ]
    heights = [float(each.get("height", "nan")) for each in root.iter("rect")]
    assert heights[1] == pytest.approx(2 * heights[0], abs=0.02) and heights[3] == max(heights)


def test_no_baseline_is_no_fault() -> None:
    known = samples.account_of(0, samples.navigation()[0])
    root = ElementTree.fromstring(progress_distribution([known], []))
    assert [each.get("class") for each in root.iter("rect")] == ["share now"]
