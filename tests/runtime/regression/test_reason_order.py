"""The reason that a person would give first comes first, and rewards come last."""

from __future__ import annotations

from tests.runtime.regression.handmade import an_episode, summaries
from tests.runtime.regression.room_findings import (  # noqa: F401
    MIDDLE,
    NORTH,
    _fspa,
    _level,
    deaths,
    states_after,
    successes,
)
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import Finding, findings, new_failures
from tltl_runtime.regression.report.case_report import CaseReport, headline
from tltl_runtime.regression.report.reason_order import ordered_reasons
from tltl_runtime.stealth.level import StealthLevel
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace

REACHED = Finding("no longer reaches `exit`: in 0 of 25; before: in 25", (0,), kind="unreached", short="no longer")
END = Finding("dies near `exit`; before: in 0 of 25", (1,), kind="end", short="dies near `exit`")
LENGTH = Finding("takes 40 more steps (4.00 s): 140; before: 100", (2,), kind="length", short="takes 40 more steps")
REMAINING = Finding("this remained: Reach a", (3,), kind="remaining", symbols="this remained: ◇a")
UNCHANGED = Finding("reaches `s1` as before", (), kind="unchanged")
FINDINGS = (UNCHANGED, END, REMAINING, LENGTH, REACHED)


def order(*main: str, is_worse: bool = True) -> list[str]:
    reasons = ordered_reasons(
        main, ["guard.toml changed"], ["met in 0"], FINDINGS, ["progress", "reward"], ["numpy 2"], is_worse=is_worse
    )
    return [reason.short for reason in reasons]


def test_what_happens_comes_before_its_cause_and_figures_and_versions_come_last() -> None:
    rest = ["met in 0", "reaches `s1` as before", "this remained: Reach a", "progress", "reward", "numpy 2"]
    happens = ["no longer", "dies near `exit`", "takes 40 more steps"]
    assert order() == [happens[0], "guard.toml changed", *happens[1:], *rest]
    assert order("nobody can reach it") == ["nobody can reach it", "guard.toml changed", *happens, *rest]


def test_failures_that_are_no_more_frequent_than_before_explain_nothing() -> None:
    assert order(is_worse=False)[:4] == ["no longer", "guard.toml changed", "takes 40 more steps", "met in 0"]


def test_steps_come_before_rewards_in_the_headline() -> None:
    statistics = ("met in 67 of 67", "reward is lower")
    assert headline("review", (), (LENGTH,), statistics, (), (), is_met=True) == "takes 40 more steps"
    assert headline("review", (), (), statistics, (), (), is_met=True) == "reward is lower"
    assert headline("review", (), (), statistics, (), (), is_met=False) == "met in 67 of 67"
    assert headline("pass", (), (LENGTH,), statistics, (), (END,), is_met=True) == (
        "new failure: dies near `exit`; before: in 0 of 25; met in 67 of 67"
    )


def test_the_report_of_a_case_uses_this_order() -> None:
    figures = figures_of(summaries(25))
    report = CaseReport(
        "a",
        "room",
        "v0",
        "review",
        ("met in 25 of 25",),
        figures=figures,
        baseline=figures,
        explanation=(UNCHANGED, LENGTH),
        edits=("guard.toml changed",),
        figure_changes=("reward is lower",),
    )
    assert report.reasons == (
        LENGTH.text,
        "guard.toml changed",
        "met in 25 of 25",
        UNCHANGED.text,
        "reward is lower",
    )
    assert [reason.kind for reason in report.ordered_reasons] == ["finding", "edit", "cause", "finding", "figure"]


def test_findings_say_what_they_are_about(level: StealthLevel, fspa: Fspa) -> None:
    now = findings(level, fspa, deaths(fspa, 25), successes(fspa))
    assert [finding.kind for finding in now] == ["unreached", "end", "remaining"]
    assert now[0].text == (
        "no longer reaches `exit`: in 0 of 25 episodes; before: in 25 of 25 episodes; reaches `s1`, `s2` as before"
    )
    assert now[1].short == "dies in the north hall by `guard` in 25 of 25 episodes"
    # The report has what remained in words, and in symbols for the switch of the page.
    assert "Reach near(exit), and keep alive throughout" in now[2].text
    assert "◇near(exit)" in now[2].symbols and "Reach" not in now[2].symbols
    fewer = findings(level, fspa, deaths(fspa, 14), successes(fspa))
    assert fewer[0].kind == "stage" and fewer[0].text.startswith("reaches `s1`, `s2` as before, then reaches `exit` in")
    assert [finding.kind for finding in findings(level, fspa, successes(fspa), successes(fspa))] == ["unchanged"]


def test_a_way_to_fail_that_the_baseline_lacks_is_new(level: StealthLevel, fspa: Fspa) -> None:
    before = [*deaths(fspa, 1, place=MIDDLE), *successes(fspa, 200)[25:]]
    (new,) = new_failures(level, fspa, deaths(fspa, 1, by=("dog",)), before)
    assert new.text == "dies in the north hall by `dog` in 1 of 25 episodes (4%); before: in 0 of 200"
    assert new.episodes == (0,)
    # The page leaves out the finding that says the same.
    assert new.short in {found.short for found in findings(level, fspa, deaths(fspa, 1, by=("dog",)), before)}
    # The place alone does not make a failure new, and neither does a greater number.
    assert new_failures(level, fspa, deaths(fspa, 3), before) == ()
    assert new_failures(level, fspa, successes(fspa), before) == ()


def test_running_out_of_time_before_another_goal_is_new(level: StealthLevel, fspa: Fspa) -> None:
    def late(stages: int) -> list[object]:
        return [an_episode(0, False, states=states_after(fspa, stages)), *successes(fspa)[1:]]

    assert new_failures(level, fspa, late(1), late(1)) == ()  # type: ignore[arg-type]
    (new,) = new_failures(level, fspa, late(1), late(2))  # type: ignore[arg-type]
    assert new.text.startswith("runs out of time in the middle in 1 of 25 episodes")


def test_only_new_failures_are_described_as_new(level: StealthLevel, fspa: Fspa) -> None:
    now = deaths(fspa, 3)
    now[1] = replace(now[1], by=("dog",), place=NORTH)
    (new,) = new_failures(level, fspa, now, deaths(fspa, 1))
    assert new.episodes == (1,)
