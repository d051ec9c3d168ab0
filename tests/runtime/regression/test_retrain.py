"""Retraining the policies of cases; the trainings take seconds."""

from __future__ import annotations

import shutil
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.runtime.evaluation.deadly import Deadly, kill_this_process
from tests.runtime.evaluation.untrained import untrained
from tests.runtime.regression.game import NEVER, edit, with_baseline, with_few_environments, write_game
from tests.runtime.regression.handmade import changed
from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.game.level import default_spec
from tltl_runtime.policies.file import read_policy, write_policy
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.retrain.retrain import (
    EPISODE,
    FOLDER,
    check_policy_folders,
    configure_retraining,
    is_stored,
    make_room,
    retraining_result,
)
from tltl_runtime.regression.suite.suite import Suite, read_suite
from tltl_runtime.regression.suite_run import FinishedCase, regress
from tltl_runtime.regression.verdict.baseline import baseline_of
from tltl_runtime.regression.verdict.play import CaseEpisode, PreparedCase, play_episodes, prepare_case
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.training.files.record import write_record
from tltl_runtime.training.files.run_file import CHECKPOINT, POLICY, RECORD, RUN, TrainingRun
from tltl_runtime.training.run.train import train
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

SHORT = 0.02
"""The limit of a training in minutes; its search and first iteration take longer."""


def judged(suite: Suite) -> list[FinishedCase]:
    return list(regress(suite, suite.cases, baseline_of(suite), Path("run"), 1, lambda *_: None))


def training_of(suite: Suite, done: FinishedCase, minutes: float = SHORT) -> TrainingRun:
    assert done.prepared is not None
    return configure_retraining(suite, done.prepared, Path("run"), minutes, 1)


def trained(run: TrainingRun, resume: bool = False) -> None:
    *_, last = train(run, resume=resume)
    write_record(run, last)


