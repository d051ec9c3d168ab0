"""The hash of the code."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

from tltl_runtime.support import source_hash as sources


@pytest.fixture(name="packages")
def _packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two small packages in place of compiler and runtime."""
    for name in ("one_here", "other_here"):
        (tmp_path / name / "inner").mkdir(parents=True)
        for module in ("__init__", "inner/__init__", "inner/rule"):
            (tmp_path / name / f"{module}.py").write_bytes(b'"""A rule."""\nLIMIT = 3\n')
    monkeypatch.setattr(sources, "_PACKAGES", ("one_here", "other_here"))
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def hashed() -> str:
    importlib.invalidate_caches()
    return sources.sources_hash.__wrapped__()


def test_any_change_of_a_module_counts(packages: Path) -> None:
    found = {hashed()}
    rule = packages / "other_here" / "inner" / "rule.py"
    rule.write_bytes(rule.read_bytes().replace(b"3", b"4"))
    found.add(hashed())
    rule.rename(rule.with_name("law.py"))
    found.add(hashed())
    (packages / "one_here" / "new.py").write_bytes(b"")
    found.add(hashed())
    assert len(found) == 4


def test_what_is_no_code_does_not_count(packages: Path) -> None:
    before = hashed()
    rule = packages / "one_here" / "inner" / "rule.py"
    rule.write_bytes(rule.read_bytes().replace(b"\n", b"\r\n"))
    (packages / "one_here" / "__pycache__").mkdir()
    (packages / "one_here" / "__pycache__" / "rule.pyc").write_bytes(b"compiled")
    assert hashed() == before


def test_it_is_of_compiler_and_runtime(monkeypatch: pytest.MonkeyPatch) -> None:
    both = hashed()
    assert sources.sources_hash() == both
    found = {both}
    for package in ("tltlc", "tltl_runtime"):
        monkeypatch.setattr(sources, "_PACKAGES", (package,))
        found.add(hashed())
    assert len(found) == 3
