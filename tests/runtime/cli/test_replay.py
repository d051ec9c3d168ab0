"""``tltlc replay``: summaries, checks, plans, films and traces of recorded episodes."""

from __future__ import annotations

import csv
import json
import shlex
import sys
from io import BytesIO, StringIO
from itertools import count
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from PIL import Image

import tltl_runtime.stealth.rendering.film as film
from tests.interfaces.cli.conftest import ROOT, Outcome, tltlc  # noqa: F401
from tltl_runtime.cli.replay import _VIEWS
from tltl_runtime.cli.support import keyboard_play
from tltl_runtime.cli.support.film_file import write_gif
from tltl_runtime.cli.support.notation import NOTATIONS
from tltl_runtime.game.palette import state_colour
from tltl_runtime.game.trace import monitor_command
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.films import StealthFilms
from tltl_runtime.stealth.keyboard_play import StealthKeyboard
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.file import write_episode
from tltl_runtime.stealth.rendering.camera import VIEWS
from tltl_runtime.stealth.rendering.film import STRIP, frames
from tltl_runtime.stealth.rendering.plan import draw_episode
from tltlc.automaton.fspa import Notation
from tltlc.core.record import replace
from tltlc.monitor import Monitor
from tltlc.monitor.traces import read_trace

STEPS = 20
FILE = "run.episode.npz"


@pytest.fixture(name="episode", scope="module")
def _episode() -> Episode:
    """An episode on branching up to the first switch, so that the state of the automaton changes."""
    env = RecordEpisode(make_env("branching"), player="hand")
    env.reset(seed=2)
    for step in range(STEPS):
        env.step([int(step >= 10), int(step < 10), 0, 0, 0])
    episode = env.episode
    env.close()
    assert set(episode.states.tolist()) == {0, 1}
    return episode


@pytest.fixture(name="recorded")
def _recorded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, episode: Episode) -> Path:
    """The current folder, which contains the recorded episode."""
    monkeypatch.chdir(tmp_path)
    write_episode(FILE, episode)
    return tmp_path


