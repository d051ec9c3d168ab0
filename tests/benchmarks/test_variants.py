"""Each case is measured once, in a process of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.store import Store
from benchmarks.variants import measure_each


def test_only_failed_cases_are_measured_again(tmp_path: Path) -> None:
    pytest.importorskip("pybullet")
    store = Store(tmp_path / "results.json")
    cases = [("cover_and_hide", "v0", "30"), ("nowhere", "v0", "30")]
    messages: list[str] = []
    for _ in range(2):
        measure_each(store, "safety", lambda: cases, 60.0, messages.append)
    good, bad = (store.section("safety")[" ".join(case)] for case in cases)
    assert good["steps"] == 30
    assert bad == {"failed": "exit status 1"}
    assert [line.partition(":")[0] for line in messages] == ["cover_and_hide v0 30", *2 * ["nowhere v0 30"]]
