"""Runs of suites."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from tests.runtime.regression.game import Played
from tltl_runtime.regression.suite.suite import Suite, read_suite
from tltl_runtime.regression.suite_run import FinishedCase, regress
from tltl_runtime.regression.verdict.baseline import baseline_of


def running(suite: Suite, folder: str = "run", callback: Played | None = None) -> Iterator[FinishedCase]:
    return regress(suite, suite.cases, baseline_of(suite), Path(folder), 1, callback or Played())


def run(folder: str = "run", suite: Suite | None = None) -> tuple[list[FinishedCase], dict[str, int]]:
    """Run the suite; return the results, and the number of episodes played per case."""
    played = Played()
    return list(running(suite or read_suite(Path("game.toml")), folder, played)), played.counts
