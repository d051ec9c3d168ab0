"""Baselines are recorded, stopped and gone on with."""

from __future__ import annotations

import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest

from tests.runtime.regression.game import SUITE, Played, edit
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tltl_runtime.regression.suite.suite import read_suite
from tltl_runtime.regression.verdict.baseline import baseline_of, read_baseline
from tltl_runtime.regression.verdict.baseline_run import record_baseline, verdict_as_it_is, write_recorded
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError


def test_a_baseline_plays_each_place_once_and_all_of_its_episodes(game: Path) -> None:
    suite, played = read_suite(Path("game.toml")), Played()
    found = [each.reference for each in record_baseline(suite, 1, played)]
    assert [(each.played.spec, each.played.variant, len(each.accounts)) for each in found] == [
        ("easy", "v0", 50),
        ("soon", "v0", 50),
    ]
    assert played.counts == {"room:v0": 50, "hopeless": 50}
    assert tuple(found) == baseline_of(suite)


def test_a_baseline_has_the_episodes_of_the_case_that_asks_for_most(game: Path) -> None:
    edit("game.toml", 'level = "room.toml"\nvariant = "v1"', 'level = "room.toml"\nepisodes = 30\nvariant = "v1"')
    edit("game.toml", "episodes = 50", "episodes = 25")
    found = [each.reference for each in record_baseline(read_suite(Path("game.toml")), 1, Played())]
    assert [(each.played.spec, len(each.accounts)) for each in found] == [("easy", 30), ("soon", 25)]


def test_levels_of_one_name_have_a_baseline_each(game: Path) -> None:
    Path("other").mkdir()
    shutil.copy("room.toml", "other/room.toml")
    again = '[[case]]\nname = "other"\nlevel = "./other//room.toml"\npolicy = "easy.safetensors"\n'
    edit("game.toml", SUITE, SUITE.replace("episodes = 50", "episodes = 25") + again)
    suite = read_suite(Path("game.toml"))
    found = [each.reference for each in record_baseline(suite, 1, Played())]
    assert [(each.played.spec, each.played.place) for each in found] == [
        ("easy", "room.toml"),
        ("soon", "room.toml"),
        ("easy", "other/room.toml"),
    ]


def test_a_baseline_of_what_cannot_be_played_is_refused_before_anything_is_played(game: Path) -> None:
    suite, played = read_suite(Path("game.toml")), Played()
    Path("soon.safetensors").write_bytes(b"no policy")
    with pytest.raises(TltlError, match="case `hopeless`: "):
        list(write_recorded(suite, Path("new.json"), 1, played))
    assert played.counts == {} and not list(Path().glob("new.json*"))


def test_what_a_case_comes_to_where_nothing_changes(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    easy, _, hopeless = suite.cases
    good, bad = baseline_of(suite)
    assert verdict_as_it_is(suite, easy, good) == "pass"
    assert verdict_as_it_is(suite, hopeless, bad) == "fail"
    some = replace(good, accounts=tuple(replace(each, success=each.index % 10 > 0) for each in good.accounts))
    assert verdict_as_it_is(suite, easy, some) == "review", "nine of ten are too few to be certain"
    assert verdict_as_it_is(suite, replace(easy, episodes=25), good) == "review", "so are 25 episodes"


def test_a_baseline_that_was_stopped_goes_on(game: Path) -> None:
    suite, path = read_suite(Path("game.toml")), Path("new.json")
    with closing(write_recorded(suite, path, 1, Played())) as stopped:
        first = next(stopped)
    assert ([case.name for case in first.cases], len(first.reference.accounts)) == (["room:v0", "room:v1"], 50)
    assert not path.exists()
    played = Played()
    found = [each.reference for each in write_recorded(suite, path, 1, played)]
    assert played.counts == {"hopeless": 50}
    assert tuple(found) == read_baseline(path) == baseline_of(suite)
    assert sorted(place.name for place in Path().glob("new.json*")) == ["new.json"]
    # What is over is recorded anew, since levels may play otherwise.
    list(write_recorded(suite, path, 1, again := Played()))
    assert again.counts == {"room:v0": 50, "hopeless": 50}


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="descriptors have no names here")
def test_a_baseline_goes_into_a_pipe(game: Path) -> None:
    there, here = os.pipe()
    with ThreadPoolExecutor(1) as readers, os.fdopen(there, encoding="utf-8") as pipe:
        read = readers.submit(pipe.read)
        try:
            list(write_recorded(read_suite(Path("game.toml")), Path(f"/dev/fd/{here}"), 1, Played()))
        finally:
            os.close(here)
        assert read.result() == Path("game.baseline.json").read_text(encoding="utf-8")


def test_what_is_over_is_kept_beside_what_a_link_leads_to(game: Path) -> None:
    Path("kept").mkdir()
    Path("new.json").symlink_to("kept/new.json")
    with closing(write_recorded(read_suite(Path("game.toml")), Path("new.json"), 1, Played())) as stopped:
        next(stopped)
    assert [path.name for path in Path("kept").iterdir()] == ["new.json.partial"]
    assert not Path("new.json.partial").exists()


def test_what_was_kept_of_a_baseline_by_other_code_is_played_again(game: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    suite, path = read_suite(Path("game.toml")), Path("new.json")
    with closing(write_recorded(suite, path, 1, Played())) as stopped:
        next(stopped)
    monkeypatch.setattr("tltl_runtime.regression.suite.result_cache.sources_hash", lambda: "0" * 64)
    list(write_recorded(suite, path, 1, played := Played()))
    assert played.counts == {"room:v0": 50, "hopeless": 50}


def test_what_is_recorded_afresh_goes_on_with_its_own_alone(game: Path) -> None:
    suite, path = read_suite(Path("game.toml")), Path("new.json")
    with closing(write_recorded(suite, path, 1, Played())) as stopped:
        next(stopped)
    for first in (True, False):
        played = Played()
        with closing(write_recorded(suite, path, 1, played, fresh=True)) as stopped:
            next(stopped)
        assert bool(played.counts) == first


def test_what_an_older_baseline_has_is_taken_where_nothing_has_changed_and_not_kept_beside(game: Path) -> None:
    suite, path, played = read_suite(Path("game.toml")), Path("new.json"), Played()
    older = baseline_of(suite)
    assert tuple(each.reference for each in write_recorded(suite, path, 1, played, older)) == older
    assert played.counts == {} and read_baseline(path) == older
    with closing(write_recorded(suite, path, 1, played, older)) as stopped:
        next(stopped)
    # Whoever wants all afresh does not go on with it.
    list(write_recorded(suite, path, 1, played))
    assert played.counts == {"room:v0": 50, "hopeless": 50}
