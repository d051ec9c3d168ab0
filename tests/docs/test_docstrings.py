"""The examples in docstrings print what they show."""

from __future__ import annotations

import doctest
import importlib
from pathlib import Path

import pytest

from tests.docs.blocks import ROOT


def modules_with_examples() -> list[str]:
    """Return the names of the modules whose text contains an example, in order."""
    roots = (ROOT / "tltlc", ROOT), (ROOT / "runtime" / "tltl_runtime", ROOT / "runtime")
    return [
        name(path, base) for root, base in roots for path in sorted(root.rglob("*.py")) if b">>>" in path.read_bytes()
    ]


def name(path: Path, base: Path) -> str:
    return ".".join(path.relative_to(base).with_suffix("").parts).removesuffix(".__init__")


@pytest.mark.parametrize("module", modules_with_examples())
def test_the_examples_print_what_they_show(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    result = doctest.testmod(importlib.import_module(module))
    assert result.attempted > 0
    assert result.failed == 0
