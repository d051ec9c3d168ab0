"""The guide on other environments is run from its first line to its last."""

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
FOUND = blocks(PAGE)
SPEC = next(block.text for block in FOUND if block.kind == "tltl")


def outcomes() -> list[tuple[Block, Block]]:
    """Each program with the block of what it prints."""
    programs = [index for index, block in enumerate(FOUND) if block.kind == "python"]
    return [(FOUND[index], FOUND[index + 1]) for index in programs]


def test_it_prints_what_it_says(tmp_path: Path) -> None:
    (tmp_path / "swing_up.tltl").write_text(SPEC, encoding="utf-8")
    found = outcomes()
    assert len(found) == 2
    for name, (program, printed) in zip(("drive.py", "many.py"), found, strict=True):
        check_program(program, printed, tmp_path / name)


def test_the_keys_of_info_are_those() -> None:
    said = re.findall(r"^\| `(\w+)` \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    env = TltlEnv(gymnasium.make("MountainCar-v0"), SPEC, lambda _: {"position": 0.0, "velocity": 0.0})
    assert list(env.reset()[1]) == said
    assert list(env.step(0)[4]) == said


def test_the_message_is_that() -> None:
    def signals(_: gymnasium.Env[Any, Any]) -> dict[str, float]:
        return {"position": 0.0, "velocty": 0.0}

    with pytest.raises(TltlError) as error:
        TltlEnv(gymnasium.make("MountainCar-v0"), SPEC, signals).reset()
    page = PAGE.read_text(encoding="utf-8")
    assert f"    {type(error.value).__name__}: {error.value}\n" in page
    assert f"``{error.value.diagnostics[0].help}``" in page
