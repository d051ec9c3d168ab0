"""The files that ``tltlc play`` records to: no recording is lost, and no file is overwritten."""

from __future__ import annotations

from pathlib import Path

import click
import pytest

from tltl_runtime.cli.support.recording_files import RecordingFiles
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.recordings.file import read_episode
from tltlc.diagnostics.diagnostic import TltlError


def test_a_recording_is_saved_elsewhere_if_its_folder_is_unwritable(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    env = RecordEpisode(make_env("navigation"), "keyboard")
    env.reset(seed=1)
    env.step([1, 0, 0, 0, 0])
    wanted, spare = tmp_path / "wanted", tmp_path / "spare"
    wanted.mkdir()
    spare.mkdir()
    monkeypatch.setattr("tltl_runtime.cli.support.recording_files.gettempdir", lambda: str(spare))
    files = RecordingFiles(wanted, "navigation-v0")
    wanted.rmdir()
    assert files.save(env.episode) == str(spare / "navigation-v0.episode.npz")
    assert files.save(env.episode) == str(spare / "navigation-v0-2.episode.npz")
    assert "TLT0005" in capsys.readouterr().err
    assert len(read_episode(spare / "navigation-v0.episode.npz").actions) == 1
    env.close()


def test_the_target_is_a_folder_or_a_recording_name(tmp_path: Path) -> None:
    with pytest.raises(click.UsageError, match=r"a folder or a name that ends with \.episode\.npz"):
        RecordingFiles(tmp_path / "mine.txt", "x")
    with pytest.raises(TltlError, match=r"TLT0005: cannot record to `.*nowhere`: there is no such folder"):
        RecordingFiles(tmp_path / "nowhere" / "mine.episode.npz", "x")
    RecordingFiles(tmp_path / "new" / "runs", "x")
    assert (tmp_path / "new" / "runs").is_dir()


def test_no_recording_is_lost_or_overwritten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    env = RecordEpisode(make_env("navigation"), "keyboard")
    env.reset(seed=1)
    env.step([1, 0, 0, 0, 0])
    older = tmp_path / "mine.episode.npz"
    older.write_bytes(b"older")
    files = RecordingFiles(older, "x")
    files.keep(env.episode)
    assert len(read_episode(tmp_path / "mine.unfinished.episode.npz").actions) == 1
    # The unfinished recording of a killed process stays, too.
    other = RecordingFiles(older, "x")
    other.keep(env.episode)
    assert files.save(env.episode) == str(tmp_path / "mine-2.episode.npz")
    assert older.read_bytes() == b"older"
    names = {"mine.episode.npz", "mine-2.episode.npz", "mine.unfinished-2.episode.npz"}
    assert {path.name for path in tmp_path.iterdir()} == names
    assert "stopped after 0.15 s, remaining: Reach near(s1)" in capsys.readouterr().out
    env.close()
