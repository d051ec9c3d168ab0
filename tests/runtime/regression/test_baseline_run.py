"""Recording baselines, stopping, and resuming."""

from __future__ import annotations

import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest

from tests.runtime.regression.game import SUITE, Played, edit
from tests.runtime.regression.handmade import changed
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tltl_runtime.regression.suite.suite import read_suite
from tltl_runtime.regression.verdict.baseline import baseline_of, read_baseline
from tltl_runtime.regression.verdict.baseline_run import (
    record_and_write_baseline,
    record_baseline,
    verdict_if_unchanged,
)
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError


def test_a_baseline_plays_all_episodes_of_each_reference_once(game: Path) -> None:
    suite, played = read_suite(Path("game.toml")), Played()
    references = [recorded.reference for recorded in record_baseline(suite, 1, played)]
    assert [(reference.played.spec, reference.played.variant, len(reference.episodes)) for reference in references] == [
        ("easy", "v0", 50),
        ("soon", "v0", 50),
    ]
    assert played.counts == {"room:v0": 50, "hopeless": 50}
    assert tuple(references) == baseline_of(suite)


def test_a_reference_has_the_most_episodes_that_a_case_asks_for(game: Path) -> None:
    edit("game.toml", 'level = "room.toml"\nvariant = "v1"', 'level = "room.toml"\nepisodes = 30\nvariant = "v1"')
    edit("game.toml", "episodes = 50", "episodes = 25")
    references = [recorded.reference for recorded in record_baseline(read_suite(Path("game.toml")), 1, Played())]
    assert [(reference.played.spec, len(reference.episodes)) for reference in references] == [
        ("easy", 30),
        ("soon", 25),
    ]


def test_levels_with_the_same_name_have_separate_references(game: Path) -> None:
    Path("other").mkdir()
    shutil.copy("room.toml", "other/room.toml")
    other_case = '[[case]]\nname = "other"\nlevel = "./other//room.toml"\npolicy = "easy.safetensors"\n'
    edit("game.toml", SUITE, SUITE.replace("episodes = 50", "episodes = 25") + other_case)
    suite = read_suite(Path("game.toml"))
    references = [recorded.reference for recorded in record_baseline(suite, 1, Played())]
    assert [(reference.played.spec, reference.played.place) for reference in references] == [
        ("easy", "room.toml"),
        ("soon", "room.toml"),
        ("easy", "other/room.toml"),
    ]


def test_a_case_that_cannot_be_played_is_reported_before_anything_is_played(game: Path) -> None:
    suite, played = read_suite(Path("game.toml")), Played()
    Path("soon.safetensors").write_bytes(b"no policy")
    with pytest.raises(TltlError, match="case `hopeless`: "):
        list(record_and_write_baseline(suite, Path("new.json"), 1, played))
    assert played.counts == {} and not list(Path().glob("new.json*"))


def test_the_verdict_of_a_case_if_nothing_changes(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    easy, _, hopeless = suite.cases
    good, bad = baseline_of(suite)
    assert verdict_if_unchanged(suite, easy, good) == "pass"
    assert verdict_if_unchanged(suite, hopeless, bad) == "fail"
    sometimes_failing = replace(
        good,
        episodes=tuple(changed(explained, success=explained.summary.index % 10 > 0) for explained in good.episodes),
    )
    assert verdict_if_unchanged(suite, easy, sometimes_failing) == "review", "nine of ten are too few to be certain"
    assert verdict_if_unchanged(suite, replace(easy, episodes=25), good) == "review", "so are 25 episodes"


def test_a_stopped_baseline_resumes(game: Path) -> None:
    suite, path = read_suite(Path("game.toml")), Path("new.json")
    with closing(record_and_write_baseline(suite, path, 1, Played())) as stopped:
        first = next(stopped)
    assert ([case.name for case in first.cases], len(first.reference.episodes)) == (["room:v0", "room:v1"], 50)
    assert not path.exists()
    played = Played()
    references = [recorded.reference for recorded in record_and_write_baseline(suite, path, 1, played)]
    assert played.counts == {"hopeless": 50}
    assert tuple(references) == read_baseline(path) == baseline_of(suite)
    assert sorted(place.name for place in Path().glob("new.json*")) == ["new.json"]
    # A complete baseline is recorded from the start again, since the levels may have changed.
    list(record_and_write_baseline(suite, path, 1, again := Played()))
    assert again.counts == {"room:v0": 50, "hopeless": 50}


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="descriptors have no names here")
def test_a_baseline_is_written_into_a_pipe(game: Path) -> None:
    read_end, write_end = os.pipe()
    with ThreadPoolExecutor(1) as readers, os.fdopen(read_end, encoding="utf-8") as pipe:
        text = readers.submit(pipe.read)
        try:
            list(record_and_write_baseline(read_suite(Path("game.toml")), Path(f"/dev/fd/{write_end}"), 1, Played()))
        finally:
            os.close(write_end)
        assert text.result() == Path("game.baseline.json").read_text(encoding="utf-8")


def test_the_partial_file_lies_beside_the_target_of_a_link(game: Path) -> None:
    Path("kept").mkdir()
    Path("new.json").symlink_to("kept/new.json")
    with closing(record_and_write_baseline(read_suite(Path("game.toml")), Path("new.json"), 1, Played())) as stopped:
        next(stopped)
    assert [path.name for path in Path("kept").iterdir()] == ["new.json.partial"]
    assert not Path("new.json.partial").exists()


def test_a_partial_baseline_of_other_code_is_not_used(game: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    suite, path = read_suite(Path("game.toml")), Path("new.json")
    with closing(record_and_write_baseline(suite, path, 1, Played())) as stopped:
        next(stopped)
    monkeypatch.setattr("tltl_runtime.regression.suite.result_cache.sources_hash", lambda: "0" * 64)
    list(record_and_write_baseline(suite, path, 1, played := Played()))
    assert played.counts == {"room:v0": 50, "hopeless": 50}


def test_a_fresh_recording_resumes_only_its_own_partial_file(game: Path) -> None:
    suite, path = read_suite(Path("game.toml")), Path("new.json")
    with closing(record_and_write_baseline(suite, path, 1, Played())) as stopped:
        next(stopped)
    for first in (True, False):
        played = Played()
        with closing(record_and_write_baseline(suite, path, 1, played, fresh=True)) as stopped:
            next(stopped)
        assert bool(played.counts) == first


def test_an_older_baseline_replaces_playing_where_nothing_has_changed(game: Path) -> None:
    suite, path, played = read_suite(Path("game.toml")), Path("new.json"), Played()
    older = baseline_of(suite)
    assert tuple(recorded.reference for recorded in record_and_write_baseline(suite, path, 1, played, older)) == older
    assert played.counts == {} and read_baseline(path) == older
    with closing(record_and_write_baseline(suite, path, 1, played, older)) as stopped:
        next(stopped)
    # References taken from the older baseline are not in the partial file.
    list(record_and_write_baseline(suite, path, 1, played))
    assert played.counts == {"room:v0": 50, "hopeless": 50}
