"""The episodes that are kept as demonstrations, and the number that the expert plays."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from tests import pipes
from tests.runtime.training.imitating import SOON, recorded_episode, write_recordings
from tests.runtime.training.test_settings import compare
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.expert.expert import expert_episodes
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.training.imitation.demonstrations import (
    MOST_FAILURES,
    Attempt,
    Demonstrations,
    expert_attempts,
    recordings,
)
from tltlc.diagnostics.diagnostic import TltlError

IN_VAIN = "import spatial\nentity exit\nspec vain { level cover_and_hide\n limit 2 steps\n reach near(exit) }\n"
"""A spec that no player can meet."""
LONGER = SOON.replace("8 steps", "9 steps")


@pytest.fixture(name="env")
def _env() -> Iterator[RecordEpisode]:
    env = RecordEpisode(make_env("cover_and_hide", "v0", SOON), "expert")
    yield env
    env.close()


def demonstrations_in(env: RecordEpisode, folder: Path) -> Demonstrations:
    return Demonstrations(folder, env.get_wrapper_attr("level"), env.get_wrapper_attr("task"))


def test_only_episodes_that_meet_the_spec_are_kept(env: RecordEpisode, tmp_path: Path) -> None:
    demonstrations = demonstrations_in(env, tmp_path / "new")
    good, stopped = demonstrations.add(recorded_episode(3)), demonstrations.add(recorded_episode(4, steps=5))
    assert good.path == tmp_path / "new" / "cover_and_hide-v0-3.episode.npz"
    assert (stopped.path, good.kept, stopped.kept, demonstrations.count) == (None, 1, 1, 1)
    pipes.put_beside(tmp_path / "new" / "pipe.episode.npz")
    assert recordings(tmp_path / "new") == [good.path]
    assert read_episode(good.path).seed == 3


def test_existing_recordings_of_the_level_and_the_spec_count(env: RecordEpisode, tmp_path: Path) -> None:
    folder = write_recordings(
        tmp_path / "old",
        recorded_episode(1),
        recorded_episode(2, variant="v1"),
        recorded_episode(3, LONGER, steps=9),
        recorded_episode(4, steps=7),
    )
    demonstrations = demonstrations_in(env, folder)
    assert (demonstrations.count, demonstrations.seeds("me"), demonstrations.seeds("expert")) == (1, [1], [])
    assert [(recording.path.name.split("-", 1)[1], recording.reason) for recording in demonstrations.rejected] == [
        ("v0-3.episode.npz", "it is of another spec"),
        ("v0-4.episode.npz", "it does not meet the spec"),
        ("v1-2.episode.npz", "it is of another level"),
    ]


def test_an_unreadable_recording_does_not_count(env: RecordEpisode, tmp_path: Path) -> None:
    folder = write_recordings(tmp_path / "old", recorded_episode(1), recorded_episode(2))
    damaged = recordings(folder)[1]
    damaged.write_bytes(damaged.read_bytes()[:1000])
    demonstrations = demonstrations_in(env, folder)
    assert demonstrations.seeds("me") == [1]
    (recording,) = demonstrations.rejected
    assert recording.path == damaged and recording.reason.startswith("TLT0820, ")


def test_the_expert_records_only_the_missing_demonstrations(env: RecordEpisode, tmp_path: Path) -> None:
    first = list(islice(expert_attempts(env, demonstrations_in(env, tmp_path), 3, seed=5), 2))
    assert [(attempt.episode.seed, attempt.kept) for attempt in first] == [(5, 1), (6, 2)]
    times = {path: path.stat().st_mtime_ns for path in recordings(tmp_path)}
    rest = list(expert_attempts(env, demonstrations_in(env, tmp_path), 3, seed=5))
    assert [(attempt.episode.seed, attempt.kept) for attempt in rest] == [(7, 3)]
    assert {path: path.stat().st_mtime_ns for path in times} == times
    assert not list(expert_attempts(env, demonstrations_in(env, tmp_path), 3, seed=5))
    # With another first seed, existing demonstrations are not played again.
    assert [attempt.episode.seed for attempt in expert_attempts(env, demonstrations_in(env, tmp_path), 4, seed=0)] == [
        8
    ]


def test_the_seeds_of_a_person_do_not_count_for_the_expert(env: RecordEpisode, tmp_path: Path) -> None:
    write_recordings(tmp_path, recorded_episode(900))
    assert [attempt.episode.seed for attempt in expert_attempts(env, demonstrations_in(env, tmp_path), 2)] == [0]


def test_the_expert_gives_up_after_many_failures(tmp_path: Path) -> None:
    env = RecordEpisode(make_env("cover_and_hide", "v0", IN_VAIN), "expert")
    attempts: list[Attempt] = []
    with pytest.raises(TltlError) as caught:
        attempts.extend(expert_attempts(env, demonstrations_in(env, tmp_path / "none"), 2))
    env.close()
    compare("TLT0920", caught.value)
    assert not (tmp_path / "none").exists()
    assert not recordings(tmp_path)


def test_failures_are_reported_before_the_expert_gives_up(tmp_path: Path) -> None:
    env = RecordEpisode(make_env("cover_and_hide", "v0", IN_VAIN), "expert")
    attempts = list(islice(expert_attempts(env, demonstrations_in(env, tmp_path), 2), MOST_FAILURES))
    env.close()
    assert [(attempt.path, attempt.kept, attempt.episode.seed) for attempt in attempts] == [
        (None, 0, seed) for seed in range(MOST_FAILURES)
    ]


def test_the_expert_plays_the_given_seeds(env: RecordEpisode) -> None:
    assert [(episode.seed, episode.success) for episode in expert_episodes(env, (9, 4))] == [(9, True), (4, True)]