@pytest.fixture(name="game_folder", scope="module")
def _game_folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A game with judged cases, a retraining of the hopeless case, and a retraining of a case that passes."""
    folder = tmp_path_factory.mktemp("made") / "game"
    with pytest.MonkeyPatch.context() as patch:
        with_few_environments(patch)
        write_game(folder)
        patch.chdir(folder)
        write_policy("soon.safetensors", untrained(NEVER, "room.toml"))
        suite = with_baseline(Path("game.toml"))
        easy, _, hopeless = judged(suite)
        trained(training_of(suite, hopeless))
        trained(training_of(suite, easy, minutes=10.0))
        yield folder


@pytest.fixture(name="game")
def _game(game_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Suite:
    with_few_environments(monkeypatch)
    shutil.copytree(game_folder, tmp_path / "game")
    monkeypatch.chdir(tmp_path / "game")
    return read_suite(Path("game.toml"))


@pytest.mark.slow
def test_only_cases_that_do_not_pass_are_retrained(game: Suite) -> None:
    easy, other, hopeless = judged(game)
    assert [done.case_to_train for done in (easy, other, hopeless)] == [None, None, hopeless.prepared]
    assert replace(easy, report=replace(easy.report, verdict="review")).case_to_train
    # A level that cannot be played cannot be trained on.
    assert replace(hopeless, prepared=None).case_to_train is None
    retrained_report = retraining_result(game, hopeless, training_of(game, hopeless), 1, lambda *_: None)
    assert replace(hopeless, report=replace(hopeless.report, retrained=retrained_report)).case_to_train is None


@pytest.mark.slow
def test_a_case_with_an_unreachable_goal_is_not_retrained(game: Suite) -> None:
    *_, hopeless = judged(game)
    assert hopeless.prepared and hopeless.training_obstacle is None
    level = load_level("navigation", "v2")
    setup = replace(hopeless.prepared.setup, fspa=load_task(default_spec(level)).fspa)
    shut = replace(hopeless, prepared=replace(hopeless.prepared, level=level, setup=setup))
    assert shut.training_obstacle == "nobody can do what `navigation` asks, as reported above"
    assert shut.case_to_train is None
    assert replace(shut, report=replace(shut.report, verdict="pass")).training_obstacle is None


def test_the_training_uses_the_setup_of_its_case(game: Suite) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)
    policy = read_policy("soon.safetensors")
    assert run.folder == Path("run/retrained/hopeless")
    assert (run.fspa, run.sensors, run.settings.network) == (policy.card.fspa, policy.card.sensors, policy.card.network)
    assert run.initial and run.initial.path == "soon.safetensors"
    assert (run.settings.stop.minutes, run.settings.rollout.workers) == (SHORT, 1)


def test_an_unsolvable_level_is_reported_as_no_way(game: Suite) -> None:
    *_, hopeless = judged(game)
    counts: list[int] = []

    def count_failures(count: int, last: ExplainedEpisode) -> None:
        counts.append(count)
        assert not last.summary.success

    result = retraining_result(game, hopeless, training_of(game, hopeless), 1, count_failures)
    assert (result.outcome, counts) == ("no_way", list(range(1, 26)))
    assert result.trained.shortest is None and result.trained.end == "minutes" and not result.trained.complete
    assert result.best and 0.0 <= result.best.progress < 1.0 and "exit" in result.best.remained
    assert (result.policy, result.episode) == ("run/retrained/hopeless/policy.safetensors".partition("/")[2], None)
    # The evaluation uses fresh seeds, none of the seeds by which the case was judged.
    assert retraining_result(game, hopeless, training_of(game, hopeless), 1, count_failures) == result
    assert len(counts) == 25, "it is kept"


def test_a_learned_level_is_reported_as_learned(game: Suite) -> None:
    easy, *_ = judged(game)
    run = training_of(game, easy, minutes=10.0)
    result = retraining_result(game, easy, run, 1, lambda *_: None)
    assert (result.outcome, result.trained.end) == ("learned", "met")
    assert result.trained.shortest == 1 and result.best is None
    assert result.figures.pass_rate == 1.0 and result.rate_interval[0] >= 0.85
    episode = read_episode(run.folder / EPISODE)
    assert episode.seed not in {explained.summary.seed for explained in easy.report.episodes}
    (run.folder / EPISODE).unlink()
    assert retraining_result(game, easy, run, 1, lambda *_: None) == result
    assert (run.folder / EPISODE).is_file(), "what was removed is played again"


def test_a_success_of_the_case_itself_shows_that_the_level_is_feasible(game: Suite) -> None:
    *_, hopeless = judged(game)
    explained_episodes = (changed(hopeless.report.episodes[0], success=True), *hopeless.report.episodes[1:])
    lucky = replace(hopeless, report=replace(hopeless.report, episodes=explained_episodes))
    assert retraining_result(game, lucky, training_of(game, hopeless), 1, lambda *_: None).outcome == "feasible"


def test_a_lost_worker_is_reported_with_the_command_that_plays_its_episode(
    game: Suite, monkeypatch: pytest.MonkeyPatch
) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)

    def deadly(prepare_case: PreparedCase, pool: Pool) -> Generator[CaseEpisode]:
        policy: Any = Deadly(prepare_case.setup.policy, kill_this_process)
        return play_episodes(replace(prepare_case, setup=replace(prepare_case.setup, policy=policy)), pool)

    monkeypatch.setattr("tltl_runtime.regression.retrain.retrain.play_episodes", deadly)
    with pytest.raises(TltlError, match="TLT0850") as error:
        retraining_result(game, hopeless, run, 2, lambda *_: None)
    (diagnostic,) = error.value.diagnostics
    assert f"tltlc evaluate {run.folder} --level room.toml:v0 --seed {game.seed + 1} --first " in (
        diagnostic.help or ""
    )


def test_a_training_is_kept_while_its_inputs_are_unchanged(game: Suite) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)
    assert is_stored(run)
    assert is_stored(replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, minutes=9.0))))
    assert not is_stored(replace(run, seed=run.seed + 1))
    write_policy("soon.safetensors", untrained(NEVER, "room.toml", seed=7))
    assert not is_stored(configure_retraining(game, prepare_case(game.cases[2], game.seed), Path("run"), SHORT, 1))
    text = Path("room.toml").read_text(encoding="utf-8")
    Path("room.toml").write_text(text.replace("[8.0, 8.0, 0.0]", "[8.5, 8.0, 0.0]"), encoding="utf-8")
    assert not is_stored(run)
    Path("room.toml").write_text(text, encoding="utf-8")
    assert is_stored(run)
    (run.folder / CHECKPOINT).write_bytes(b"torn")
    assert not is_stored(run)
    (run.folder / CHECKPOINT).unlink()
    assert not is_stored(run), "it is over, and nothing can be told of it"
    (run.folder / RECORD).unlink()
    assert is_stored(run), "its search was not over"


def test_a_finished_training_without_a_policy_is_not_kept(game: Suite) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)
    (run.folder / POLICY).unlink()
    assert not is_stored(run)


def test_an_error_in_the_level_is_not_blamed_on_the_training(game: Suite) -> None:
    *_, hopeless = judged(game)
    edit("room.toml", "[start]", "[strat]")
    with pytest.raises(TltlError, match="TLT0803: the level `room` lacks `start`"):
        is_stored(training_of(game, hopeless))


def test_a_policy_in_the_folder_of_a_training_is_rejected(game: Suite) -> None:
    check_policy_folders(game, game.cases, Path("run"))
    misplaced = replace(game.cases[1], policy=Path("run/retrained/hopeless") / POLICY)
    suite = replace(game, cases=(game.cases[0], misplaced, game.cases[2]))
    with pytest.raises(
        TltlError, match="TLT0942: the policy of the case `room:v1` is stored in `run/retrained/hopeless`"
    ):
        check_policy_folders(suite, suite.cases, Path("run"))
    check_policy_folders(suite, suite.cases[:2], Path("run"))
    assert not (Path("run/retrained") / "room-v1").exists()


@pytest.mark.slow
def test_a_training_resumes_with_more_minutes(game: Suite) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)
    before = retraining_result(game, hopeless, run, 1, lambda *_: None)
    longer = training_of(game, hopeless, minutes=before.trained.seconds / 60 + SHORT)
    trained(longer, resume=True)
    after = retraining_result(game, hopeless, longer, 1, lambda *_: None)
    # The search that the first limit interrupted starts again.
    assert after.trained.searched > before.trained.searched and after.trained.seconds > before.trained.seconds


def test_make_room_keeps_other_files(game: Suite) -> None:
    *_, hopeless = judged(game)
    folder = training_of(game, hopeless).folder
    (folder / "notes.txt").touch()
    retraining_result(game, hopeless, training_of(game, hopeless), 1, lambda *_: None)
    assert (folder / RUN).exists() and (folder / POLICY).exists()
    (folder / RECORD).unlink()
    assert make_room(game, folder) is None, "it is not over"
    assert [path.name for path in folder.iterdir() if not path.name.startswith(".")] == ["notes.txt"]


def test_a_finished_training_is_moved_aside(game: Suite) -> None:
    folder = Path("run") / FOLDER / "hopeless"
    policy = (folder / POLICY).read_bytes()
    (folder / "notes.txt").touch()
    # The folder for the training of another case is reserved, even if it does not exist yet.
    suite = replace(game, cases=(*game.cases, replace(game.cases[2], name="hopeless-3")))
    folder.with_name("hopeless-2").mkdir()
    aside = make_room(suite, folder)
    assert aside == folder.with_name("hopeless-4") and not folder.exists()
    assert (aside / POLICY).read_bytes() == policy and (aside / RECORD).exists() and (aside / "notes.txt").exists()


def test_a_training_that_cannot_be_moved_stays_in_place(game: Suite, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise PermissionError(13, "no")

    folder = Path("run") / FOLDER / "hopeless"
    monkeypatch.setattr(Path, "rename", refused)
    with pytest.raises(TltlError, match=f"TLT0005: cannot move `{folder}` to `{folder}-2`"):
        make_room(game, folder)
    assert (folder / RECORD).exists()


def test_a_policy_in_the_folder_of_its_own_training_is_rejected(game: Suite) -> None:
    text = Path("game.toml").read_text(encoding="utf-8")
    Path("game.toml").write_text(text.replace('"soon.safetensors"', '"run/retrained/hopeless"'), encoding="utf-8")
    suite = with_baseline(Path("game.toml"))
    with pytest.raises(TltlError) as caught:
        training_of(suite, judged(suite)[2])
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == (
        "TLT0942",
        "the policy of the case `hopeless` is stored in `run/retrained/hopeless`, where its training will write",
    )
