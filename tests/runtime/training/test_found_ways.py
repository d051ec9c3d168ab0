"""The ways of a search that was stopped: they are kept, and the search goes on with them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.runtime.training.runs import STEALTH_ACTIONS, checkpoint_of, run_in
from tltl_runtime.cli.support.training_progress import stopped_line
from tltl_runtime.cli.train import _start_lines
from tltl_runtime.training.exploration.search import FoundWays, SearchProgress, SuccessfulEpisode
from tltl_runtime.training.files.found_ways import WaysFile, remove_ways
from tltl_runtime.training.files.run_file import CHECKPOINT, WAYS, TrainingRun, write_run
from tltl_runtime.training.run.train import train
from tltlc.core.record import replace

NEAR = "import spatial\nentity s1\nspec near_s1 { level cover_and_hide  limit 300 steps  reach near(s1) }"
CHANCE = "import stealth\nspec chance { level cover_and_hide  limit 2 steps  avoid sneaking }"
SEARCH = {"exploration__ways": 4, "exploration__steps": 20_000, "stop__steps": 64}
WAY = SuccessfulEpisode(5, [[1, 2, 0, 1, 0], [0, 0, 1, 0, 0]], 1)
PROGRESS = SearchProgress(640, 20, 1.5, 12, (2,), complete=False)


def stopped_search(folder: Path, count: int) -> TrainingRun:
    """Return a training whose search was stopped as soon as it had found ``count`` ways."""
    run = run_in(folder, NEAR, **SEARCH)

    def stop(progress: SearchProgress) -> None:
        if len(progress.lengths) >= count:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        list(train(run, on_search=stop))
    assert not (folder / CHECKPOINT).exists()
    return run


@pytest.mark.slow
def test_a_stopped_search_goes_on_with_its_ways(tmp_path: Path) -> None:
    run = stopped_search(tmp_path / "run", 2)
    kept = WaysFile(run).read(STEALTH_ACTIONS)
    assert kept is not None and len(kept.demonstrations) >= 2
    searches: list[SearchProgress] = []
    (report,) = train(run, resume=True, on_search=searches.append)
    first, last = searches[0], searches[-1]
    assert len(first.lengths) >= 2 and first.steps > kept.progress.steps and first.seconds > kept.progress.seconds
    assert len(last.lengths) >= 4 and last.complete and report.searched == last
    seeds = checkpoint_of(run).processes[0]["way_seeds"].tolist()
    assert {way.seed for way in kept.demonstrations} <= {*seeds}
    assert not (run.folder / WAYS).exists(), "the checkpoint has the ways"


@pytest.mark.slow
def test_a_search_that_has_found_enough_ways_does_not_go_on(tmp_path: Path) -> None:
    run = stopped_search(tmp_path / "run", 4)
    searches: list[SearchProgress] = []
    (report,) = train(run, resume=True, on_search=searches.append)
    file = WaysFile(run)
    assert [progress.complete for progress in searches] == [True]
    assert report.searched is not None and len(report.searched.lengths) >= 4 and file.read() is None


@pytest.mark.slow
def test_a_search_at_a_standstill_goes_on_with_its_ways(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.training.ppo.recent_episodes._BETWEEN", (0.0, 2.0))
    monkeypatch.setattr("tltl_runtime.training.ppo.recent_episodes._RISE", 2.0)
    monkeypatch.setattr("tltl_runtime.training.ppo.recent_episodes._STANDSTILL_STEPS", 256)
    run = run_in(tmp_path / "run", CHANCE, exploration__ways=4, exploration__steps=2000, stop__steps=640)
    ended: list[SearchProgress] = []

    def stop(progress: SearchProgress) -> None:
        if ended and progress.lengths:
            raise KeyboardInterrupt
        if progress.complete:
            ended.append(progress)

    with pytest.raises(KeyboardInterrupt):
        list(train(run, on_search=stop))
    (first,) = ended
    stored = WaysFile(run, steps_before=first.steps).read(STEALTH_ACTIONS)
    assert stored is not None and stored.demonstrations
    searches: list[SearchProgress] = []
    reports = train(run, resume=True, on_search=searches.append)
    while not searches:
        next(reports)
    reports.close()
    assert searches[0].steps > stored.progress.steps and searches[0].seconds > stored.progress.seconds
    assert len(searches[0].lengths) >= len(stored.demonstrations)


@pytest.fixture
def run(tmp_path: Path) -> TrainingRun:
    run = run_in(tmp_path / "run", NEAR, **SEARCH)
    WaysFile(run).write(FoundWays(PROGRESS, (WAY,)))
    return run


def test_the_file_gives_back_what_was_stored(run: TrainingRun) -> None:
    kept = WaysFile(run).read(STEALTH_ACTIONS)
    assert kept == FoundWays(PROGRESS, (WAY,))


def test_another_training_or_search_has_no_use_for_the_ways(run: TrainingRun) -> None:
    other_spec = replace(run_in(run.folder, NEAR.replace("300", "301"), **SEARCH), folder=run.folder)
    others = [replace(run, seed=4), replace(run, variant=replace(run.variant, name="v1")), other_spec]
    assert [WaysFile(other).read() for other in others] == [None] * 3
    assert WaysFile(run, rank=1).read() is None and WaysFile(run, steps_before=640).read() is None


def test_lines_say_that_the_ways_are_kept(run: TrainingRun) -> None:
    write_run(run)
    assert stopped_line(run, "AGAIN") == (
        "stopped during the search, which will go on with the way that it has found; to go on: AGAIN"
    )
    *_, line = _start_lines(run, resume=True)
    assert line == "it was stopped during its search, which goes on with the way that it has found"
    WaysFile(run).write(FoundWays(PROGRESS, (WAY, replace(WAY, seed=6))))
    *_, line = _start_lines(run, resume=True)
    assert line.endswith(" with the 2 ways that it has found")
    start_again = "stopped during the search, which will start again; to go on: AGAIN"
    assert stopped_line(replace(run, level="missing.toml"), "AGAIN") == start_again
    remove_ways(run.folder)
    assert stopped_line(run, "AGAIN") == start_again


@pytest.mark.parametrize(
    "change",
    [
        lambda content: content.pop("ways"),
        lambda content: content.update(version=2),
        lambda content: content["ways"][0].update(seed=-1),
        lambda content: content["ways"][0].update(actions=[]),
        lambda content: content["ways"][0].update(actions=[[1, 2, 0, 1]]),
        lambda content: content["ways"][0].update(actions=[[1, 2, 0, 1, 0], [1]]),
        lambda content: content["ways"][0].update(actions=[[1, 2.5, 0, 1, 0]]),
        lambda content: content["ways"][0].update(actions=[[1, 300, 0, 1, 0]]),
    ],
)
def test_a_damaged_file_is_of_no_use(run: TrainingRun, change: Callable[[Any], object]) -> None:
    path = run.folder / WAYS
    content = json.loads(path.read_text(encoding="utf-8"))
    change(content)
    path.write_text(json.dumps(content), encoding="utf-8")
    assert WaysFile(run).read(STEALTH_ACTIONS) is None
    path.write_text("{", encoding="utf-8")
    assert WaysFile(run).read(STEALTH_ACTIONS) is None


def test_a_file_that_is_no_text_is_of_no_use(run: TrainingRun) -> None:
    (run.folder / WAYS).write_bytes(b"\xff\x00")
    assert WaysFile(run).read(STEALTH_ACTIONS) is None
