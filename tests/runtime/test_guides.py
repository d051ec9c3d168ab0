"""The guides on the game and on batches: the programs print the output shown, and all options are listed."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import gymnasium
import pytest
from gymnasium.utils.env_checker import check_env

import tltl_runtime  # noqa: F401  (registers the environments)
from tests.docs.blocks import DOCS, blocks
from tests.runtime.guides import check_program
from tltl_runtime.stealth.env import GameEnv, make_env

GAME = DOCS / "guides" / "stealth.md"


@pytest.mark.parametrize("page", [GAME, DOCS / "guides" / "batch.md"], ids=lambda page: page.stem)
def test_the_program_prints_the_output_shown(page: Path, tmp_path: Path) -> None:
    program, printed = blocks(page)
    check_program(program, printed, tmp_path / "program.py")


def test_the_guide_lists_every_option() -> None:
    documented = re.findall(r"^\| `(\w+)` \|", GAME.read_text(encoding="utf-8"), re.MULTILINE)
    accepted = [*inspect.signature(make_env).parameters, *inspect.signature(GameEnv).parameters]
    assert set(documented) == set(accepted) - {"level", "render"}


def test_gymnasium_checks_the_game_with_its_spec() -> None:
    env = gymnasium.make("tltl/CoverAndHide-v0")
    with pytest.warns(UserWarning, match="different from the unwrapped version"):
        check_env(env, skip_render_check=True)
    env.close()
