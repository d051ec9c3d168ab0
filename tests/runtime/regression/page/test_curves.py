"""The diagrams of progress."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.runtime.gymnasium_games import vault
from tests.runtime.gymnasium_games.vault_episodes import played
from tests.runtime.regression.handmade import changed
from tests.runtime.regression.page import samples
from tltl_runtime.regression.report.page.curves import progress_curves, progress_distribution
from tltlc.core.record import replace


def test_each_recorded_episode_has_a_curve() -> None:
    episodes = {3: samples.cover_and_hide_met()[0], 8: samples.cover_and_hide_failed()[0]}
    root = ElementTree.fromstring(progress_curves(episodes))
    curves = {element.get("data-episode"): element for element in root.iter("polyline")}
    assert [curves[index].get("class") for index in ("3", "8")] == ["curve success", "curve failure"]
    for index, episode in episodes.items():
        points = [tuple(map(float, point.split(","))) for point in curves[str(index)].get("points", "").split()]
        assert points == sorted(points, key=lambda point: (point[0], -point[1]))  # time increases, progress never falls
        heights = {y for _, y in points}
        assert len(heights) == len(set(episode.progress.round(4).tolist()))


@pytest.mark.parametrize("is_timed", [True, False])
def test_the_axis_counts_steps_if_the_game_has_no_clock(is_timed: bool, tmp_path: Path) -> None:
    episode = played(vault.write(tmp_path))
    shown = episode if is_timed else replace(episode, times=np.arange(len(episode.times), dtype=np.float64))
    labels = [element.text for element in ElementTree.fromstring(progress_curves({0: shown})).iter("text")]
    assert labels[-1] == ("time, s" if is_timed else "step")


def test_the_bars_show_the_shares_of_episodes() -> None:
    explained = samples.explained_of(0, samples.navigation()[0])
    failed = [changed(explained, success=False, progress=value) for value in (0.0, 0.58, 1.0)]
    root = ElementTree.fromstring(progress_distribution([*failed, explained], [explained]))
    bars = list(root.iter("rect"))
    assert [element.findtext("title") for element in bars] == [
        "progress 0.0 to 0.1, now: 25% of the episodes",
        "progress 0.5 to 0.6, now: 25% of the episodes",
        "progress 0.9 to 1.0, now: 25% of the episodes",
        "progress 1, the spec is met, now: 25% of the episodes",
        "progress 1, the spec is met, before: 100% of the episodes",
    ]
    (*_, met, before) = bars
    assert (met.get("x"), met.get("width")) == (before.get("x"), before.get("width"))
    assert float(before.get("height", "nan")) == pytest.approx(4 * float(met.get("height", "nan")), abs=0.04)


def test_bars_stand_at_the_labels_of_their_values() -> None:
    explained = samples.explained_of(0, samples.navigation()[0])
    root = ElementTree.fromstring(
        progress_distribution([changed(explained, success=False, progress=0.58), explained], [])
    )
    ticks = {
        element.text: float(element.get("x", "nan"))
        for element in root.iter("text")
        if "tick x" in element.get("class", "")
    }
    (failed, met) = [
        (float(element.get("x", "nan")), float(element.get("width", "nan"))) for element in root.iter("rect")
    ]
    assert ticks["0.5"] < failed[0] and sum(failed) < ticks["0.6"]
    assert met[0] < ticks["1 (met)"] == pytest.approx(met[0] + met[1] / 2, abs=0.01)
    shares = [element.text for element in root.iter("text") if "tick y" in element.get("class", "")]
    assert shares == ["0%", "25%", "50%", "75%", "100%"]


def test_without_a_baseline_only_current_shares_are_drawn() -> None:
    explained = samples.explained_of(0, samples.navigation()[0])
    root = ElementTree.fromstring(progress_distribution([explained], []))
    assert [element.get("class") for element in root.iter("rect")] == ["share now"]
