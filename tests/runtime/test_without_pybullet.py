"""Without pybullet, commands that play the game report that it is missing, and everything else works."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import HANG_S
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.recordings.file import write_episode

PROGRAM = "import sys; sys.modules['pybullet'] = None; "
COMMAND = PROGRAM + "from tltlc.interfaces.cli.main import main; main()"


def run(program: str, *arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-c", program, *map(str, arguments)]
    return subprocess.run(words, cwd=cwd, capture_output=True, text=True, timeout=HANG_S)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    env = RecordEpisode(make_env("navigation"))
    env.reset(seed=1)
    env.step([1, 0, 0, 0, 0])
    path = tmp_path_factory.mktemp("recorded") / "run.episode.npz"
    write_episode(path, env.episode)
    env.close()
    return path


@pytest.mark.parametrize(
    "command", ["demonstrate navigation", "record navigation", "play navigation", "replay {} --check"]
)
def test_commands_that_play_report_the_missing_package(command: str, recording: Path, tmp_path: Path) -> None:
    done = run(COMMAND, *command.format(recording).split(), cwd=tmp_path)
    assert done.returncode == 4
    assert "error[TLT0730]: the game needs `pybullet`, which is not installed" in done.stderr


@pytest.mark.parametrize("output", ["", "run.png", "run.csv"])
def test_recordings_can_be_read_and_drawn(output: str, recording: Path, tmp_path: Path) -> None:
    done = run(COMMAND, "replay", recording, *(["-o", output] if output else []), cwd=tmp_path)
    assert done.returncode == 0 and "TLT0730" not in done.stderr
    assert not output or (tmp_path / output).stat().st_size > 0


def test_levels_can_be_checked() -> None:
    done = run(COMMAND, "check", "--level", "navigation:v0")
    assert done.returncode == 0 and "nothing to report" in done.stderr


def test_gymnasium_reports_the_missing_package() -> None:
    done = run(PROGRAM + "import gymnasium, tltl_runtime; gymnasium.make('tltl/Navigation-v0')")
    assert done.stderr.splitlines()[-1].endswith("TLT0730: the game needs `pybullet`, which is not installed")


def test_workers_run_other_environments() -> None:
    program = """
import gymnasium
from tltl_runtime.vector import WorkerVectorEnv
envs = WorkerVectorEnv([lambda: gymnasium.make("CartPole-v1")] * 2, workers=1)
print(envs.reset(seed=1)[0].shape)
envs.close()
"""
    assert run(PROGRAM + program).stdout == "(2, 4)\n"


def test_the_game_reads_levels_and_recordings(recording: Path) -> None:
    program = f"""
from pathlib import Path
from tltl_runtime.game.registry import STEALTH, game_named
game = game_named(STEALTH)
level, episode = game.load_level("navigation"), game.read_episode(Path({str(recording)!r}))
print(game.branches, game.level_hash(level) == game.level_hash(episode.level), game.summary(episode).steps)
"""
    assert run(PROGRAM + program).stdout == "(3, 3, 2, 2, 2) True 1\n"


def test_vector_environments_of_the_game_report_the_missing_package() -> None:
    done = run(PROGRAM + "from tltl_runtime.vector import make_vec; make_vec('navigation')")
    assert done.stderr.splitlines()[-1].endswith("TLT0730: the game needs `pybullet`, which is not installed")
