"""Trainings that begin with the policies of cases; they take seconds, and teach little."""

from __future__ import annotations

import shutil
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.runtime.evaluation.deadly import Deadly, killed
from tests.runtime.evaluation.untrained import untrained
from tests.runtime.regression.game import NEVER, edit, with_baseline, with_few_environments, write_game
from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.policies.file import read_policy, write_policy
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.retrain.retrain import (
    EPISODE,
    FOLDER,
    check_places,
    is_kept,
    make_room,
    retrained,
    retraining,
)
from tltl_runtime.regression.suite.suite import Suite, read_suite
from tltl_runtime.regression.verdict.baseline import baseline_of
from tltl_runtime.regression.verdict.play import Ready, Recorded, episodes, ready
from tltl_runtime.regression.verdict.run import Done, regress
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.training.run.record import write_record
from tltl_runtime.training.run.run import CHECKPOINT, POLICY, RECORD, RUN, Run
from tltl_runtime.training.run.train import train
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

SHORT = 0.02
"""The limit of a training in minutes: less than its search and first iteration take."""


def judged(suite: Suite) -> list[Done]:
    return list(regress(suite, suite.cases, baseline_of(suite), Path("run"), 1, lambda *_: None))


def training_of(suite: Suite, done: Done, minutes: float = SHORT) -> Run:
    assert done.ready is not None
    return retraining(suite, done.ready, Path("run"), minutes, 1)


def trained(run: Run, resume: bool = False) -> None:
    *_, last = train(run, resume=resume)
    write_record(run, last)


