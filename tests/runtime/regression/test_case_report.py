"""The report on a case that was played."""

from __future__ import annotations

from pathlib import Path

from tests.runtime.regression.game import Played, edit
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tltl_runtime.regression.baseline import baseline_of
from tltl_runtime.regression.run import regress
from tltl_runtime.regression.suite import read_suite


def test_it_tells_which_keys_of_a_file_have_changed(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    edit("room.toml", "at = [8.0, 8.0, 0.0]", "at = [8.0, 7.0, 0.0]")
    (done,) = regress(suite, suite.cases[:1], baseline_of(suite), Path("run"), 1, Played())
    (said,) = done.report.edits
    assert said.startswith("changed since the baseline: room.toml (") and "[8, 7, 0]" in said.replace(".0", "")
