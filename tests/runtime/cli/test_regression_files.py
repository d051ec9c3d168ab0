"""The page that a run writes: the name of the suite, the level of the baseline, and the results of earlier runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.regression.game import Played, edit
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tltl_runtime.cli.support.regression_files import SuiteRun, json_text, write_reports
from tltl_runtime.regression.suite.suite import SHIPPED, Suite, read_suite
from tltl_runtime.regression.suite_run import FinishedCase, regress
from tltl_runtime.regression.verdict.baseline import baseline_of
from tltlc.core.record import replace

NAMES = ("room:v0", "room:v1", "hopeless")


@pytest.fixture(name="suite")
def _suite(game: Path) -> Suite:
    return read_suite(Path("game.toml"))


def page(outcome: SuiteRun) -> str:
    path = write_reports(outcome, {})
    assert path is not None
    return path.read_text(encoding="utf-8")


def judged(suite: Suite, count: int) -> tuple[FinishedCase, ...]:
    return tuple(regress(suite, suite.cases[:count], baseline_of(suite), Path("run"), 1, Played()))


def test_cases_that_were_left_out_show_their_earlier_verdicts(suite: Suite) -> None:
    text = page(SuiteRun(suite, Path("run"), (), True, NAMES))
    assert text.count("earlier: pass") == 2 and text.count("earlier: fail") == 1
    assert "earlier" not in page(SuiteRun(suite, Path("elsewhere"), (), True, NAMES))


def test_cases_that_were_not_run_show_the_reason(suite: Suite) -> None:
    changed = tuple(f"{number}.toml" for number in range(10))
    text = page(SuiteRun(suite, Path("run"), judged(suite, 1), False, ("room:v1",), ("hopeless",), changed))
    names = ", ".join(f"<code>{name}</code>" for name in changed[:8])
    assert text.count(f"it depends on none of the files that --changed names: {names} and 2 more") == 2
    stopped = "the run was stopped before this case; run the same command again, without --fresh, to continue"
    assert text.count(stopped) == 2
    assert page(SuiteRun(suite, Path("run"), (), True, NAMES)).count("--changed names no file") == 6


@pytest.mark.parametrize(
    "kept", ["", "[]", "{}", '{"content": 3}', '{"content": {"verdict": ["pass"]}}', "[" * 100_000]
)
def test_unreadable_results_of_an_earlier_run_are_left_out(suite: Suite, kept: str) -> None:
    Path("run/cases/hopeless/case.json").write_text(kept, encoding="utf-8")
    text = page(SuiteRun(suite, Path("run"), (), True, NAMES))
    assert text.count("earlier: pass") == 2 and "earlier: fail" not in text


def test_the_level_of_the_baseline_is_drawn_if_it_looks_different(suite: Suite) -> None:
    words = "The level as it was when the baseline was recorded: room v0."
    assert words not in page(SuiteRun(suite, Path("run"), judged(suite, 1), True))
    edit("room.toml", "at = [8.0, 8.0, 0.0]", "at = [8.0, 7.0, 0.0]")
    text = page(SuiteRun(suite, Path("run"), judged(suite, 1), True))
    assert words in text and "no longer known" not in text
    edit("room.toml", "at = [8.0, 7.0, 0.0]", "at = [8.0, 6.0, 0.0]")
    references = tuple(replace(reference, texts=()) for reference in baseline_of(suite))
    cases = tuple(regress(suite, suite.cases[:1], references, Path("run"), 1, Played()))
    text = page(SuiteRun(suite, Path("run"), cases, True))
    assert words not in text and "how it was then is no longer known" in text


def test_the_page_of_the_shipped_suite_explains_its_findings(tmp_path: Path, suite: Suite) -> None:
    shipped = SuiteRun(read_suite(SHIPPED), tmp_path, (), True)
    text = page(shipped)
    assert "<h1>Regression report: shipped</h1>" in text
    assert "Its variants v1 and v2 were changed on purpose" in text
    assert '"suite": "suite.toml"' in json_text(shipped), "the file's name"
    other_text = page(SuiteRun(suite, tmp_path, (), True))
    assert "<h1>Regression report: game</h1>" in other_text and "on purpose" not in other_text
