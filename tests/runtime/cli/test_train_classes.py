"""``tltlc train`` with classes of one's own, as the documentation shows."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.docs.blocks import DOCS, blocks
from tests.interfaces.cli.conftest import EXAMPLE, Outcome, tltlc  # noqa: F401
from tests.runtime.cli.test_train import SMALL


def test_the_runner_of_the_page_tells_what_it_says(
    tltlc: Callable[..., Outcome],  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = blocks(DOCS / "training.md")
    (program,) = (block.text for block in found if block.kind == "python" and "(Runner)" in block.text)
    (settings,) = (block.text for block in found if block.kind == "toml" and "[classes]" in block.text)
    (tmp_path / "telling.py").write_text(program)
    (tmp_path / "telling.toml").write_text(settings + SMALL)
    monkeypatch.chdir(tmp_path)
    # As PYTHONPATH does.
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "telling", raising=False)
    begun = tltlc("train", EXAMPLE, "--config", "telling.toml", "--out", "run")
    assert begun.status == 1, begun.err
    told = [f"iteration {number}: the entropy bonus weighs 0.0100" for number in (1, 2, 3)]
    assert begun.out.splitlines()[:2] == told[:2]
    on = tltlc("train", "--resume", "run", "--steps", "192")
    assert on.out.splitlines()[0] == told[2], on.err
