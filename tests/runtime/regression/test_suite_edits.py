"""Levels that somebody edits while a suite runs or a baseline is recorded; the policies are untrained."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.runtime.regression.game import GUARD, SUITE, Played, edit, with_baseline
from tests.runtime.regression.handmade import ROOM
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tests.runtime.regression.runs import run, running
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.suite.suite import Case, read_suite
from tltl_runtime.regression.suite_run import CASES
from tltl_runtime.regression.verdict.play import PreparedCase, play_episodes, prepare_case
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.levels.identity import level_hash
from tltlc.diagnostics.diagnostic import TltlError


def test_a_level_edited_between_cases_is_played_as_edited(game: Path) -> None:
    suite, before = read_suite(Path("game.toml")), Path("room.toml").read_text(encoding="utf-8")

    cases = running(suite, "new")
    results = [next(cases)]
    edit("room.toml", "8.0, 8.0", "8.0, 7.5")
    results += cases
    assert [done.is_cached for done in results] == [False] * 3
    hashes = [done.report.played.level_hash for done in results if done.report.played]
    assert hashes[0] != hashes[1] and hashes[1:] == [
        level_hash(load_level("room.toml", variant)) for variant in ("v1", "v0")
    ]
    Path("room.toml").write_text(before, encoding="utf-8")
    # Results of the edited level are not used for the original level.
    assert list(run("new")[1]) == ["room:v1", "hopeless"]


def _edited_after(name: str, edit: Callable[[], object], monkeypatch: pytest.MonkeyPatch) -> None:
    """Call ``edit`` after a case has been prepared, right before it is played."""

    def then(case: Case, seed: int) -> PreparedCase:
        ready_case = prepare_case(case, seed)
        if case.name == name:
            edit()
        return ready_case

    monkeypatch.setattr("tltl_runtime.regression.suite_run.prepare_case", then)


def test_a_level_edited_while_it_is_played_is_reviewed_and_not_cached(
    game: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = Path("room.toml").read_text(encoding="utf-8")
    _edited_after("room:v1", lambda: edit("room.toml", "8.0, 8.0", "8.0, 7.5"), monkeypatch)
    results, played = run("new")
    report = results[1].report
    assert (report.verdict, report.certain, report.figures) == ("review", False, None)
    assert report.reasons == ("TLT0905, `room.toml` changed while `room:v1` was played (run the same command again)",)
    assert list(played) == ["room:v0", "hopeless"] and not (Path("new") / CASES / "room-v1").exists()
    monkeypatch.undo()
    monkeypatch.chdir(game)
    Path("room.toml").write_text(text, encoding="utf-8")
    assert list(run("new")[1]) == ["room:v1", "hopeless"]


@pytest.mark.parametrize("name", ["room.toml", "assets/guard.toml"])
def test_a_level_edited_after_the_workers_loaded_it_is_reviewed(game: Path, name: str) -> None:
    class Edits(Played):
        def __call__(self, case: Case, count: int, last: ExplainedEpisode) -> None:
            super().__call__(case, count, last)
            if (case.name, count) == ("room:v0", 25):
                Path(name).parent.mkdir(exist_ok=True)
                text = Path(name).read_text(encoding="utf-8") if Path(name).exists() else GUARD
                Path(name).write_text(text + "# later\n", encoding="utf-8")

    first, second, _ = running(read_suite(Path("game.toml")), "new", Edits())
    assert (first.report.verdict, first.report.certain, first.is_cached) == ("review", False, False)
    assert first.report.reasons == (
        f"TLT0905, `{name}` changed while `room:v0` was played (run the same command again)",
    )
    assert second.report.verdict == "pass"
    assert list(run("new")[1]) == ["room:v0"], "nothing of it is kept"


def test_a_level_edited_before_the_last_episode_of_a_baseline_is_reported(game: Path) -> None:
    ready_case = prepare_case(read_suite(Path("game.toml")).cases[0], 3)
    with pytest.raises(TltlError, match=r"TLT0905: `room\.toml` changed while `room:v0` was played"):
        for recorded in play_episodes(ready_case, 1):
            if recorded.explained.summary.index == ready_case.case.episodes - 1:
                edit("room.toml", "8.0, 8.0", "8.0, 7.5")


def test_a_level_that_breaks_during_a_run_fails_and_other_levels_are_played(
    game: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("hall.toml").write_text(ROOM, encoding="utf-8")
    edit("game.toml", SUITE, SUITE + '[[case]]\nlevel = "hall.toml"\npolicy = "easy.safetensors"\n')
    suite = with_baseline(Path("game.toml"))
    _edited_after("room:v1", lambda: edit("room.toml", "size = [10.0", "siez = [10.0"), monkeypatch)
    results, played = run("new", suite)
    assert [done.report.verdict for done in results] == ["pass", "fail", "fail", "pass"]
    assert "TLT0802" in results[1].report.reasons[2]
    assert list(played) == ["room:v0", "hall:v0"]


def test_a_level_edited_before_its_baseline_is_recorded_is_reported(game: Path) -> None:
    ready_case = prepare_case(read_suite(Path("game.toml")).cases[0], 3)
    edit("room.toml", "8.0, 8.0", "8.0, 7.5")
    with pytest.raises(TltlError, match="TLT0905") as error:
        next(play_episodes(ready_case, 1))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.title == "`room.toml` changed while `room:v0` was played"
