"""``tltlc record``: demonstrations by the expert, and by a person on a real X server."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.cli.test_play import PLAYERS, ended, needs_screen, started
from tests.runtime.stealth.xvfb import keys, screen
from tests.runtime.training.imitating import SOON, recorded_episode, write_recordings
from tests.waiting import HANG_S
from tltl_runtime.cli.record import _DemonstrationRecorder
from tltl_runtime.game.recording_check import check
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.training.imitation.demonstrations import Demonstrations

TltlcFunction = Callable[..., Outcome]

IN_VAIN = "import spatial\nentity exit\nspec vain { limit 2 steps\n reach near(exit) }\n"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, which contains only a spec that is met after a few steps."""
    (tmp_path / "soon.tltl").write_text(SOON)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def names(folder: Path) -> list[str]:
    return sorted(path.name.removesuffix(".episode.npz") for path in folder.iterdir())


def test_the_expert_records_until_there_are_enough(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    folder = here / "demonstrations" / "cover_and_hide-v0-soon"
    result = tltlc("record", "--spec", "soon.tltl", "--episodes", "2")
    assert (result.status, result.err) == (0, "")
    first, second, summary, hint = result.out.splitlines()
    assert re.fullmatch(r"seed 0: success after 8 steps, 1\.20 s, progress 1\.00, .*-0\.episode\.npz \(1 of 2\)", first)
    assert second.endswith("cover_and_hide-v0-1.episode.npz (2 of 2)")
    assert summary == "2 of 2 demonstrations are in demonstrations/cover_and_hide-v0-soon"
    assert hint == (
        "to imitate them: tltlc train soon.tltl --level cover_and_hide:v0 --method imitation "
        "--demonstrations demonstrations/cover_and_hide-v0-soon"
    )
    episode = read_episode(folder / "cover_and_hide-v0-0.episode.npz")
    assert (episode.player, episode.success) == ("expert", True)
    assert not check(episode)
    resumed = tltlc("record", "--spec", "soon.tltl", "--episodes", "3")
    assert (resumed.status, resumed.err) == (
        0,
        "2 of 3 demonstrations are in demonstrations/cover_and_hide-v0-soon already\n",
    )
    assert names(folder) == [f"cover_and_hide-v0-{seed}" for seed in range(3)]
    assert "seed 2: " in resumed.out and "seed 1: " not in resumed.out
    again = tltlc("record", "--spec", "soon.tltl", "--episodes", "3")
    assert (again.status, again.err, len(again.out.splitlines())) == (0, "", 2)
    assert again.out.startswith("3 of 3 demonstrations are in demonstrations/cover_and_hide-v0-soon\n")
    for count in ("2", "1"):
        fewer = tltlc("record", "--spec", "soon.tltl", "--episodes", count)
        assert (fewer.status, fewer.err) == (0, "")
        summary, _ = fewer.out.splitlines()
        assert summary == f"3 demonstrations are in demonstrations/cover_and_hide-v0-soon; you asked for {count}"


def test_failed_episodes_are_reported_and_not_kept(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    (here / "vain.tltl").write_text(IN_VAIN)
    result = tltlc("record", "cover_and_hide", "--spec", "vain.tltl", "--episodes", "1", "-o", "none")
    assert result.status == 1
    assert result.out.splitlines()[:2] == [
        "seed 0: limit after 2 steps, 0.30 s, progress 0.56, return -0.439: not kept (0 of 1)",
        "  the expert finds no way to `exit`; limit after 2 steps, remaining: Reach near(exit)",
    ]
    assert result.err.startswith("error[TLT0920]: the expert failed to meet `vain` in 20 episodes in a row")
    assert not (here / "none").exists()


def test_other_recordings_in_the_folder_stay(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    folder = write_recordings(here / "mine", recorded_episode(5), recorded_episode(7, variant="v1"))
    before = {path: path.read_bytes() for path in folder.iterdir()}
    result = tltlc("record", "cover_and_hide", "--spec", "soon.tltl", "--episodes", "2", "-o", "mine")
    assert result.status == 0
    assert result.err.splitlines() == [
        "1 of 2 demonstrations are in mine already",
        "1 recording in the folder is not a demonstration of this level and spec: "
        "`cover_and_hide-v1-7.episode.npz` (it is of another level)",
    ]
    assert {path: path.read_bytes() for path in before} == before
    assert names(folder) == ["cover_and_hide-v0-0", "cover_and_hide-v0-5", "cover_and_hide-v1-7"]


def test_a_damaged_recording_does_not_count_and_stays(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    folder = write_recordings(here / "mine", recorded_episode(5))
    (folder / "damaged.episode.npz").write_bytes(b"PK, and no more")
    result = tltlc("record", "cover_and_hide", "--spec", "soon.tltl", "--episodes", "2", "-o", "mine")
    assert result.status == 0
    _, other = result.err.splitlines()
    assert other.startswith(
        "1 recording in the folder is not a demonstration of this level and spec: `damaged.episode.npz` (TLT0820, "
    )
    assert (folder / "damaged.episode.npz").read_bytes() == b"PK, and no more"
    assert names(folder) == ["cover_and_hide-v0-0", "cover_and_hide-v0-5", "damaged"]
    (folder / "empty.episode.npz").write_bytes(b"")
    again = tltlc("record", "cover_and_hide", "--spec", "soon.tltl", "--episodes", "2", "-o", "mine")
    (line,) = again.err.splitlines()
    assert line.startswith("2 recordings in the folder are not demonstrations of this level and spec: `damaged.")
    assert line.endswith(") and 1 more")


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        ([], 2, "say what to play: a level, or a --spec that names one"),
        (["--spec", "nameless.tltl"], 2, "`soon` does not name a level: name one as LEVEL"),
        (["nowhere"], 2, "error[TLT08"),
        (["cover_and_hide", "--episodes", "0"], 2, "--episodes"),
        (["cover_and_hide", "--by", "ghost"], 2, "--by"),
        (["cover_and_hide", "--by", "keyboard", "-o", "nameless.tltl/mine"], 3, "TLT0005]: cannot write to `nameless"),
    ],
)
def test_invalid_options_are_rejected(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    arguments: list[str],
    status: int,
    message: str,
) -> None:
    (here / "nameless.tltl").write_text(SOON.replace("level cover_and_hide", ""))
    result = tltlc("record", *arguments)
    assert (result.status, result.out) == (status, "")
    assert message in result.err
    assert not (here / "demonstrations").exists()


@pytest.mark.parametrize(("name", "status"), [("SIGTERM", 143), ("SIGINT", 130)])
def test_a_signal_ends_it_with_the_number_of_demonstrations(here: Path, name: str, status: int) -> None:
    command = [sys.executable, "-m", "tltlc", "record", "--spec", "soon.tltl", "--episodes", "9000", "-o", "many"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as recording:
        assert recording.stdout is not None
        recording.stdout.readline()
        recording.send_signal(getattr(signal, name))
        _, err = recording.communicate(timeout=HANG_S)
    assert recording.returncode == status
    assert re.fullmatch(
        r"stopped: \d+ of 9000 demonstrations are in many; run the same command again to continue\n", err
    )
    assert len(names(here / "many")) == int(err.split()[1]) >= 1


@pytest.mark.slow
@needs_screen
def test_a_person_records_until_there_are_enough(here: Path) -> None:
    words = ("record", "cover_and_hide", "--by", "keyboard", "--spec", "soon.tltl")
    with screen() as display:
        player = started(display, here, *words, "--episodes", "2", "--seed", "4", "-o", "mine")
        assert player.process.stdout is not None
        keys(display, "keydown", "d")
        lines = [player.process.stdout.readline().strip()]
        keys(display, "keyup", "d")
        player.until_it_looked(1, lambda line: not any(line["looked"]))
        player.begin_again()
        keys(display, "keydown", "d")
        lines.append(player.process.stdout.readline().strip())
        # Ask for another episode; there are enough demonstrations, so the game ends.
        keys(display, "keyup", "d", "key", "r")
        rest = ended(player).splitlines()
        PLAYERS.remove(player.process)
    assert lines[0].startswith("seed 4: success after 8 steps") and lines[0].endswith("(1 of 2)")
    assert lines[1].endswith("(2 of 2)")
    assert rest[0] == "2 of 2 demonstrations are in mine"
    episodes = [read_episode(path) for path in (here / "mine").iterdir()]
    assert [(episode.player, episode.success) for episode in episodes] == [("keyboard", True)] * 2


def test_failed_episodes_of_a_person_are_not_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    env = make_env("cover_and_hide", "v0", SOON)
    demonstrations = Demonstrations(tmp_path, env.unwrapped.level, env.task)  # type: ignore[attr-defined]
    env.close()
    recorder = _DemonstrationRecorder(demonstrations, 2)
    recorder.keep(recorded_episode(4, steps=3))
    assert recorder.save(recorded_episode(4, steps=5)) == "not kept, 0 of 2"
    assert not list(tmp_path.iterdir())
    assert recorder.save(recorded_episode(4)) == "cover_and_hide-v0-4.episode.npz, 1 of 2"
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("seed 4: stopped after 5 steps") and lines[0].endswith("not kept (0 of 2)")
    assert lines[1] == "  stopped after 0.75 s, remaining: Keep alive throughout"
    assert lines[2].endswith("(1 of 2)")


def test_a_recording_is_saved_elsewhere_if_its_folder_is_unwritable(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    spare, folder = tmp_path / "spare", tmp_path / "mine"
    spare.mkdir()
    monkeypatch.setattr("tltl_runtime.cli.support.recording_files.gettempdir", lambda: str(spare))
    env = make_env("cover_and_hide", "v0", SOON)
    demonstrations = Demonstrations(folder, env.unwrapped.level, env.task)  # type: ignore[attr-defined]
    env.close()
    recorder = _DemonstrationRecorder(demonstrations, 2)
    folder.touch()
    saved = spare / "cover_and_hide-v0-4.episode.npz"
    assert recorder.save(recorded_episode(4)) == f"{saved}, 0 of 2"
    assert read_episode(saved).success
    output = capsys.readouterr()
    assert output.err.startswith("TLT0005: cannot write ")
    assert output.out.rstrip().endswith(f": {saved} (0 of 2, not counted until you move it to {folder})")
    folder.unlink()
    assert recorder.save(recorded_episode(5)) == "cover_and_hide-v0-5.episode.npz, 1 of 2"
