"""The cache of the predicate check: an answer is computed once, and a damaged file is not trusted.

The check of the standard library needs neither the cache nor sympy.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tltlc.expression.tree import Const, Expression, Op, ParamValue, SignalValue
from tltlc.resolve.range_proof import proof_cache

YES, NO = proof_cache.Answer(True, 7), proof_cache.Answer(False, 8)


def refuse() -> proof_cache.Answer:
    raise AssertionError("the answer should have been remembered")


def test_an_answer_is_computed_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTLC_CACHE_DIR", str(tmp_path / "new"))
    assert proof_cache.answer("one", lambda: YES) == YES
    assert proof_cache.answer("two", lambda: NO) == NO
    assert proof_cache.answer("one", refuse) == YES
    assert proof_cache.answer("two", refuse) == NO
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["predicates.json"]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{",
        b"\xff\xfe",
        b"[]",
        b'{"version": 2, "answers": 3}',
        b'{"version": 1, "answers": {"KEY": true}}',
        b'{"version": 2, "answers": {"KEY": true}}',
        b'{"version": 2, "answers": {"KEY": ["yes", 1]}}',
        b'{"version": 2, "answers": {"KEY": [true]}}',
        b'{"version": 2, "answers": {"KEY": [true, -1]}}',
        b'{"version": 2, "answers": {"KEY": [true, true]}}',
        b'{"version": 2, "answers": {"KEY": [true, 1e300]}}',
        b"[" * 100_000,
    ],
)
def test_a_damaged_cache_is_ignored(content: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTLC_CACHE_DIR", str(tmp_path))
    proof_cache.answer("one", lambda: NO)
    file = tmp_path / "predicates.json"
    (key,) = json.loads(file.read_text())["answers"]
    file.write_bytes(content.replace(b"KEY", key.encode()))
    assert proof_cache.answer("one", lambda: NO) == NO
    assert proof_cache.answer("one", refuse) == NO


def test_a_cache_folder_that_cannot_be_created_is_ignored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("TLTLC_CACHE_DIR", str(tmp_path / "file" / "below"))
    assert proof_cache.answer("one", lambda: YES) == YES


def test_the_cache_folder_depends_on_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTLC_CACHE_DIR", "")
    assert proof_cache.cache_folder() is None
    monkeypatch.delenv("TLTLC_CACHE_DIR")
    if sys.platform.startswith("linux"):
        monkeypatch.setenv("XDG_CACHE_HOME", "/somewhere")
        assert proof_cache.cache_folder() == Path("/somewhere/tltlc")


def ask(name: str, high: float, value: float = 2.0) -> str:
    signal, param = SignalValue(name), ParamValue("p")
    expression: Expression = Op("*", (Op("-", (signal, param)), Const(value)))
    box: dict[SignalValue | ParamValue, tuple[float, float]] = {signal: (0.0, high), param: (0.0, 1.0)}
    return proof_cache.question("range", expression, box, frozenset(), -1.0, 1.0)


def test_the_cache_key_depends_on_everything_but_names() -> None:
    assert ask("distance(s1)", 1.0) == ask("distance(s2)", 1.0)
    assert len({ask("a", 1.0), ask("a", 2.0), ask("a", 1.0, 3.0)}) == 3


def test_the_standard_library_needs_no_sympy() -> None:
    code = """
import sys
from tltlc.grammar.parser import parse
from tltlc.resolve.imports import standard_library
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.resolution import resolve
from tltlc.core.source import SourceFile
for path in sorted(standard_library().glob("*.tltl")):
    resolve(parse(SourceFile(str(path), path.read_text("utf-8")))[0], ResolveOptions())
assert "sympy" not in sys.modules, "sympy was imported"
"""
    environment = {**os.environ, "TLTLC_CACHE_DIR": ""}
    result = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
