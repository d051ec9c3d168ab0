"""Commands that judge play need no torch; a package that a command needs and lacks is named."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.runtime.gymnasium_games.games import write
from tests.waiting import HANG_S

LEARNING = ("torch", "rsl_rl", "tensordict", "tensorboard", "onnx", "onnxscript")
"""The packages of the extra `rl`."""
HELP = "help: in the clone of tltlc: pip install -c constraints.txt"


def run_without(modules: Sequence[str], command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command of tltlc in a process that cannot import ``modules``."""
    hide = f"import sys; sys.modules.update(dict.fromkeys({list(modules)}))"
    program = f"{hide}; from tltlc.interfaces.cli.main import main; main({command.split()})"
    return subprocess.run(
        [sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, timeout=HANG_S, check=False
    )


@pytest.mark.parametrize(
    ("command", "module", "extra"),
    [
        ("train soon.tltl", "torch", "rl"),
        ("inspect branching -o branching.onnx", "torch", "rl"),
        ("inspect branching", "safetensors", "game"),
        ("evaluate --level branching", "threadpoolctl", "game"),
    ],
)
def test_a_missing_extra_is_named(command: str, module: str, extra: str, tmp_path: Path) -> None:
    done = run_without([module], command, tmp_path)
    name = command.partition(" ")[0]
    assert (done.returncode, done.stdout) == (4, "")
    assert done.stderr == (
        f"error[TLT0730]: `tltlc {name}` needs `{module}`, which is not installed\n  {HELP} '.[{extra}]'\n"
    )


SUITE = """
[[case]]
level = "navigation"
policy = "navigation"
episodes = 25
"""


@pytest.mark.slow
def test_levels_are_judged_without_the_packages_that_learn(tmp_path: Path) -> None:
    (tmp_path / "suite.toml").write_text(SUITE, encoding="utf-8")
    for command, status in [
        ("inspect navigation", 0),
        ("evaluate --level navigation --episodes 2 --workers 2 --out evaluation", 0),
        ("demonstrate navigation", 0),
        # So few episodes are not enough to pass later.
        ("baseline suite.toml --workers 2", 1),
        # All 25 episodes meet the spec as before, but so few are not enough to be sure.
        ("regress suite.toml --workers 2", 1),
    ]:
        done = run_without(LEARNING, command, tmp_path)
        assert done.returncode == status, (command, done.stdout, done.stderr)
    assert "review   25 of 25" in done.stdout
    retrained = run_without(LEARNING, "regress suite.toml --retrain", tmp_path)
    assert (retrained.returncode, "needs `torch`" in retrained.stderr) == (4, True), retrained.stderr


def test_games_are_checked_and_listed_without_what_learns_and_without_physics(tmp_path: Path) -> None:
    write(tmp_path)
    without = (*LEARNING, "pybullet", "pygame", "matplotlib", "safetensors", "jinja2")
    for command in ("check --game corridor.game.toml", "list games"):
        done = run_without(without, command, tmp_path)
        assert done.returncode == 0, (command, done.stdout, done.stderr)


def test_missing_files_are_reported_before_what_plays_is_imported(tmp_path: Path) -> None:
    program = """
import sys
from tltlc.interfaces.cli.main import main

for command in sys.argv[1:]:
    try:
        main(command.split())
    except SystemExit as ended:
        print(ended.code, bool({"pybullet", "safetensors", "matplotlib", "jinja2"} & sys.modules.keys()))
"""
    commands = ["evaluate --level gone", "evaluate --level gone.toml", "evaluate gone.safetensors"]
    commands += ["evaluate --level branching:v9", "regress gone.toml", "baseline gone.toml"]
    done = subprocess.run(
        [sys.executable, "-c", program, *commands], cwd=tmp_path, capture_output=True, text=True, timeout=HANG_S
    )
    assert done.stdout.splitlines() == ["2 False", "3 False", "3 False", "2 False", "3 False", "3 False"], done.stderr
    codes = [line.partition("]")[0] for line in done.stderr.splitlines() if line.startswith("error[")]
    assert codes == [f"error[TLT0{code}" for code in ("800", "001", "001", "800", "001", "001")]
