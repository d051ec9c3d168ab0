"""Commands on a game in another process that are killed, interrupted or fail: no process is left."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.docs.blocks import ROOT
from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games.test_lost_episodes import SETTINGS, _trained, mortal  # noqa: F401
from tests.runtime.wire.processes import descendants, no_game_is_left, supervisors
from tests.waiting import HANG_S, children, until, until_gone

Run = Callable[..., Outcome]
PLACE = ("--game", "counter.game.toml:short")
TRAIN = ("train", *PLACE, "--config", "settings.toml", "-o", "run")
EVALUATE = ("evaluate", "policy.safetensors", *PLACE)


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, trained: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "game"
    folder.mkdir()
    shutil.copy(trained, folder / "policy.safetensors")
    (folder / "settings.toml").write_text(SETTINGS.format(steps=400, workers=2, ways=0))
    monkeypatch.chdir(folder)
    return folder


@pytest.mark.parametrize(
    ("words", "number"),
    [
        ((*EVALUATE, "--workers", "1"), signal.SIGKILL),
        ((*EVALUATE, "--workers", "1"), signal.SIGTERM),
        ((*EVALUATE, "--workers", "1"), signal.SIGINT),
        pytest.param((*EVALUATE, "--workers", "2"), signal.SIGKILL, marks=pytest.mark.slow),
        pytest.param((*EVALUATE, "--workers", "2"), signal.SIGTERM, marks=pytest.mark.slow),
        pytest.param((*EVALUATE, "--workers", "2"), signal.SIGINT, marks=pytest.mark.slow),
        pytest.param(TRAIN, signal.SIGKILL, marks=pytest.mark.slow),
        pytest.param(TRAIN, signal.SIGTERM, marks=pytest.mark.slow),
        pytest.param(TRAIN, signal.SIGINT, marks=pytest.mark.slow),
    ],
    ids=lambda value: f"{value[0]} {value[-1]}" if isinstance(value, tuple) else signal.Signals(value).name,
)
def test_no_process_is_left_after_a_signal(folder: Path, words: tuple[str, ...], number: int) -> None:
    # A training looks at the spaces in the first episode. Then each game hangs, for the deadline of the test.
    mortal(folder, "hang", *range(2, 20), step_s=3600)
    path = os.pathsep.join([str(ROOT), str(ROOT / "runtime")])
    with subprocess.Popen(
        [sys.executable, "-m", "tltlc", *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        hangs = folder.with_name("episodes.fault")
        until(lambda: hangs.exists() or process.poll() is not None, "the game to hang")
        # With two workers, the other game may still be starting.
        until(lambda: any(map(children, supervisors(process.pid))), "the game below its supervisor")
        pids = [*descendants(process.pid)]
        # A terminal sends Ctrl-C to all processes of its group.
        os.killpg(process.pid, number) if number == signal.SIGINT else process.send_signal(number)
        _, errors = process.communicate(timeout=HANG_S)
    assert process.returncode in (-number, 128 + number), errors
    assert "Traceback" not in errors
    until_gone(pids)


@pytest.mark.parametrize("workers", ["1", "2"])
def test_no_process_is_left_if_a_signal_function_raises(
    tltlc: Run,  # noqa: F811
    folder: Path,
    workers: str,
) -> None:
    game = mortal(folder, "exit")
    (folder / "rules.py").write_text(
        "def signals(env):\n    return {'at_goal': env.unwrapped.tltl_signals()['gaol']}\n"
    )
    game.write_text(game.read_text().replace("[game]\n", '[game]\nsignals = "rules:signals"\n', 1))
    with no_game_is_left():
        result = tltlc(*EVALUATE, "--workers", workers, "--episodes", "4")
    assert result.status in (1, 2)
    assert "error[TLT0781]: `rules:signals`, called after the reset, raises KeyError: 'gaol'" in result.err


@pytest.mark.parametrize("words", [EVALUATE, TRAIN], ids=lambda value: value[0])
def test_a_scene_that_the_game_cannot_load_is_an_error(
    tltlc: Run,  # noqa: F811
    folder: Path,
    words: tuple[str, ...],
) -> None:
    mortal(folder, "reset", "all")
    with no_game_is_left():
        result = tltlc(*words)
    assert result.status in (1, 2)
    assert "the game `counter.game.toml` reports: no such map" in result.err
    assert result.err.count("error[") == 1


def test_a_game_that_is_not_deterministic_is_measured_and_played(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "chance")
    with no_game_is_left():
        result = tltlc("check", "--game", "counter.game.toml:short:v0")
        assert tltlc(*EVALUATE, "--episodes", "4").status == 0
        assert tltlc(*TRAIN, "--steps", "80").status in (0, 1)
    # Ten episodes and more would have to begin alike by chance.
    assert result.status == 0
    assert "warning[TLT0783]: equal seeds and actions give different plays in `short:v0`" in result.err
    assert "equal seeds and actions give equal plays: no" in result.err


@pytest.mark.parametrize(("fault", "code"), [("exit", "TLT0791"), ("garbage", "TLT0792"), ("reset", "TLT0793")])
def test_a_check_ends_with_the_first_error(tltlc: Run, folder: Path, fault: str, code: str) -> None:  # noqa: F811
    mortal(folder, fault, 2)
    with no_game_is_left():
        result = tltlc("check", *PLACE)
    assert result.status in (1, 2)
    assert f"error[{code}]: the game `counter.game.toml` " in result.err
