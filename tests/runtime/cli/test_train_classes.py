"""``tltlc train`` with user-defined classes, as the documentation shows."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.docs.blocks import DOCS, blocks
from tests.interfaces.cli.conftest import EXAMPLE, Outcome, tltlc  # noqa: F401
from tests.runtime.cli.small_training import SMALL


def test_the_runner_on_the_page_prints_its_lines(
    tltlc: Callable[..., Outcome],  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    page_blocks = blocks(DOCS / "training.md")
    (program,) = (block.text for block in page_blocks if block.kind == "python" and "(Runner)" in block.text)
    (settings,) = (block.text for block in page_blocks if block.kind == "toml" and "[classes]" in block.text)
    (tmp_path / "telling.py").write_text(program)
    (tmp_path / "telling.toml").write_text(settings + SMALL)
    monkeypatch.chdir(tmp_path)
    # The same effect as PYTHONPATH.
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "telling", raising=False)
    started = tltlc("train", EXAMPLE, "--config", "telling.toml", "--out", "run")
    assert started.status == 1, started.err
    lines = [f"iteration {number}: the entropy bonus weighs 0.0100" for number in (1, 2, 3)]
    assert started.out.splitlines()[:2] == lines[:2]
    resumed = tltlc("train", "--resume", "run", "--steps", "192")
    assert resumed.out.splitlines()[0] == lines[2], resumed.err
