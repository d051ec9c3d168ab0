"""The drivers of the benchmark of counting monitors run in every language that is installed."""

from __future__ import annotations

import shutil
from unittest.mock import patch

import pytest

from benchmarks import tables
from tests.backends.state_tables import counting
from tltlc.core.record import replace


@pytest.mark.parametrize("name", tables.LANGUAGES)
def test_sizes_and_times_are_measured(name: str) -> None:
    language = replace(tables.LANGUAGES[name], monitors=10)
    with patch.object(tables, "ROUNDS", 1):
        entry = tables.measure_language(language, counting())
    assert entry["states"] == 602
    assert entry["bytes"]["table"] < 0.4 * entry["bytes"]["ladder"]
    report = tables.section({name: entry})
    assert f"\n| {language.title} | " in report
    if language.run is None or shutil.which((*language.build, *language.run)[0]) is None:
        assert "ns" not in entry
        assert list(tables.goals({name: entry})) == []
    else:
        assert all(time > 0 for times in entry["ns"].values() for time in times.values())
        assert next(verdict for *_, verdict in tables.goals({name: entry})) == "met"
