"""The hash of all source modules."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

from tltl_runtime.support import source_hash as sources


@pytest.fixture(name="packages")
def _packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two small packages that stand in for compiler and runtime."""
    for name in ("one_here", "other_here"):
        (tmp_path / name / "inner").mkdir(parents=True)
        for module in ("__init__", "inner/__init__", "inner/rule"):
            (tmp_path / name / f"{module}.py").write_bytes(b'"""A rule."""\nLIMIT = 3\n')
    monkeypatch.setattr(sources, "_PACKAGES", ("one_here", "other_here"))
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def fresh_hash() -> str:
    importlib.invalidate_caches()
    return sources.sources_hash.__wrapped__()


def test_any_change_of_a_module_changes_the_hash(packages: Path) -> None:
    hashes = {fresh_hash()}
    rule = packages / "other_here" / "inner" / "rule.py"
    rule.write_bytes(rule.read_bytes().replace(b"3", b"4"))
    hashes.add(fresh_hash())
    rule.rename(rule.with_name("law.py"))
    hashes.add(fresh_hash())
    (packages / "one_here" / "new.py").write_bytes(b"")
    hashes.add(fresh_hash())
    assert len(hashes) == 4


def test_line_endings_and_compiled_files_do_not_change_the_hash(packages: Path) -> None:
    before = fresh_hash()
    rule = packages / "one_here" / "inner" / "rule.py"
    rule.write_bytes(rule.read_bytes().replace(b"\n", b"\r\n"))
    (packages / "one_here" / "__pycache__").mkdir()
    (packages / "one_here" / "__pycache__" / "rule.pyc").write_bytes(b"compiled")
    assert fresh_hash() == before


def test_the_hash_covers_compiler_and_runtime(monkeypatch: pytest.MonkeyPatch) -> None:
    hash_of_both = fresh_hash()
    assert sources.sources_hash() == hash_of_both
    hashes = {hash_of_both}
    for package in ("tltlc", "tltl_runtime"):
        monkeypatch.setattr(sources, "_PACKAGES", (package,))
        hashes.add(fresh_hash())
    assert len(hashes) == 3
