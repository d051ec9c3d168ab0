"""Running suites, stopping and resuming; the policies are untrained."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import closing
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from tests.runtime.evaluation.untrained import SOON, untrained
from tests.runtime.regression.game import EASY, GUARD, SUITE, Played, edit, with_baseline
from tests.runtime.regression.handmade import ROOM, changed
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tests.runtime.regression.runs import run, running
from tltl_runtime.evaluation.evaluate import results
from tltl_runtime.policies.file import write_policy
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.policies.policy import Policy
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.suite.dependencies import dependencies
from tltl_runtime.regression.suite.suite import Case, read_suite
from tltl_runtime.regression.suite_run import (
    CASES,
    FinishedCase,
    _inputs,
    case_folder,
    check_references,
    lock_run,
    regress,
)
from tltl_runtime.regression.verdict.baseline import baseline_of
from tltl_runtime.regression.verdict.play import PreparedCase, play_episodes, prepare_case
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.stealth.recordings.versions import versions
from tltlc.automaton.fspa import Text
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


@pytest.fixture(scope="module")
def again(recorded: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[FinishedCase], dict[str, int]]:
    """A second run of the recorded game, which must only be read: its folder, results and numbers of episodes."""
    copy = tmp_path_factory.mktemp("again") / "game"
    shutil.copytree(recorded, copy)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(copy)
        return copy, *run("new")


def test_cases_are_judged_in_order(
    again: tuple[Path, list[FinishedCase], dict[str, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    game, results, played = again
    monkeypatch.chdir(game)
    assert [(done.report.name, done.report.verdict) for done in results] == [
        ("room:v0", "pass"),
        ("room:v1", "pass"),
        ("hopeless", "fail"),
    ]
    assert played["hopeless"] == 25 and 25 < played["room:v0"] == played["room:v1"] < 50
    for done in results:
        report = done.report
        assert not done.is_cached and done.prepared and done.reference
        assert report.figures and report.figures.episodes == len(report.episodes) == played[report.name]
        assert [explained.summary.index for explained in report.episodes] == list(range(played[report.name]))
        assert report.recordings
        folder = case_folder(read_suite(Path("game.toml")), report.name, Path("new") / CASES)
        assert {path.name for path in folder.iterdir()} == {"case.json", *dict(report.recordings).values()}
        for index, name in report.recordings:
            assert read_episode(folder / name).seed == report.episodes[index].summary.seed


def test_two_runs_give_equal_results(recorded: Path, again: tuple[Path, list[FinishedCase], dict[str, int]]) -> None:
    first, second = recorded / "run", again[0] / "new"
    paths = [path.relative_to(first) for path in first.rglob("*.json")]
    assert len(paths) == 3
    for path in paths:
        assert (first / path).read_bytes() == (second / path).read_bytes()


def test_a_cached_case_is_not_played_again(game: Path, again: tuple[Path, list[FinishedCase], dict[str, int]]) -> None:
    kept, played = run()
    assert played == {} and all(done.is_cached for done in kept)
    _, new, _ = again
    assert [done.report for done in kept] == [done.report for done in new]


def _write(name: str, text: str) -> None:
    Path(name).parent.mkdir()
    Path(name).write_text(text, encoding="utf-8")


def _trained_again(name: str, spec: str) -> None:
    write_policy(Path(f"{name}.safetensors"), untrained(spec, "room.toml", seed=1))
    with_baseline(Path("game.toml"))


def _seeded(seed: int) -> None:
    edit("game.toml", "seed = 3", f"seed = {seed}")
    with_baseline(Path("game.toml"))


def _last(line: str) -> Callable[[], None]:
    """Return a function that adds a line to the last case of the suite."""
    return lambda: edit("game.toml", 'name = "hopeless"', f'name = "hopeless"\n{line}')


CHANGES: dict[str, tuple[Callable[[], None], list[str]]] = {
    "threshold": (_last("thresholds = { fail_rate = 0.45 }"), ["hopeless"]),
    "episodes": (_last("episodes = 40"), ["hopeless"]),
    "error": (lambda: edit("game.toml", "seed = 3", "seed = 3\nerror = 0.04"), ["room:v0", "room:v1", "hopeless"]),
    "level": (lambda: edit("room.toml", "8.0, 8.0", "8.0, 8.5"), ["room:v0", "room:v1", "hopeless"]),
    "overlay": (lambda: _write("overlays/guard_alert.toml", 'doc = "None."\n'), ["room:v1"]),
    "asset": (lambda: _write("assets/guard.toml", GUARD + "# As before.\n"), ["room:v0", "room:v1", "hopeless"]),
    "policy": (lambda: _trained_again("soon", SOON), ["hopeless"]),
    "seed": (lambda: _seeded(4), ["room:v0", "room:v1", "hopeless"]),
}


@pytest.mark.parametrize("change", CHANGES)
def test_only_changed_cases_are_played_again(game: Path, change: str) -> None:
    edit, names = CHANGES[change]
    edit()
    results, played = run()
    assert list(played) == names
    assert [done.report.name for done in results if not done.is_cached] == names
    assert run()[1] == {}, "and is kept again"


@pytest.mark.parametrize("what", ["versions", "sources"])
def test_cases_are_played_again_with_other_versions(game: Path, monkeypatch: pytest.MonkeyPatch, what: str) -> None:
    if what == "versions":
        other = {**versions(), "numpy": "0.1"}
        monkeypatch.setattr("tltl_runtime.regression.verdict.play.versions", lambda: other)
    else:
        monkeypatch.setattr("tltl_runtime.regression.suite.result_cache.sources_hash", lambda: "0" * 64)
    results, played = run()
    assert list(played) == ["room:v0", "room:v1", "hopeless"]
    versions_reported = "the baseline was recorded with numpy " in " ".join(results[2].report.reasons)
    assert versions_reported == (what == "versions")


def test_names_in_reasons_are_part_of_the_cache_key(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    ready_case, reference = prepare_case(suite.cases[0], suite.seed), baseline_of(suite)[0]
    fspa = ready_case.setup.fspa
    for renamed_fspa in (
        replace(fspa, atoms=tuple(replace(atom, base=f"{atom.name}_2", arguments=()) for atom in fspa.atoms)),
        replace(fspa, states=tuple(replace(state, label=Text("go on", "go on", "go")) for state in fspa.states)),
    ):
        assert spec_hash(renamed_fspa) == spec_hash(fspa)
        renamed = replace(ready_case, setup=replace(ready_case.setup, fspa=renamed_fspa))
        assert _inputs(renamed, reference, 0.01) != _inputs(ready_case, reference, 0.01)
    assert _inputs(ready_case, reference, 0.01) == _inputs(prepare_case(suite.cases[0], suite.seed), reference, 0.01)


class Deadly:
    """A stand-in for a policy that ends the playing process."""

    def __init__(self, policy: Policy) -> None:
        self.card = policy.card

    def choose(self, *_: object) -> None:
        os.kill(os.getpid(), signal.SIGTERM)


@pytest.mark.slow
def test_a_lost_worker_ends_the_run(game: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    suite = read_suite(Path("game.toml"))

    def deadly(case: Case, seed: int) -> PreparedCase:
        ready_case = prepare_case(case, seed)
        return replace(ready_case, setup=replace(ready_case.setup, policy=Deadly(ready_case.setup.policy)))

    monkeypatch.setattr("tltl_runtime.regression.suite_run.prepare_case", deadly)
    with pytest.raises(TltlError) as error:
        list(regress(suite, suite.cases, baseline_of(suite), Path("new"), 2, Played()))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0850"
    command = "tltlc evaluate easy.safetensors --level room.toml:v0 --seed 3 --first"
    assert re.fullmatch(rf"to play only that episode: {command} [01] --episodes 1", diagnostic.help)
    assert not (Path("new") / CASES).exists()


def test_episodes_after_a_gap_are_not_judged(game: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All finished episodes come before an error; slow episodes are missing among them."""
    lost = TltlError([Diagnostic("TLT0850", "a worker was lost", help="play it alone")])

    def with_gap(*given: Any, **named: Any) -> Iterator[Any]:
        yield from (result for result in islice(results(*given, **named), 6) if result.request.index != 2)
        raise lost

    monkeypatch.setattr("tltl_runtime.regression.verdict.play.results", with_gap)
    judged_indices: list[int] = []
    with pytest.raises(TltlError) as error:
        judged_indices.extend(
            recorded.explained.summary.index
            for recorded in play_episodes(prepare_case(read_suite(Path("game.toml")).cases[0], 3), 1)
        )
    assert (error.value, judged_indices) == (lost, [0, 1])


