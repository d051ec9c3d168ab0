"""Running, interrupting and resuming trainings."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import torch

from tests.runtime.training.runs import checkpoint_of, run_in
from tests.runtime.training.test_settings import OTHER, compare
from tltl_runtime.policies.file import read_policy
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.capabilities.vocabulary import params
from tltl_runtime.stealth.levels.file import level_path, load_level
from tltl_runtime.support.record_json import from_json, to_json
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.files.checkpoint import Checkpoint, write_checkpoint
from tltl_runtime.training.files.metrics import METRICS, read_metrics
from tltl_runtime.training.files.record import write_record
from tltl_runtime.training.files.report import Confirmation, TrainingReport
from tltl_runtime.training.files.run_file import (
    CHECKPOINT,
    CURVE,
    MAY_CHANGE,
    POLICY,
    RECORD,
    RUN,
    TrainingRun,
    identity,
    leaves,
    read_run,
    write_run,
)
from tltl_runtime.training.files.settings import TrainingSettings, read_settings
from tltl_runtime.training.ppo.scheduled_weights import penalty_rise
from tltl_runtime.training.run import training_files
from tltl_runtime.training.run.train import train
from tltl_runtime.training.runner import Iteration, Runner
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

SOON = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
"""A spec that every policy meets after eight steps."""
IN_VAIN = "import spatial\nentity exit\nspec vain { level cover_and_hide\n limit 8 steps\n reach near(exit) }\n"
"""A spec that no policy can meet."""
CHANCE = "import stealth\nspec chance { level cover_and_hide\n limit 2 steps\n avoid sneaking }\n"
"""A spec that an untrained agent meets in about one of four episodes."""


def _numbers(reports: list[TrainingReport]) -> list[Any]:
    return [(report.iteration.number, report.iteration.losses, report.steps, report.window) for report in reports]


def _assert_equal_weights(one: TrainingRun, other: TrainingRun) -> None:
    first, second = checkpoint_of(one).algorithm, checkpoint_of(other).algorithm
    for part in ("actor_state_dict", "critic_state_dict"):
        assert first[part].keys() == second[part].keys()
        assert all(torch.equal(first[part][name], second[part][name]) for name in first[part])


def test_a_training_ends_at_its_limit_and_writes_its_files(whole: tuple[TrainingRun, list[TrainingReport]]) -> None:
    run, reports = whole
    assert [(report.iteration.number, report.steps, report.stop) for report in reports] == [
        (1, 64, None),
        (2, 128, None),
        (3, 192, "steps"),
    ]
    assert all(report.checkpointed for report in reports)
    assert {path.name for path in run.folder.iterdir() if not path.name.startswith((".", "events"))} == {
        RUN,
        CHECKPOINT,
        POLICY,
        METRICS,
    }
    policy = read_policy(run.folder / POLICY)
    assert (policy.card.level, policy.card.sensors, policy.card.fspa.name) == (
        "cover_and_hide",
        run.sensors,
        run.fspa.name,
    )


def test_rsl_rl_prints_nothing(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    run = run_in(folder / "quiet", stop__steps=64)
    assert len(list(train(run))) == 1
    assert capfd.readouterr() == ("", "")


def test_equal_runs_and_equal_checkpoints_give_equal_numbers(
    folder: Path, whole: tuple[TrainingRun, list[TrainingReport]]
) -> None:
    run, reports = whole
    again = replace(run, folder=folder / "again")
    assert _numbers(list(train(again))) == _numbers(reports)
    _assert_equal_weights(run, again)
    longer = [replace(finished_run, settings=run_in(folder, stop__steps=320).settings) for finished_run in (run, again)]
    resumed = [list(train(longer_run, resume=True)) for longer_run in longer]
    assert [report.iteration.number for report in resumed[0]] == [4, 5]
    assert _numbers(resumed[0]) == _numbers(resumed[1])
    _assert_equal_weights(*longer)
    assert [line["iteration"] for line in read_metrics(run.folder / METRICS)] == [1, 2, 3, 4, 5]


def test_a_closed_training_resumes_after_its_last_iteration(folder: Path) -> None:
    run = run_in(folder / "left", checkpoint_s=3600.0, threads=1)
    reports = train(run)
    assert not next(reports).checkpointed
    next(reports)
    reports.close()
    assert (checkpoint_of(run).iteration, checkpoint_of(run).steps) == (2, 128)
    # Iterations that a killed process measured after its checkpoint are measured again.
    beyond = {**read_metrics(run.folder / METRICS)[-1], "iteration": 3}
    with (run.folder / METRICS).open("a") as file:
        file.write(json.dumps(beyond) + "\n" + '{"iterat')
    assert [report.iteration.number for report in train(run, resume=True)] == [3]
    assert [line["iteration"] for line in read_metrics(run.folder / METRICS)] == [1, 2, 3]
    # The training is finished: resuming reports its end again.
    (last,) = train(run, resume=True)
    assert (last.iteration.number, last.steps, last.stop) == (3, 192, "steps")


def test_a_checkpoint_is_written_after_the_first_iteration_that_is_due(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = SimpleNamespace(now=100.0)
    monkeypatch.setattr(training_files, "time", SimpleNamespace(perf_counter=lambda: clock.now))
    run = run_in(folder / "due", checkpoint_s=1.0, stop__steps=10**6)
    reports = train(run)
    written = []
    for seconds in (0.0, 0.5, 0.4, 0.2, 0.9, 0.2):
        clock.now += seconds
        report = next(reports)
        written.append(checkpoint_of(run).iteration)
        assert report.checkpointed == (written[-1] == report.iteration.number)
    reports.close()
    assert written == [0, 0, 0, 4, 4, 6]


def test_a_lower_limit_ends_a_training_with_a_policy(folder: Path) -> None:
    run = run_in(folder / "lower", stop__steps=10**6)
    reports = train(run)
    next(reports)
    reports.close()
    assert not (run.folder / POLICY).exists()
    (last,) = train(replace(run, settings=run_in(folder, stop__steps=64).settings), resume=True)
    assert (last.steps, last.stop) == (64, "steps")
    weights, now = read_policy(run.folder / POLICY).weights(), checkpoint_of(run).algorithm["actor_state_dict"]
    assert all(np.array_equal(weights[name], now[name].half().numpy()) for name in now)


def _judged_by(run: TrainingRun, spec: str) -> TrainingRun:
    task = load_task(spec, offered=params(load_level(run.level, run.variant)))
    return replace(run, fspa=task.fspa, params=task.params)


def test_a_training_interrupted_while_it_saves_saves_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(path: Path, checkpoint: Checkpoint) -> None:
        monkeypatch.undo()
        raise KeyboardInterrupt

    reports = train(run := run_in(folder / "broken"))
    next(reports)
    monkeypatch.setattr("tltl_runtime.training.run.training_files.write_checkpoint", interrupt)
    with pytest.raises(KeyboardInterrupt):
        next(reports)
    assert checkpoint_of(run).iteration == 2


@pytest.mark.parametrize("broken", ["run.train.TrainingReport", "files.metrics_writer.Metrics.add"])
def test_no_checkpoint_contains_an_unmeasured_iteration(
    folder: Path, monkeypatch: pytest.MonkeyPatch, broken: str
) -> None:
    def interrupt(*_: object, **__: object) -> None:
        monkeypatch.undo()
        raise KeyboardInterrupt

    reports = train(run := run_in(folder / f"before-{broken}"))
    next(reports)
    monkeypatch.setattr(f"tltl_runtime.training.{broken}", interrupt)
    with pytest.raises(KeyboardInterrupt):
        next(reports)
    assert checkpoint_of(run).iteration == 1
    assert [report.iteration.number for report in train(run, resume=True)] == [2, 3]
    assert [line["iteration"] for line in read_metrics(run.folder / METRICS)] == [1, 2, 3]


@pytest.mark.slow
def test_a_training_continues_until_its_policy_is_confirmed(folder: Path) -> None:
    changes = {"stop__windows": 2, "stop__episodes": 2, "stop__steps": 10**5, "rollout__envs": 8}
    run = _judged_by(run_in(folder / "confirmed", **changes), CHANCE)
    reports = list(train(run))
    refused = [report for report in reports if report.confirmation and not report.confirmation.passed]
    assert refused
    assert all(report.stop is None and report.unbroken == 0 and report.confirmation.met < 4 for report in refused)
    assert [report.confirmation for report in reports if report.stop == "met"] == [Confirmation(4, 4)]
    confirmations = [line["confirmation"] for line in read_metrics(run.folder / METRICS)]
    assert confirmations == [report.confirmation and {"met": report.confirmation.met, "of": 4} for report in reports]


def test_a_policy_is_not_confirmed_on_a_level_that_has_changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    shipped = level_path("cover_and_hide").read_text()
    Path("plan.toml").write_text(shipped)
    changes = {"stop__windows": 2, "stop__episodes": 5, "stop__steps": 10**5}
    run = _judged_by(replace(run_in(Path("my run"), **changes), level="plan.toml"), SOON)
    reports = train(run)
    next(reports)
    Path("plan.toml").write_text(shipped.replace("spread = 0.4", "spread = 0.3"))
    with pytest.raises(TltlError) as caught:
        list(reports)
    compare("TLT0868", caught.value)
    with pytest.raises(TltlError) as caught:
        next(train(run, resume=True))
    compare("TLT0868_resumed", caught.value)
    # A training without a checkpoint does not resume on a changed level either.
    (run.folder / CHECKPOINT).unlink()
    with pytest.raises(TltlError) as caught:
        next(train(run, resume=True))
    compare("TLT0868_resumed", caught.value)
    Path("plan.toml").write_text(shipped)
    assert list(train(run, resume=True))[-1].stop == "met"


def test_a_resumed_training_has_no_record_of_its_end(folder: Path) -> None:
    run = run_in(folder / "longer", stop__steps=64)
    (last,) = train(run)
    write_record(run, last)
    (run.folder / POLICY).write_bytes(b"")
    reports = train(replace(run, settings=run_in(folder).settings), resume=True)
    next(reports)
    assert not (run.folder / RECORD).exists()
    assert not (run.folder / CURVE).exists()
    reports.close()
    (last,) = train(run, resume=True)
    record = write_record(run, last)
    assert read_policy(run.folder / POLICY).card.training == record


@pytest.mark.slow
def test_a_resumed_training_starts_from_its_known_demonstrations(folder: Path) -> None:
    def run_of(name: str, steps: int) -> TrainingRun:
        changes = {"exploration__ways": 2, "exploration__parts": 4, "stop__episodes": 10**5, "stop__steps": steps}
        return _judged_by(run_in(folder / name, **changes), SOON)

    run = run_of("ways", 128)
    first = list(train(run))
    assert first[-1].searched is not None
    assert first[-1].searched.lengths[:2] == (8, 8)
    assert first[-1].replayed > 0
    process = checkpoint_of(run).processes[0]
    assert process["way_lengths"].tolist() == [8] * len(process["way_seeds"])
    shutil.copytree(run.folder, folder / "ways-2")
    resumed = [list(train(run_of(name, 256), resume=True)) for name in ("ways", "ways-2")]
    assert _numbers(resumed[0]) == _numbers(resumed[1])
    assert [report.iteration.number for report in resumed[0]] == [3, 4]
    assert resumed[0][-1].searched == first[-1].searched
    assert resumed[0][-1].replayed == resumed[1][-1].replayed > first[-1].replayed
    assert {*process["way_seeds"].tolist()} <= {*checkpoint_of(run).processes[0]["way_seeds"].tolist()}


def test_the_best_policy_played_the_end_of_its_window(folder: Path) -> None:
    # Every episode on this level that is not longer than a rollout fails; a window is one episode.
    run = run_in(folder / "best", rollout__steps=512, stop__steps=2048, stop__episodes=1)
    reports = train(run)
    report = next(report for report in reports if report.best_pass_rate is not None)
    reports.close()
    assert report.window.count
    checkpoint = checkpoint_of(run)
    assert checkpoint.best is not None
    assert checkpoint.best.score[0] == report.best_pass_rate
    weights = read_policy(run.folder / POLICY).weights()
    best, now = checkpoint.best.actor, checkpoint.algorithm["actor_state_dict"]
    assert all(np.array_equal(weights[name], best[name].half().numpy()) for name in weights)
    assert not all(torch.equal(best[name], now[name]) for name in weights)


def test_a_policy_without_finished_episodes_is_not_the_best(folder: Path) -> None:
    # All episodes fail after eight steps; a rollout has four.
    changes = {"rollout__steps": 4, "stop__steps": 16 * 3, "stop__episodes": 4}
    run = _judged_by(run_in(folder / "none", **changes), IN_VAIN)
    reports = list(train(run))
    assert [len(report.iteration.finished) for report in reports] == [0, 4, 0]
    assert [report.best_steps for report in reports] == [None, 16, 16]


def test_a_run_is_read_as_it_was_written(tmp_path: Path) -> None:
    run = run_in(tmp_path / "run")
    write_run(run)
    assert read_run(run.folder) == run
    assert identity(read_run(run.folder)) == identity(run)


def test_the_identity_depends_on_all_settings_that_may_not_change(folder: Path, tmp_path: Path) -> None:
    run = replace(run_in(folder), settings=read_settings())
    settings, other = dict(leaves(to_json(run.settings))), tmp_path / "other.toml"
    other.write_text(OTHER, encoding="utf-8")
    other_values = dict(leaves(to_json(read_settings(other))))
    assert MAY_CHANGE <= other_values.keys() == settings.keys()
    for name, value in settings.items():
        document: Any = to_json(run.settings)
        table, _, key = name.rpartition(".")
        assert value != other_values[name]
        (document[table] if table else document)[key] = other_values[name]
        changed = replace(run, settings=from_json(TrainingSettings, document, "settings"))
        assert (identity(changed) == identity(run)) == (name in MAY_CHANGE), name


@pytest.fixture
def reporting_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a search report after its first step, so that a limit that has passed interrupts it."""
    monkeypatch.setattr("tltl_runtime.training.exploration.search._REPORT_INTERVAL_S", 0.0)


