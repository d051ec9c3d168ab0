"""The programs in the guide on other environments run as shown."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import gymnasium
import pytest

from tests.docs.blocks import DOCS, Block, blocks
from tests.runtime.guides import check_program
from tltl_runtime import TltlEnv
from tltlc import TltlError

PAGE = DOCS / "guides" / "gymnasium.md"
BLOCKS = blocks(PAGE)
SPEC = next(block.text for block in BLOCKS if block.kind == "tltl")


def programs_with_output() -> list[tuple[Block, Block]]:
    """Each program, with the block that shows its output."""
    programs = [index for index, block in enumerate(BLOCKS) if block.kind == "python"]
    return [(BLOCKS[index], BLOCKS[index + 1]) for index in programs]


def test_the_programs_print_the_output_shown(tmp_path: Path) -> None:
    (tmp_path / "swing_up.tltl").write_text(SPEC, encoding="utf-8")
    programs = programs_with_output()
    assert len(programs) == 2
    for name, (program, printed) in zip(("drive.py", "many.py"), programs, strict=True):
        check_program(program, printed, tmp_path / name)


def test_the_guide_lists_the_keys_of_info() -> None:
    documented = re.findall(r"^\| `(\w+)` \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    env = TltlEnv(gymnasium.make("MountainCar-v0"), SPEC, lambda _: {"position": 0.0, "velocity": 0.0})
    assert list(env.reset()[1]) == documented
    assert list(env.step(0)[4]) == documented


def test_the_guide_shows_the_real_error_message() -> None:
    def signals(_: gymnasium.Env[Any, Any]) -> dict[str, float]:
        return {"position": 0.0, "velocty": 0.0}

    with pytest.raises(TltlError) as error:
        TltlEnv(gymnasium.make("MountainCar-v0"), SPEC, signals).reset()
    page = PAGE.read_text(encoding="utf-8")
    assert f"    {type(error.value).__name__}: {error.value}\n" in page
    assert f"``{error.value.diagnostics[0].help}``" in page
