"""Each case is measured in a process of its own, once."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.store import Store
from benchmarks.variants import measure_each


def test_what_failed_is_measured_again_and_nothing_else_is(tmp_path: Path) -> None:
    pytest.importorskip("pybullet")
    store = Store(tmp_path / "results.json")
    cases = [("cover_and_hide", "v0", "30"), ("nowhere", "v0", "30")]
    said: list[str] = []
    for _ in range(2):
        measure_each(store, "safety", lambda: cases, 60.0, said.append)
    good, bad = (store.section("safety")[" ".join(case)] for case in cases)
    assert good["steps"] == 30
    assert bad == {"failed": "exit status 1"}
    assert [line.partition(":")[0] for line in said] == ["cover_and_hide v0 30", *2 * ["nowhere v0 30"]]