SEARCH = {"exploration__ways": 10, "exploration__steps": 800}
"""A search that is not finished after its first step, and does not find this many ways."""


@pytest.mark.usefixtures("reporting_at_once")
def test_a_limit_in_minutes_ends_the_search_too(folder: Path) -> None:
    run = run_in(folder / "short", exploration__ways=10, exploration__steps=10**9, stop__minutes=1e-9)
    (report,) = train(run)
    assert report.stop == "minutes"
    assert report.searched is not None
    assert report.searched.steps < 100_000


@pytest.mark.usefixtures("reporting_at_once")
def test_an_interrupted_search_starts_again(folder: Path) -> None:
    run = run_in(folder / "anew", **SEARCH, stop__minutes=1e-9)
    (report,) = train(run)
    assert report.searched is not None
    assert not report.searched.complete
    longer = replace(run, settings=run_in(folder, **SEARCH).settings)
    last = list(train(longer, resume=True))[-1]
    assert last.searched is not None
    assert (last.searched.complete, last.searched.steps, last.stop) == (True, 800 + report.searched.steps, "steps")
    assert last.searched.lengths[: len(report.searched.lengths)] == report.searched.lengths


@pytest.mark.usefixtures("reporting_at_once")
def test_an_interrupted_search_with_a_demonstration_does_not_start_again(folder: Path) -> None:
    run = run_in(folder / "enough", **SEARCH, stop__minutes=1e-9)
    list(train(run))
    checkpoint = checkpoint_of(run)
    assert checkpoint.searched is not None
    searched = replace(checkpoint.searched, lengths=(9,), complete=False)
    longer = replace(run, settings=run_in(folder, **SEARCH).settings)
    write_checkpoint(run.folder / CHECKPOINT, replace(checkpoint, searched=searched, run=identity(longer)))
    assert next(train(longer, resume=True)).searched == searched