@pytest.fixture(name="made", scope="module")
def _made(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A game whose cases are judged, with a training for the hopeless one and one for what needs none."""
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
def _game(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Suite:
    with_few_environments(monkeypatch)
    shutil.copytree(made, tmp_path / "game")
    monkeypatch.chdir(tmp_path / "game")
    return read_suite(Path("game.toml"))


def test_what_needs_it(game: Suite) -> None:
    easy, other, hopeless = judged(game)
    assert [done.to_train for done in (easy, other, hopeless)] == [None, None, hopeless.ready]
    assert replace(easy, report=replace(easy.report, verdict="review")).to_train
    # Of a level that cannot be played nothing can be learned.
    assert replace(hopeless, ready=None).to_train is None
    told = retrained(game, hopeless, training_of(game, hopeless), 1, lambda *_: None)
    assert replace(hopeless, report=replace(hopeless.report, retrained=told)).to_train is None


def test_what_nobody_can_do_is_not_trained_for(game: Suite) -> None:
    *_, hopeless = judged(game)
    assert hopeless.ready and hopeless.useless_training is None
    level = load_level("navigation", "v2")
    setup = replace(hopeless.ready.setup, fspa=load_task(level.spec).fspa)
    shut = replace(hopeless, ready=replace(hopeless.ready, level=level, setup=setup))
    assert shut.useless_training == "nobody can do what `navigation` asks, as was said above"
    assert shut.to_train is None
    assert replace(shut, report=replace(shut.report, verdict="pass")).useless_training is None


def test_the_training_is_the_cases(game: Suite) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)
    policy = read_policy("soon.safetensors")
    assert run.folder == Path("run/retrained/hopeless")
    assert (run.fspa, run.sensors, run.settings.network) == (policy.card.fspa, policy.card.sensors, policy.card.network)
    assert run.initial and run.initial.path == "soon.safetensors"
    assert (run.settings.stop.minutes, run.settings.rollout.workers) == (SHORT, 1)


def test_a_level_without_a_way(game: Suite) -> None:
    *_, hopeless = judged(game)
    counts: list[int] = []

    def told(count: int, last: Account) -> None:
        counts.append(count)
        assert not last.success

    found = retrained(game, hopeless, training_of(game, hopeless), 1, told)
    assert (found.outcome, counts) == ("no_way", list(range(1, 26)))
    assert found.trained.shortest is None and found.trained.end == "minutes" and not found.trained.complete
    assert found.best and 0.0 <= found.best.progress < 1.0 and "exit" in found.best.remained
    assert (found.policy, found.episode) == ("run/retrained/hopeless/policy.safetensors".partition("/")[2], None)
    # Seeds are fresh: none of them is one by which the case was judged.
    assert retrained(game, hopeless, training_of(game, hopeless), 1, told) == found
    assert len(counts) == 25, "it is kept"


def test_a_level_that_is_learned(game: Suite) -> None:
    easy, *_ = judged(game)
    run = training_of(game, easy, minutes=10.0)
    found = retrained(game, easy, run, 1, lambda *_: None)
    assert (found.outcome, found.trained.end) == ("learned", "met")
    assert found.trained.shortest == 1 and found.best is None
    assert found.figures.pass_rate == 1.0 and found.rate_interval[0] >= 0.85
    episode = read_episode(run.folder / EPISODE)
    assert episode.seed not in {account.seed for account in easy.report.accounts}
    (run.folder / EPISODE).unlink()
    assert retrained(game, easy, run, 1, lambda *_: None) == found
    assert (run.folder / EPISODE).is_file(), "what was removed is played again"


def test_episodes_of_the_case_itself_show_that_there_is_a_way(game: Suite) -> None:
    *_, hopeless = judged(game)
    accounts = (replace(hopeless.report.accounts[0], success=True), *hopeless.report.accounts[1:])
    lucky = replace(hopeless, report=replace(hopeless.report, accounts=accounts))
    assert retrained(game, lucky, training_of(game, hopeless), 1, lambda *_: None).outcome == "feasible"


def test_of_a_lost_worker_it_is_told_what_plays_its_episode_with_the_new_policy(
    game: Suite, monkeypatch: pytest.MonkeyPatch
) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)

    def deadly(ready: Ready, pool: Pool) -> Generator[Recorded]:
        policy: Any = Deadly(ready.setup.policy, killed)
        return episodes(replace(ready, setup=replace(ready.setup, policy=policy)), pool)

    monkeypatch.setattr("tltl_runtime.regression.retrain.retrain.episodes", deadly)
    with pytest.raises(TltlError, match="TLT0850") as error:
        retrained(game, hopeless, run, 2, lambda *_: None)
    (found,) = error.value.diagnostics
    assert f"tltlc evaluate {run.folder} --level room.toml:v0 --seed {game.seed + 1} --first " in (found.help or "")


def test_what_is_kept_and_what_is_not(game: Suite) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)
    assert is_kept(run)
    assert is_kept(replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, minutes=9.0))))
    assert not is_kept(replace(run, seed=run.seed + 1))
    write_policy("soon.safetensors", untrained(NEVER, "room.toml", seed=7))
    assert not is_kept(retraining(game, ready(game.cases[2], game.seed), Path("run"), SHORT, 1))
    text = Path("room.toml").read_text(encoding="utf-8")
    Path("room.toml").write_text(text.replace("[8.0, 8.0, 0.0]", "[8.5, 8.0, 0.0]"), encoding="utf-8")
    assert not is_kept(run)
    Path("room.toml").write_text(text, encoding="utf-8")
    assert is_kept(run)
    (run.folder / CHECKPOINT).write_bytes(b"torn")
    assert not is_kept(run)
    (run.folder / CHECKPOINT).unlink()
    assert not is_kept(run), "it is over, and nothing can be told of it"
    (run.folder / RECORD).unlink()
    assert is_kept(run), "its search was not over"


def test_of_a_training_that_is_over_its_policy_is_needed(game: Suite) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)
    (run.folder / POLICY).unlink()
    assert not is_kept(run)


def test_what_is_wrong_with_the_level_is_no_fault_of_what_is_kept(game: Suite) -> None:
    *_, hopeless = judged(game)
    edit("room.toml", "[start]", "[strat]")
    with pytest.raises(TltlError, match="TLT0803: the level `room` lacks `start`"):
        is_kept(training_of(game, hopeless))


def test_no_policy_lies_where_a_training_goes(game: Suite) -> None:
    check_places(game, game.cases, Path("run"))
    own = replace(game.cases[1], policy=Path("run/retrained/hopeless") / POLICY)
    suite = replace(game, cases=(game.cases[0], own, game.cases[2]))
    with pytest.raises(TltlError, match="TLT0942: the policy of the case `room:v1` lies in `run/retrained/hopeless`"):
        check_places(suite, suite.cases, Path("run"))
    check_places(suite, suite.cases[:2], Path("run"))
    assert not (Path("run/retrained") / "room-v1").exists()


def test_with_more_minutes_it_goes_on(game: Suite) -> None:
    *_, hopeless = judged(game)
    run = training_of(game, hopeless)
    before = retrained(game, hopeless, run, 1, lambda *_: None)
    longer = training_of(game, hopeless, minutes=before.trained.seconds / 60 + SHORT)
    trained(longer, resume=True)
    after = retrained(game, hopeless, longer, 1, lambda *_: None)
    # Its search, which the first limit broke off, is made anew.
    assert after.trained.searched > before.trained.searched and after.trained.seconds > before.trained.seconds


def test_what_makes_room_leaves_other_files(game: Suite) -> None:
    *_, hopeless = judged(game)
    folder = training_of(game, hopeless).folder
    (folder / "notes.txt").touch()
    retrained(game, hopeless, training_of(game, hopeless), 1, lambda *_: None)
    assert (folder / RUN).exists() and (folder / POLICY).exists()
    (folder / RECORD).unlink()
    assert make_room(game, folder) is None, "it is not over"
    assert [path.name for path in folder.iterdir() if not path.name.startswith(".")] == ["notes.txt"]


def test_what_was_learned_stays_beside_what_is_learned_now(game: Suite) -> None:
    folder = Path("run") / FOLDER / "hopeless"
    policy = (folder / POLICY).read_bytes()
    (folder / "notes.txt").touch()
    # Where the training of another case goes is not free, even if there is none yet.
    suite = replace(game, cases=(*game.cases, replace(game.cases[2], name="hopeless-3")))
    folder.with_name("hopeless-2").mkdir()
    aside = make_room(suite, folder)
    assert aside == folder.with_name("hopeless-4") and not folder.exists()
    assert (aside / POLICY).read_bytes() == policy and (aside / RECORD).exists() and (aside / "notes.txt").exists()


def test_a_training_that_cannot_be_moved_stays(game: Suite, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise PermissionError(13, "no")

    folder = Path("run") / FOLDER / "hopeless"
    monkeypatch.setattr(Path, "rename", refused)
    with pytest.raises(TltlError, match=f"TLT0005: cannot move `{folder}` to `{folder}-2`"):
        make_room(game, folder)
    assert (folder / RECORD).exists()


def test_a_policy_that_lies_where_its_training_goes(game: Suite) -> None:
    text = Path("game.toml").read_text(encoding="utf-8")
    Path("game.toml").write_text(text.replace('"soon.safetensors"', '"run/retrained/hopeless"'), encoding="utf-8")
    suite = with_baseline(Path("game.toml"))
    with pytest.raises(TltlError) as caught:
        training_of(suite, judged(suite)[2])
    (found,) = caught.value.diagnostics
    assert (found.code, found.title) == (
        "TLT0942",
        "the policy of the case `hopeless` lies in `run/retrained/hopeless`, where its training goes",
    )
