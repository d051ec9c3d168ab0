"""The report on a played case."""

from __future__ import annotations

from pathlib import Path

from tests.runtime.regression.game import Played, edit
from tests.runtime.regression.handmade import some_episodes
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tltl_runtime.regression.explain.explained_episode import summaries_of
from tltl_runtime.regression.report.case_report import report_on
from tltl_runtime.regression.suite.suite import read_suite
from tltl_runtime.regression.suite_run import regress
from tltl_runtime.regression.verdict.baseline import baseline_of
from tltl_runtime.regression.verdict.play import CaseEpisode, JudgedCase, prepare_case
from tltl_runtime.regression.verdict.verdict import judge
from tltlc.core.record import replace


def test_the_report_lists_the_changed_keys_of_a_file(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    edit("room.toml", "at = [8.0, 8.0, 0.0]", "at = [8.0, 7.0, 0.0]")
    (done,) = regress(suite, suite.cases[:1], baseline_of(suite), Path("run"), 1, Played())
    (text,) = done.report.edits
    assert text.startswith("changed since the baseline: room.toml (") and "[8, 7, 0]" in text.replace(".0", "")
    # What happens comes first, then what has changed.
    assert text in done.report.reasons[:2]
    assert done.report.verdict == "pass" or done.report.headline.endswith(f"; {text}")


def test_the_headline_is_no_failure_that_is_as_frequent_as_before(game: Path) -> None:
    suite = read_suite(Path("game.toml"))
    ready_case, reference = prepare_case(suite.cases[0], suite.seed), baseline_of(suite)[0]
    now = some_episodes(47, 3)

    def headline(before: int) -> str:
        compared = replace(reference, episodes=tuple(some_episodes(before, 50 - before)))
        judgement = judge(summaries_of(now), summaries_of(compared.episodes), 50, ready_case.case.thresholds, 0.05)
        assert judgement is not None and judgement.verdict == "review"
        return report_on(
            JudgedCase(ready_case, compared, judgement, tuple(CaseEpisode(explained, b"") for explained in now))
        ).headline

    unchanged = (
        "nothing has changed since the baseline: the level, the spec, the policy and all versions are those of the "
        "baseline"
    )
    first, _, rest = headline(47).partition("; ")
    assert first.startswith("met in 47 of 50 episodes (94%), before in 47 of 50 (94%): ") and rest == unchanged
    assert headline(50) == f"runs out of time in the middle in 3 of 50 episodes (6%); {unchanged}"