@pytest.mark.usefixtures("reporting_at_once")
def test_a_repeated_search_is_in_the_checkpoint(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(_: Runner) -> Iterator[Iteration]:
        raise KeyboardInterrupt

    run = run_in(folder / "found", **SEARCH, stop__minutes=1e-9)
    (first,) = train(run)
    assert first.searched is not None
    monkeypatch.setattr(Runner, "iterations", stopped)
    with pytest.raises(KeyboardInterrupt):
        next(train(replace(run, settings=run_in(folder, **SEARCH).settings), resume=True))
    searched = checkpoint_of(run).searched
    assert searched is not None
    assert (searched.complete, searched.steps) == (True, 800 + first.searched.steps)
    assert searched.seconds > first.searched.seconds


@pytest.mark.slow
def test_a_training_at_a_standstill_searches_again_from_failures(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.training.ppo.recent_episodes._BETWEEN", (0.0, 2.0))
    monkeypatch.setattr("tltl_runtime.training.ppo.recent_episodes._STANDSTILL_STEPS", 256)
    search_reports: list[SearchProgress] = []
    run = run_in(folder / "standstill", CHANCE, exploration__ways=4, exploration__steps=2000, stop__steps=640)
    reports = list(train(run, on_search=search_reports.append))
    searches = [report.searched for report in reports if report.searched]
    assert [report.steps for report in reports] == list(range(64, 641, 64))
    first, last = searches[0], searches[-1]
    finished_searches = [search for search in search_reports if search.complete]
    assert len(finished_searches) > 1, "it was searched again"
    assert last.steps == sum(search.steps for search in finished_searches)
    assert len(last.lengths) == sum(len(search.lengths) for search in finished_searches)
    assert last.steps > first.steps
    assert all(one.replayed <= other.replayed for one, other in pairwise(reports))
    assert checkpoint_of(run).searched == last


@pytest.mark.slow
def test_a_search_at_a_standstill_is_in_the_checkpoint_with_its_time(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tltl_runtime.training.ppo.recent_episodes._BETWEEN", (0.0, 2.0))
    monkeypatch.setattr("tltl_runtime.training.ppo.recent_episodes._STANDSTILL_STEPS", 256)
    changes = {"exploration__ways": 4, "exploration__steps": 2000, "checkpoint_s": 10**6}
    run, search_reports = run_in(folder / "kept", CHANCE, **changes, stop__steps=10**5), list[SearchProgress]()
    reports = train(run, on_search=search_reports.append)
    before = [next(reports) for _ in range(4)][-1]
    first = len(search_reports)
    next(reports)
    # Simulate that the process is killed here.
    monkeypatch.setattr("tltl_runtime.training.run.training_files.TrainingFiles.save", lambda *_: None)
    reports.close()
    checkpoint = checkpoint_of(run)
    assert before.searched is not None and checkpoint.searched is not None
    assert len(search_reports) > first and checkpoint.searched.steps == before.searched.steps + search_reports[-1].steps
    assert checkpoint.seconds >= before.seconds + search_reports[-1].seconds
    assert (checkpoint.iteration, checkpoint.standstill[1]) == (4, 256)


@pytest.mark.parametrize(("schedule", "last"), [("fading", 0.0084), ("fixed", 0.01)])
def test_the_entropy_bonus_fades_as_the_spec_is_met(folder: Path, schedule: str, last: float) -> None:
    run = run_in(
        folder / schedule, ppo__entropy_schedule=schedule, classes__runner="tests.runtime.training.runs:WeightReporting"
    )
    first, *_, report = train(_judged_by(run, SOON))
    assert report.window.pass_rate == 1.0
    # Few successful episodes count little, since the windows have 100 episodes.
    assert first.iteration.losses["weight"] == 0.01
    assert report.iteration.losses["weight"] == pytest.approx(last)


def test_the_inverse_temperature_rises_as_the_spec_is_met(folder: Path) -> None:
    def run_of(sharpening: float) -> TrainingRun:
        changes = {"stop__windows": 1, "stop__episodes": 10, "ppo__sharpening": sharpening}
        return _judged_by(run_in(folder / f"by-{sharpening:.0f}", **changes), SOON)

    learned = []
    for run in (run_of(1.0), run_of(3.0)):
        reports = train(run)
        assert next(reports).window.successes == 8
        reports.close()
        learned.append(checkpoint_of(run).algorithm["actor_state_dict"])
    same, sharper = learned
    for name, weights in same.items():
        # The factor rises with pass rates from 0.5 to 1; a pass rate of 0.8 is 0.6 of this range.
        factor = 1 + 0.6 * 2 if name.startswith("mlp.2.") else 1
        assert torch.allclose(sharper[name], weights * factor), name


def test_a_resumed_training_keeps_its_inverse_temperature(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = _judged_by(run_in(folder / "sharpened", stop__windows=1, stop__episodes=10, ppo__sharpening=3.0), SOON)
    reports = train(run)
    next(reports)
    reports.close()
    factors: list[float] = []
    monkeypatch.setattr(Runner, "scale_inverse_temperature", lambda _, factor: factors.append(factor))
    assert next(train(run, resume=True)).window.successes == 10
    assert factors == pytest.approx([3 / 2.2])


def test_failures_cost_more_as_the_spec_is_met(folder: Path) -> None:
    changes = {
        "stop__windows": 1,
        "stop__episodes": 10,
        "classes__runner": "tests.runtime.training.runs:WeightReporting",
    }
    run = _judged_by(run_in(folder / "rising", **changes), SOON)
    first, second = train(run)
    assert (first.window.successes, second.stop) == (8, "met")
    assert (first.iteration.losses["penalty_weight"], second.iteration.losses["penalty_weight"]) == (
        0.0,
        pytest.approx(0.6),
    )
    rise = penalty_rise(run)
    assert rise is not None
    assert first.iteration.losses["extra_penalty"] == rise(0) > 0


def test_a_resumed_training_keeps_its_weights_of_entropy_and_penalty(folder: Path) -> None:
    changes = {
        "stop__windows": 1,
        "stop__episodes": 10,
        "classes__runner": "tests.runtime.training.runs:WeightReporting",
    }
    run = _judged_by(run_in(folder / "weighed", **changes), SOON)
    reports = train(run)
    assert next(reports).window.successes == 8
    reports.close()
    losses = next(train(run, resume=True)).iteration.losses
    assert losses["penalty_weight"] == pytest.approx(0.6)
    assert losses["weight"] == pytest.approx(0.002)