def test_a_spec_changed_since_the_training_is_reviewed(game: Path) -> None:
    text = Path("room.toml").read_text(encoding="utf-8")
    Path("plan.tltl").write_text(EASY, encoding="utf-8")
    Path("room.toml").write_text(f'spec = "plan.tltl:easy"\n{text}', encoding="utf-8")
    results, _ = run()
    assert [done.report.verdict for done in results] == ["pass", "pass", "fail"], "it is the policy's"
    edit("plan.tltl", "limit 20 steps", "limit 30 steps")
    results, played = run()
    assert list(played) == ["room:v0", "room:v1"], "the third has a spec of its own"
    for done in results[:2]:
        assert done.report.verdict == "review"
        assert done.report.edits[0].startswith("changed since the baseline: room.toml")
        assert done.report.headline == done.report.main[0] == done.report.reasons[0]
        assert done.report.headline.startswith("the spec `easy` has changed since the policy was trained (")
        assert done.report.status == "outdated"
        assert done.case_to_train is None, "a training would be for the old spec"
    assert results[2].case_to_train is not None
    edit("plan.tltl", "reach alive", "reach alve")
    results, _ = run()
    assert [done.report.verdict for done in results] == ["fail", "fail", "fail"]
    assert results[0].report.reasons[1].startswith("plan.tltl:2: TLT0")