def test_the_text_summary(tltlc, recorded: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("replay", FILE)
    lines = result.out.splitlines()
    assert (result.status, result.err, lines[0]) == (0, "", FILE)
    assert lines[1] == "  level    branching:v0, spec branching"
    assert lines[2].startswith("  player   hand, seed ")
    assert lines[3] == "  end      stopped, pending, after 20 of 600 steps, 3.00 s"
    changes = lines[lines.index("    time  state  progress  what remains") + 1 :]
    assert changes[0].startswith("    0.00      0     0.000  Reach near(s1), then ")
    assert lines[4].startswith("  why      stopped after 3.00 s, remaining: Reach near(s2), then ")
    assert "◇(near(s1) ∧ " in tltlc("replay", FILE, "--notation", "unicode").out
    assert max(map(len, lines)) <= 80
    changes = [line for line in changes if line and not line.startswith(" " * 9)]
    assert [line.split()[1:3] for line in changes] == [["0", "0.000"], ["1", "0.250"]]


def test_the_end_is_stated_once(tltlc, recorded: Path, episode: Episode) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    write_episode("bad.episode.npz", replace(episode, end="violation", verdict="violated"))
    assert "  end      violation, after 20 of 600 steps, 3.00 s\n" in tltlc("replay", "bad.episode.npz").out


def test_the_mark_of_the_end_is_drawn_on_top(episode: Episode) -> None:
    def end_pixels(drawn: Episode) -> int:
        picture = np.asarray(Image.open(BytesIO(draw_episode(drawn))).convert("RGB"))
        return int((picture == (0x64, 0x74, 0x8B)).all(axis=2).sum())

    plain = replace(episode, end="limit")
    *before, last = plain.snapshots
    states = plain.states.copy()
    states[-1] = 2
    crowded = replace(plain, states=states, snapshots=(*before, replace(last, health=0.0)))
    assert end_pixels(crowded) > 0.95 * end_pixels(plain) > 100


def test_the_json_summary(tltlc, recorded: Path, episode: Episode) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("replay", FILE, FILE, "--format", "json", "--check")
    first, second = json.loads(result.out)
    assert first == second and result.status == 0
    assert (first["steps"], first["seed"], first["end"]) == (STEPS, episode.seed, "stopped")
    assert first["follows_from_spec"] and first["plays_again"]
    assert first["reward"] == pytest.approx(episode.rewards.sum())
    assert [change["state"] for change in first["changes"]] == [0, 1]
    assert first["cause"]["kind"] == "stopped" and first["cause"]["by"] == []


def test_a_failed_check_is_reported(tltlc, recorded: Path, episode: Episode) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    write_episode("bent.episode.npz", replace(episode, seed=episode.seed + 1, rewards=episode.rewards + 1e-9))
    result: Outcome = tltlc("replay", "bent.episode.npz", "--check")
    assert result.status == 1
    assert "error[TLT0823]: step 1 of the recording" in result.err and "error[TLT0824]" in result.err
    assert "the judgement does NOT follow from the signals; played again it is ANOTHER episode" in result.out
    assert tltlc("replay", "bent.episode.npz").status == 0


def test_a_broken_file_does_not_hide_other_files(tltlc, recorded: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    Path("cut.episode.npz").write_bytes(b"")
    result: Outcome = tltlc("replay", "cut.episode.npz", "gone.episode.npz", FILE)
    assert result.status == 3 and result.out.startswith(FILE)
    assert "TLT0820" in result.err and "TLT0001" in result.err


def test_the_option_offers_all_views() -> None:
    assert get_args(film.FilmView) == (*VIEWS, "plan") == _VIEWS == StealthFilms.views
    assert StealthKeyboard.views == keyboard_play._VIEWS


def test_the_option_offers_all_notations() -> None:
    assert set(get_args(Notation)) == set(NOTATIONS)


def test_messages_are_json_with_format_json(tltlc, recorded: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    Path("cut.episode.npz").write_bytes(Path(FILE).read_bytes()[:-9])
    result: Outcome = tltlc("replay", "cut.episode.npz", "--format", "json")
    assert (result.status, json.loads(result.out)) == (1, [])
    assert [diagnostic["code"] for diagnostic in json.loads(result.err)["diagnostics"]] == ["TLT0820"]


def test_a_plan_is_written(tltlc, recorded: Path, episode: Episode) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    assert tltlc("replay", FILE, "-o", "run.png").status == 0
    picture = np.asarray(Image.open("run.png").convert("RGB"))
    for state in (0, 1):
        colour = [int(state_colour(state)[at : at + 2], 16) for at in (1, 3, 5)]
        assert (picture == colour).all(axis=2).sum() > 50
    assert draw_episode(episode) == draw_episode(episode)
    assert tltlc("replay", FILE, "-o", "small.png", "--size", "500x400").status == 0
    assert Image.open("small.png").size == (500, 400)
    assert tltlc("replay", FILE, "-o", "small.png", "--size", "400x300").status == 0
    small = np.asarray(Image.open("small.png").convert("RGB"))
    assert (small[:30, [0, 1, 2, -3, -2, -1]] == 255).all()  # the title is not cut off


def test_a_plan_shows_the_end(episode: Episode) -> None:
    dead = replace(episode.snapshots[-1], health=0.0)
    died = replace(episode, snapshots=(*episode.snapshots[:-1], dead), end="violation")
    pictures = {draw_episode(drawn_episode) for drawn_episode in (episode, died, replace(episode, end="success"))}
    assert len(pictures) == 3
    assert Image.open(BytesIO(draw_episode(replace(episode, player="$x$")))).size[0] > 500


def test_a_gif_is_written(tltlc, recorded: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    assert tltlc("replay", FILE, "-o", "run.gif", "--view", "plan", "--size", "320x240", "--speed", "0.5").status == 0
    with Image.open("run.gif") as gif:
        assert (gif.size, gif.n_frames, gif.info["duration"]) == ((320, 240), STEPS + 1, 300)
    assert tltlc("replay", FILE, "-o", "part.gif", "--from", "1", "--to", "1.5", "--size", "200x200").status == 0
    with Image.open("part.gif") as gif:
        assert gif.n_frames == 4  # at 1, 1.15, 1.3 and 1.45 s


@pytest.mark.parametrize("view", _VIEWS)
def test_a_gif_has_the_colours_of_its_frames(tmp_path: Path, episode: Episode, view: film.FilmView) -> None:
    """Rare colours of late frames count, too: the switch turns green, and the strip shows the second state."""
    pictures = list(frames(episode, [0.0, 1.5, 3.0], view, (320, 240)))
    write_gif(tmp_path / "run.gif", pictures, 0.15)
    with Image.open(tmp_path / "run.gif") as gif:
        for number, picture in enumerate(pictures):
            gif.seek(number)
            difference = np.abs(np.asarray(gif.convert("RGB"), int) - picture).max(axis=2)
            assert np.percentile(difference, 99.9) <= 20


def test_an_mp4_is_written(tltlc, recorded: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    from imageio_ffmpeg import count_frames_and_secs, read_frames

    assert tltlc("replay", FILE, "-o", "run.mp4", "--view", "plan", "--size", "320x240").status == 0
    counted, seconds = count_frames_and_secs("run.mp4")
    assert counted == STEPS + 1 and seconds == pytest.approx(0.15 * (STEPS + 1), abs=0.02)
    assert next(read_frames("run.mp4"))["size"] == (320, 240)
    assert tltlc("replay", FILE, "-o", "fast.mp4", "--view", "plan", "--size", "320x240", "--speed", "10").status == 0
    counted, seconds = count_frames_and_secs("fast.mp4")
    assert counted == 10 and seconds == pytest.approx(10 / 30, abs=0.02)
    assert tltlc("replay", FILE, "-o", "slow.mp4", "--view", "plan", "--size", "320x240", "--fps", "20").status == 0
    counted, seconds = count_frames_and_secs("slow.mp4")
    assert counted == 61 and seconds == pytest.approx(61 / 20, abs=0.02)


def test_frames_show_the_view_and_the_strip(episode: Episode) -> None:
    for view in ("third_person", "top_down", "plan"):
        one, other = frames(episode, [0.0, 3.0], view, (240, 200))  # type: ignore[arg-type]
        assert one.shape == (200, 240, 3) and one.dtype == np.uint8
        assert (one[:-STRIP] != other[:-STRIP]).any() and (one[-STRIP:] != other[-STRIP:]).any()
    (again,) = frames(episode, [3.5], "plan", (240, 200))
    assert (again == other)[-STRIP:].all()


@pytest.mark.parametrize(
    ("health", "bar", "others"), [(1.0, "_GREEN", ("_RED",)), (0.5, "_RED", ("_GREEN",)), (0.0, "", ("_GREEN", "_RED"))]
)
def test_the_health_bar_of_a_film_is_green_until_health_is_low(
    episode: Episode, health: float, bar: str, others: tuple[str, ...]
) -> None:
    first = replace(episode.snapshots[0], health=health)
    (frame,) = frames(replace(episode, snapshots=(first, *episode.snapshots[1:])), [0.0], "plan", (320, 240))

    def pixels(name: str) -> int:
        colour = [int(getattr(film, name)[place : place + 2], 16) for place in (1, 3, 5)]
        # The lines below the bars show the state in its own colour.
        return int((frame[-STRIP : -STRIP + film._LINES[0]] == colour).all(axis=2).sum())

    assert not any(map(pixels, others))
    assert not bar or pixels(bar) > 100


def test_a_small_film_shows_the_end(tltlc, recorded: Path, episode: Episode) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    last = episode.snapshots[-1].time
    before, after = frames(replace(episode, end="violation"), [last - 0.01, last], "plan", (320, 240))
    assert (before[-STRIP:] != after[-STRIP:]).any()
    paper = after[-1, -1]
    assert (after[-STRIP:, -4:] == paper).all()  # no text runs over the edge
    assert tltlc("replay", FILE, "-o", "run.gif", "--size", "320x240", "--from", "2.9").status == 0
    with Image.open("run.gif") as gif:
        assert gif.n_frames == 2  # at 2.9 s, and the end at 3 s


def test_positions_are_interpolated_between_decisions(episode: Episode) -> None:
    moments = [film._moment(episode, time) for time in (0.0, 0.149, 0.15, 0.225, 3.0, 9.0)]
    assert [row for row, _ in moments] == [0, 0, 1, 1, STEPS, STEPS]
    assert moments[2][1] is episode.snapshots[1] and moments[-1][1] is episode.snapshots[-1]
    y = [episode.snapshots[row].player.position[1] for row in (1, 2)]
    assert moments[3][1].player.position[1] == pytest.approx(sum(y) / 2)


def test_the_exported_trace_gives_the_same_judgement(tltlc, recorded: Path, episode: Episode) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    written: Outcome = tltlc("replay", FILE, "-o", "run.csv")
    assert (written.status, written.err.splitlines()[1]) == (0, f"judge it with: {monitor_command(episode, 'run.csv')}")
    lines = BytesIO(Path("run.csv").read_bytes())
    monitor = Monitor(episode.fspa, episode.params)
    for row, sample in enumerate(read_trace(lines, "run.csv", episode.fspa.signals), start=1):
        step = monitor.step(sample)
        assert (step.state, step.progress) == (episode.states[row], episode.progress[row])
        assert step.reward == episode.rewards[row - 1]
    assert row == STEPS
    program, *words = shlex.split(monitor_command(episode, "run.csv"))
    assert program == "tltlc" and words[1] == "SPEC.tltl:branching"
    judged: Outcome = tltlc(words[0], ROOT / "examples/branching.tltl:branching", *words[2:])
    rows = [record for record in csv.DictReader(StringIO(judged.out)) if record["step"].isdecimal()]
    assert [int(record["state"]) for record in rows] == episode.states[1:].tolist()
    assert float(rows[-1]["progress"]) == pytest.approx(episode.progress[-1], abs=1e-6)
    assert tltlc("replay", FILE, "-o", "part.csv", "--from", "2.9").status == 0
    assert len(Path("part.csv").read_text().splitlines()) == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("-o", "run.avi"), "`run.avi` does not end with a known extension: use one of .png, .gif, .mp4, .csv"),
        (("-o", "run.gif", FILE), "-o takes one FILE"),
        (("-o", "run.png", "--view", "plan"), "--view works only if -o writes a .gif or .mp4 file"),
        (("-o", "run.png", "--from", "1"), "--from works only if -o writes a .gif, .mp4 or .csv file"),
        (("-o", "run.png", "--speed", "3"), "--speed works only if -o writes a .gif or .mp4 file"),
        (("-o", "run.csv", "--size", "500x400"), "--size works only if -o writes a .png, .gif or .mp4 file"),
        (("--speed", "2"), "--speed works only if -o writes"),
        (("-o", "run.mp4", "--size", "321x240"), "the width and the height of an .mp4 must be even"),
        (("--size", "9x9"), "write WIDTHxHEIGHT, each from 160 to 4096"),
        (("--size", "big"), "write WIDTHxHEIGHT"),
        (("-o", "run.gif", "--speed", "nan"), "write a finite number"),
        (("-o", "run.gif", "--to", "inf"), "write a finite number"),
        (("-o", "run.gif", "--from", "-1"), "range"),
        (("-o", "run.gif", "--from", "8", "--to", "9"), "there is nothing from 8 s to 9 s: the episode ends at 3.00 s"),
        (("-o", "run.gif", "--from", "2", "--to", "1"), "--from 2 is after --to 1"),
        ((), ""),
    ],
)
def test_invalid_options_are_rejected(tltlc, recorded: Path, arguments: tuple[str, ...], message: str) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("replay", FILE, *arguments) if arguments else tltlc("replay")
    assert result.status == 2 and message in result.err
    assert [path.name for path in recorded.iterdir()] == [FILE]


def test_a_recording_with_its_level_takes_no_game(tltlc, recorded: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result = tltlc("replay", FILE, "--check", "--game", "lake.game.toml:small")
    assert result.status == 2
    assert f"--game is for recordings of scenes of game files, and `{FILE}` contains its level" in result.err


def test_ctrl_c_leaves_no_partial_file(tltlc, recorded: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    calls, framed = count(), film._add_strip

    def interrupted(*arguments: object) -> object:
        if next(calls) % 6 == 5:
            raise KeyboardInterrupt
        return framed(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(film, "_add_strip", interrupted)
    for name in ("run.gif", "run.mp4"):
        Path(name).write_bytes(b"older")
        result: Outcome = tltlc("replay", FILE, "-o", name, "--view", "plan")
        assert result.status == 130 and Path(name).read_bytes() == b"older"
    assert sorted(path.name for path in recorded.iterdir()) == [FILE, "run.gif", "run.mp4"]


def test_a_missing_encoder_is_reported(tltlc, recorded: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    result: Outcome = tltlc("replay", FILE, "-o", "run.mp4", "--view", "plan")
    assert result.status == 4 and "pip install imageio-ffmpeg" in result.err.replace("'", "")
    assert [path.name for path in recorded.iterdir()] == [FILE]


def test_an_unwritable_file_is_reported_before_the_work(tltlc, recorded: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("replay", FILE, "-o", "nowhere/run.mp4")
    assert result.status == 3 and "error[TLT0005]: cannot write `nowhere/run.mp4`" in result.err
