"""``tltlc demonstrate``: episodes of the scripted expert."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.cli.signals import signal_at_call, with_signals  # noqa: F401
from tests.waiting import HANG_S
from tltl_runtime.game.recording_check import check
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.recordings.file import read_episode


def test_each_played_episode_is_recorded(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    folder = tmp_path / "new" / "runs"
    result: Outcome = tltlc("demonstrate", "cover_and_hide:v0", "--seed", "5", "--episodes", "2", "-o", str(folder))
    assert (result.status, result.err) == (0, "")
    assert result.out.splitlines()[-1] == "2 of 2 succeeded"
    names = [f"cover_and_hide-v0-{seed}" for seed in (5, 6)]
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        name + ending for name in names for ending in (".episode.npz", ".png")
    )
    episode = read_episode(folder / f"{names[0]}.episode.npz")
    assert (episode.player, episode.success, episode.end) == ("expert", True, "success")
    assert not check(episode)
    assert (folder / f"{names[0]}.png").read_bytes().startswith(b"\x89PNG")


def test_equal_episodes_are_rewritten_and_other_files_are_kept(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    spec, folder = _soon(tmp_path), tmp_path / "runs"
    for options in ([], [], ["--careless"]):
        tltlc("demonstrate", "cover_and_hide", "--spec", spec, "-o", str(folder), *options)
    names = ["cover_and_hide-v0-0", "cover_and_hide-v0-0-2"]
    assert [read_episode(folder / f"{name}.episode.npz").player for name in names] == ["expert", "careless expert"]
    assert sorted(path.name for path in folder.glob("*.png")) == sorted(f"{name}.png" for name in names)


def test_other_pictures_are_not_overwritten(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    folder = tmp_path / "runs"
    folder.mkdir()
    other_picture = folder / "cover_and_hide-v0-0.png"
    other_picture.write_text("mine")
    tltlc("demonstrate", "cover_and_hide", "--spec", _soon(tmp_path), "-o", str(folder))
    assert other_picture.read_text() == "mine"
    stem = "cover_and_hide-v0-0-2"
    assert {path.name for path in folder.iterdir()} == {other_picture.name, f"{stem}.png", f"{stem}.episode.npz"}


def test_a_failed_episode_gives_status_1(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    (tmp_path / "never.tltl").write_text("import stealth\nspec never { limit 5 steps\n reach seen }")
    spec = f"{tmp_path / 'never.tltl'}"
    result: Outcome = tltlc("demonstrate", "cover_and_hide", "--careless", "--spec", spec, "-o", str(tmp_path))
    assert result.status == 1
    assert result.out.startswith("seed 0: limit after 5 steps, 0.75 s, progress ")
    reason = "  the expert has nowhere to go; limit after 5 steps, remaining: Reach seen"
    assert result.out.splitlines()[1] == reason


def test_a_film_is_written_with_the_episode(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc(
        "demonstrate", "cover_and_hide", "--spec", _soon(tmp_path), "-o", str(tmp_path), "--film", "gif"
    )
    assert result.status == 0, result.err
    with Image.open(tmp_path / "cover_and_hide-v0-0.gif") as film:
        assert (film.size, film.n_frames) == ((640, 480), 4)


def _soon(folder: Path) -> str:
    """Write a spec that is met after three steps; return its path."""
    (folder / "soon.tltl").write_text("import stealth\nspec soon { limit 3 steps\n keep alive }")
    return str(folder / "soon.tltl")


SIGNALS = pytest.mark.parametrize(("name", "status"), [("SIGTERM", 143), ("SIGINT", 130)])


@SIGNALS
def test_a_signal_ends_it_with_the_number_of_recordings(
    with_signals,  # type: ignore[no-untyped-def] # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    status: int,
) -> None:
    monkeypatch.chdir(tmp_path)
    # The signal arrives in the second step of the second episode.
    signal_at_call(monkeypatch, RecordEpisode, "step", getattr(signal, name), call=3 + 2)
    result: Outcome = with_signals("demonstrate", "cover_and_hide", "--spec", _soon(tmp_path), "--episodes", "900")
    assert (result.status, result.err) == (status, "stopped: 1 of 900 episodes were recorded\n")
    assert [path.name for path in (tmp_path / "demonstrations").glob("*.npz")] == ["cover_and_hide-v0-0.episode.npz"]


@pytest.mark.slow
@SIGNALS
def test_a_signal_ends_a_process_with_the_number_of_recordings(tmp_path: Path, name: str, status: int) -> None:
    command = [sys.executable, "-m", "tltlc", "demonstrate", "cover_and_hide", "--careless", "--episodes", "900"]
    with subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as demonstrating:
        assert demonstrating.stdout is not None
        demonstrating.stdout.readline()
        demonstrating.send_signal(getattr(signal, name))
        _, err = demonstrating.communicate(timeout=HANG_S)
    assert demonstrating.returncode == status
    assert re.fullmatch(r"stopped: \d+ of 900 episodes were recorded\n", err)
    count = int(err.split()[1])
    assert len(list((tmp_path / "demonstrations").glob("*.episode.npz"))) >= count >= 1


@pytest.mark.parametrize(("level", "status"), [("nowhere", 2), ("cover_and_hide:v9", 2)])
def test_an_unknown_level_is_rejected(tltlc, tmp_path: Path, level: str, status: int) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("demonstrate", level, "-o", str(tmp_path))
    assert (result.status, result.out) == (status, "")
    assert "error[TLT08" in result.err


def test_an_unreachable_goal_is_reported_first(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    (tmp_path / "far.tltl").write_text("import spatial\nentity exit\nspec far { limit 5 steps\n reach near(exit) }")
    result: Outcome = tltlc(
        "demonstrate", "navigation:v2", "--spec", str(tmp_path / "far.tltl"), "-o", str(tmp_path), "--careless"
    )
    assert result.status == 1
    assert result.err == (
        "warning[TLT0814]: nobody can reach `exit` in `navigation:v2`, so nobody can do what `far` asks\n"
        "  help: the way ends at `corridor_block_2`, which is 2.2 m high\n"
    )