def test_the_headline_of_a_failure_describes_the_ends(game: Path) -> None:
    passed, _, failed = (done.report for done in run()[0])
    assert passed.headline == passed.reasons[0]
    # First comes how most episodes end, then what has changed.
    main = failed.headline.removesuffix(f"; {failed.edits[0]}")
    assert main != failed.headline and failed.reasons[0].startswith(main)
    (end,) = (finding.text for finding in failed.explanation if finding.text.startswith(main))
    assert end.partition(";")[0] == main
    assert re.search(r" of 25 episodes( \(\d+%\))?$", main)


def test_a_baseline_with_fewer_episodes_is_rejected(game: Path) -> None:
    edit("game.toml", "episodes = 50", "episodes = 60")
    with pytest.raises(TltlError, match="TLT0903: the baseline of `room:v0` has 50 episodes, but 60 are required"):
        run()


def test_a_baseline_with_unknown_states_is_rejected_before_anything_is_played(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    easy, hopeless = baseline_of(suite)
    *explained_episodes, last = hopeless.episodes
    damaged = replace(hopeless, episodes=(*explained_episodes, changed(last, unmet=99)))
    with pytest.raises(TltlError, match=r"TLT0902: .* episode 49 of `room:v0` has the state 99, but"):
        check_references(suite, suite.cases, (easy, damaged))


def test_a_folder_may_have_a_plus_in_its_name(game: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(game, tmp_path / "c++")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "c++" / "edit.toml").write_text("[change.guard]\nsight_range = 9.0\n", encoding="utf-8")
    edit("c++/game.toml", 'variant = "v1"', 'overlay = ["edit.toml", "guard_alert"]')
    suite = read_suite(Path("c++/game.toml"))
    results, played = run("new", suite)
    assert list(played) == ["room:v0", "room:v0+edit+guard_alert", "hopeless"]
    assert [done.report.variant for done in results] == ["v0", "v0+edit+guard_alert", "v0"]
    assert (tmp_path / "c++" / "edit.toml").resolve() in dependencies(suite, suite.cases[1])


def test_a_changed_baseline_plays_its_cases_again(game: Path) -> None:
    path = read_suite(Path("game.toml")).baseline
    document = json.loads(path.read_text(encoding="utf-8"))
    document["references"][0]["accounts"][0]["reward"] += 0.001
    path.write_text(json.dumps(document), encoding="utf-8")
    _, played = run()
    assert list(played) == ["room:v0", "room:v1"]


def test_a_stopped_run_resumes(game: Path) -> None:
    suite, played = read_suite(Path("game.toml")), Played()
    with closing(running(suite, "new", played)) as stopped:  # type: ignore[type-var]
        assert next(stopped).report.name == "room:v0"
    assert list(played.counts) == ["room:v0"]
    results, played_again = run("new")
    assert [done.is_cached for done in results] == [True, False, False]
    assert list(played_again) == ["room:v1", "hopeless"]


def test_an_interrupted_case_is_played_from_its_start(game: Path) -> None:
    class StopError(Exception):
        pass

    def stop_in_the_middle(case: Case, count: int, last: ExplainedEpisode) -> None:
        if case.name == "room:v1" and count == 10:
            raise StopError

    suite = read_suite(Path("game.toml"))
    with pytest.raises(StopError):
        list(regress(suite, suite.cases, baseline_of(suite), Path("new"), 1, stop_in_the_middle))
    results, played = run("new")
    assert [done.is_cached for done in results] == [True, False, False]
    assert [done.report for done in results] == [done.report for done in run()[0]]
    assert played["room:v1"] > 25


@pytest.mark.parametrize("damage", ["", "{", "[" * 9999, '{"identity": 3}', None])
def test_a_case_with_a_damaged_cache_is_played_again(game: Path, damage: str | None) -> None:
    folder = case_folder(read_suite(Path("game.toml")), "room:v0", Path("run") / CASES)
    if damage is None:
        next(folder.glob("*.episode.npz")).unlink()
    else:
        (folder / "case.json").write_text(damage, encoding="utf-8")
    assert list(run()[1]) == ["room:v0"]


def test_fresh_plays_exactly_the_selected_cases_again(game: Path) -> None:
    suite, played = read_suite(Path("game.toml")), Played()
    with closing(regress(suite, suite.cases[1:], baseline_of(suite), Path("run"), 1, played, fresh=True)) as stopped:
        assert next(stopped).report.name == "room:v1"
    assert list(run()[1]) == ["hopeless"], "what was not played again before the stop is, too"
    references = baseline_of(suite)
    assert len(list(regress(suite, suite.cases, references, Path("nowhere"), 1, Played(), fresh=True))) == 3


def test_a_level_that_does_not_load_fails_its_cases_and_other_levels_are_played(game: Path) -> None:
    edit("game.toml", SUITE, SUITE + '[[case]]\nlevel = "hall.toml"\npolicy = "easy.safetensors"\n')
    Path("hall.toml").write_text(ROOM, encoding="utf-8")
    suite = with_baseline(Path("game.toml"))
    Path("room.toml").write_text(ROOM.replace("size = [10.0", "siez = [10.0"), encoding="utf-8")
    results, played = run("new", suite)
    assert list(played) == ["hall:v0"]
    assert [done.report.verdict for done in results] == ["fail", "fail", "fail", "pass"]
    assert results[0].report.reasons[::2] == (
        "it cannot be played",
        "room.toml:5: TLT0802, `[bounds]` has no key `siez` (did you mean `size`?)",
    )
    assert results[0].report.figures is None and not results[0].is_cached
    # A level that does not load is tried again in each run.
    assert not run("new", suite)[0][0].is_cached


def test_a_policy_that_does_not_fit_fails_its_case(game: Path) -> None:
    Path("hall.toml").write_text(
        ROOM.replace('[[exit]]\nname = "exit"', '[[exit]]\nname = "way_out"'), encoding="utf-8"
    )
    edit("game.toml", 'variant = "v1"', "")
    edit("game.toml", 'level = "room.toml"\n\npolicy', 'level = "hall.toml"\npolicy')
    results, played = run("new")
    assert list(played) == ["room:v0", "hopeless"]
    (report,) = (done.report for done in results if done.report.name == "hall:v0")
    assert report.verdict == "fail"
    assert "TLT0843, the policy senses the entity `exit`, which the level `hall` does not have" in report.reasons[1]
    assert "(let it play `room`, where it was trained, or train one for `hall`)" in report.reasons[1]
    edit("room.toml", 'name = "exit"', 'name = "way_out"')
    report = run("new")[0][0].report
    assert "(put back what was there when it was trained, or train one for `room`)" in report.reasons[1]


def test_a_level_that_a_player_leaves_fails_its_case_and_other_cases_are_judged(game: Path) -> None:
    edit("room.toml", "size = [10.0, 10.0, 4.5]", "size = [10.0, 10.0, 1.2]")
    results, _ = run("new")
    assert [done.report.name for done in results] == ["room:v0", "room:v1", "hopeless"]
    report = results[2].report
    assert report.verdict == "fail" and "TLT0806" in report.reasons[1]


def test_a_case_missing_in_the_baseline_is_reported_before_anything_is_played(game: Path) -> None:
    suite, played = read_suite(Path("game.toml")), Played()
    references = tuple(reference for reference in baseline_of(suite) if reference.played.spec != "soon")
    with pytest.raises(TltlError) as error:
        check_references(suite, suite.cases, references)
    assert [diagnostic.code for diagnostic in error.value.diagnostics] == ["TLT0903"]
    # The baseline may lack cases that are not run.
    check_references(suite, suite.cases[:2], references)
    assert len(list(regress(suite, suite.cases[:2], references, Path("new"), 1, played))) == 2


def test_an_unwritable_folder_is_reported_before_anything_is_played(game: Path) -> None:
    Path("file").touch()
    for place in ("file", "file/run"):
        with pytest.raises(TltlError) as error, lock_run(Path(place)):
            pytest.fail("nothing can be written there")
        assert [diagnostic.code for diagnostic in error.value.diagnostics] == ["TLT0005"]


def test_a_folder_is_used_by_one_run_at_a_time(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    with lock_run(Path("run")):
        with pytest.raises(TltlError) as error, lock_run(Path("run")):
            pytest.fail("it is taken")
        (diagnostic,) = error.value.diagnostics
        assert (diagnostic.code, diagnostic.title) == ("TLT0904", "another run of `tltlc regress` is using `run`")
        with lock_run(Path("new")):
            assert len(list(running(suite, "new"))) == 3, "elsewhere there is room"
    with lock_run(Path("run")):
        assert len(list(running(suite))) == 3


def test_a_case_may_have_any_name(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    names = ["..", "a/b", "a:b", "a-b", ".", "/", "…", "a\0b"]
    odd = replace(suite, cases=tuple(replace(suite.cases[0], name=name) for name in names))
    folders = [case_folder(odd, name, Path("new")) for name in names]
    assert len(set(folders)) == len(names)
    assert all(folder.parent == Path("new") and folder.name.strip(".") for folder in folders)


def test_a_report_does_not_contain_the_path_of_an_overlay(game: Path) -> None:
    Path("edits").mkdir()
    Path("edits/wide.toml").write_text("[start]\nat = [2.5, 2.0, 0.0]\n", encoding="utf-8")
    edit("game.toml", 'variant = "v1"', 'overlay = "edits/wide.toml"')
    Path("room.toml").write_text(ROOM.replace("size = [10.0", "siez = [10.0"), encoding="utf-8")
    suite = read_suite((game / "game.toml").absolute())
    results = list(regress(suite, suite.cases, baseline_of(suite), Path("new"), 1, Played()))
    assert [done.report.variant for done in results] == ["v0", "v0+wide", "v0"]


def test_recordings_of_an_earlier_run_are_removed(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    folder = case_folder(suite, "room:v0", Path("run") / CASES)
    (folder / "49.episode.npz").write_bytes(b"old")
    edit("room.toml", "8.0, 8.0", "8.0, 8.5")
    results, _ = run()
    names = {path.name for path in folder.glob("*.episode.npz")}
    assert names == set(dict(results[0].report.recordings).values())
