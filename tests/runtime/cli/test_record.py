"""``tltlc record``: demonstrations of the expert, and of a person on a real X server."""

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
from tests.runtime.training.imitating import SOON, kept, played
from tests.waiting import HANG_S
from tltl_runtime.cli.record import _Kept
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.recordings.check import check
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.training.imitation.demonstrations import Demonstrations

TltlcFunction = Callable[..., Outcome]

IN_VAIN = "import spatial\nentity exit\nspec vain { limit 2 steps\n reach near(exit) }\n"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder but for a spec that is soon met, made the current one."""
    (tmp_path / "soon.tltl").write_text(SOON)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def names(folder: Path) -> list[str]:
    return sorted(path.name.removesuffix(".episode.npz") for path in folder.iterdir())


def test_the_expert_until_there_are_enough(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    folder = here / "demonstrations" / "cover_and_hide-v0-soon"
    found = tltlc("record", "--spec", "soon.tltl", "--episodes", "2")
    assert (found.status, found.err) == (0, "")
    first, second, there, hint = found.out.splitlines()
    assert re.fullmatch(r"seed 0: success after 8 steps, 1\.20 s, progress 1\.00, .*-0\.episode\.npz \(1 of 2\)", first)
    assert second.endswith("cover_and_hide-v0-1.episode.npz (2 of 2)")
    assert there == "2 of 2 demonstrations are in demonstrations/cover_and_hide-v0-soon"
    assert hint == (
        "to imitate them: tltlc train soon.tltl --level cover_and_hide:v0 --method imitation "
        "--demonstrations demonstrations/cover_and_hide-v0-soon"
    )
    episode = read_episode(folder / "cover_and_hide-v0-0.episode.npz")
    assert (episode.player, episode.success) == ("expert", True)
    assert not check(episode)
    more = tltlc("record", "--spec", "soon.tltl", "--episodes", "3")
    assert (more.status, more.err) == (
        0,
        "2 of 3 demonstrations are in demonstrations/cover_and_hide-v0-soon already\n",
    )
    assert names(folder) == [f"cover_and_hide-v0-{seed}" for seed in range(3)]
    assert "seed 2: " in more.out and "seed 1: " not in more.out
    again = tltlc("record", "--spec", "soon.tltl", "--episodes", "3")
    assert (again.status, again.err, len(again.out.splitlines())) == (0, "", 2)
    assert again.out.startswith("3 of 3 demonstrations are in demonstrations/cover_and_hide-v0-soon\n")
    for count, asked in (("2", "2 are asked for"), ("1", "1 is asked for")):
        fewer = tltlc("record", "--spec", "soon.tltl", "--episodes", count)
        assert (fewer.status, fewer.err) == (0, "")
        there, _ = fewer.out.splitlines()
        assert there == f"3 demonstrations are in demonstrations/cover_and_hide-v0-soon, and {asked}"


def test_what_fails_is_not_kept_and_is_told(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    (here / "vain.tltl").write_text(IN_VAIN)
    found = tltlc("record", "cover_and_hide", "--spec", "vain.tltl", "--episodes", "1", "-o", "none")
    assert found.status == 1
    assert found.out.splitlines()[:2] == [
        "seed 0: limit after 2 steps, 0.30 s, progress 0.56, return -0.439: not kept (0 of 1)",
        "  finds no way to `exit`; limit after 2 steps, remaining: Reach near(exit)",
    ]
    assert found.err.startswith("error[TLT0920]: the expert met `vain` in none of 20 episodes in a row")
    assert not (here / "none").exists()


def test_what_the_folder_holds_of_others_stays(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    folder = kept(here / "mine", played(5), played(7, variant="v1"))
    before = {path: path.read_bytes() for path in folder.iterdir()}
    found = tltlc("record", "cover_and_hide", "--spec", "soon.tltl", "--episodes", "2", "-o", "mine")
    assert found.status == 0
    assert found.err.splitlines() == [
        "1 of 2 demonstrations are in mine already",
        "1 recording there is none of this level and spec: `cover_and_hide-v1-7.episode.npz` (it is of another level)",
    ]
    assert {path: path.read_bytes() for path in before} == before
    assert names(folder) == ["cover_and_hide-v0-0", "cover_and_hide-v0-5", "cover_and_hide-v1-7"]


def test_a_damaged_recording_is_none_and_stays(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    folder = kept(here / "mine", played(5))
    (folder / "damaged.episode.npz").write_bytes(b"PK, and no more")
    found = tltlc("record", "cover_and_hide", "--spec", "soon.tltl", "--episodes", "2", "-o", "mine")
    assert found.status == 0
    _, other = found.err.splitlines()
    assert other.startswith("1 recording there is none of this level and spec: `damaged.episode.npz` (TLT0820, ")
    assert (folder / "damaged.episode.npz").read_bytes() == b"PK, and no more"
    assert names(folder) == ["cover_and_hide-v0-0", "cover_and_hide-v0-5", "damaged"]


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        ([], 2, "say what to play: a level, or a --spec that names one"),
        (["--spec", "nameless.tltl"], 2, "`soon` does not say which level it is about: name one as LEVEL"),
        (["nowhere"], 2, "error[TLT08"),
        (["cover_and_hide", "--episodes", "0"], 2, "--episodes"),
        (["cover_and_hide", "--by", "ghost"], 2, "--by"),
        (["cover_and_hide", "--by", "keyboard", "-o", "nameless.tltl/mine"], 3, "TLT0005]: cannot write to `nameless"),
    ],
)
def test_what_cannot_be_recorded(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    arguments: list[str],
    status: int,
    said: str,
) -> None:
    (here / "nameless.tltl").write_text(SOON.replace("level cover_and_hide", ""))
    found = tltlc("record", *arguments)
    assert (found.status, found.out) == (status, "")
    assert said in found.err
    assert not (here / "demonstrations").exists()


@pytest.mark.parametrize(("name", "status"), [("SIGTERM", 143), ("SIGINT", 130)])
def test_asked_to_end_it_says_what_there_is(here: Path, name: str, status: int) -> None:
    command = [sys.executable, "-m", "tltlc", "record", "--spec", "soon.tltl", "--episodes", "9000", "-o", "many"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as recording:
        assert recording.stdout is not None
        recording.stdout.readline()
        recording.send_signal(getattr(signal, name))
        _, err = recording.communicate(timeout=HANG_S)
    assert recording.returncode == status
    assert re.fullmatch(r"stopped: \d+ of 9000 demonstrations are in many; the same command goes on\n", err)
    assert len(names(here / "many")) == int(err.split()[1]) >= 1


@needs_screen
def test_a_person_until_there_are_enough(here: Path) -> None:
    words = ("record", "cover_and_hide", "--by", "keyboard", "--spec", "soon.tltl")
    with screen() as display:
        player = started(display, here, *words, "--episodes", "2", "--seed", "4", "-o", "mine")
        assert player.process.stdout is not None
        keys(display, "keydown", "d")
        said = [player.process.stdout.readline().strip()]
        keys(display, "keyup", "d")
        player.until_it_looked(1, lambda line: not any(line["looked"]))
        player.begin_again()
        keys(display, "keydown", "d")
        said.append(player.process.stdout.readline().strip())
        # Another one is asked for, and there are enough.
        keys(display, "keyup", "d", "key", "r")
        rest = ended(player).splitlines()
        PLAYERS.remove(player.process)
    assert said[0].startswith("seed 4: success after 8 steps") and said[0].endswith("(1 of 2)")
    assert said[1].endswith("(2 of 2)")
    assert rest[0] == "2 of 2 demonstrations are in mine"
    episodes = [read_episode(path) for path in (here / "mine").iterdir()]
    assert [(each.player, each.success) for each in episodes] == [("keyboard", True)] * 2


def test_of_a_person_too_nothing_is_kept_that_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    env = make_env("cover_and_hide", "v0", SOON)
    made = Demonstrations(tmp_path, env.unwrapped.level, env.task)  # type: ignore[attr-defined]
    env.close()
    taking = _Kept(made, 2)
    taking.keep(played(4, steps=3))
    assert taking.save(played(4, steps=5)) == "not kept, 0 of 2"
    assert not list(tmp_path.iterdir())
    assert taking.save(played(4)) == "cover_and_hide-v0-4.episode.npz, 1 of 2"
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith("seed 4: stopped after 5 steps") and said[0].endswith("not kept (0 of 2)")
    assert said[1] == "  stopped after 0.75 s, remaining: Keep alive throughout"
    assert said[2].endswith("(1 of 2)")


def test_what_its_folder_refuses_finds_another_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    spare, folder = tmp_path / "spare", tmp_path / "mine"
    spare.mkdir()
    monkeypatch.setattr("tltl_runtime.cli.support.recording_files.gettempdir", lambda: str(spare))
    env = make_env("cover_and_hide", "v0", SOON)
    made = Demonstrations(folder, env.unwrapped.level, env.task)  # type: ignore[attr-defined]
    env.close()
    taking = _Kept(made, 2)
    folder.touch()
    there = spare / "cover_and_hide-v0-4.episode.npz"
    assert taking.save(played(4)) == f"{there}, 0 of 2"
    assert read_episode(there).success
    said = capsys.readouterr()
    assert said.err.startswith("TLT0005: cannot write ")
    assert said.out.rstrip().endswith(f": {there} (0 of 2, until it is moved to {folder})")
    folder.unlink()
    assert taking.save(played(5)) == "cover_and_hide-v0-5.episode.npz, 1 of 2"
