"""``pytest --part I/N`` runs one of several parts of the tests."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def collected(*options: str) -> list[str]:
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider", *options]
    result = subprocess.run(
        [*command, "tests/grammar/test_precedence.py"], cwd=ROOT, capture_output=True, text=True, timeout=300
    )
    return [line for line in result.stdout.splitlines() if "::" in line]


def test_each_test_is_in_one_part() -> None:
    parts = [collected("--part", f"{number}/3") for number in (1, 2, 3)]
    assert all(parts)
    assert sorted(test for part in parts for test in part) == sorted(collected())


@pytest.mark.parametrize("part", ["0/3", "4/3", "2"])
def test_a_part_that_is_none_is_refused(part: str) -> None:
    assert not collected("--part", part)
