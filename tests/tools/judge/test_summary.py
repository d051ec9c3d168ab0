from __future__ import annotations

import pytest

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.run import TraceOutcome
from tltlc.tools.judge.measures import Measure
from tltlc.tools.judge.summary import group_causes, group_text, summary_text, trace_text
from tltlc.tools.judge.verdict import JudgedTrace, RejectionCause, TraceVerdict

LAVA = ("avoid on_lava",)


UNREAD = JudgedTrace("b.csv", None, (Diagnostic("TLT0622", "line 4 of the trace cannot be read"),))


def _judged(cause: RejectionCause | None, samples: int = 50) -> JudgedTrace:
    outcome = TraceOutcome(cause is None, "holding" if cause is None else "violated", 50, 0.5, 0.0)
    return JudgedTrace("a.csv", TraceVerdict(outcome, "Reach the exit.", cause, samples))


def _summary(*causes: RejectionCause | None) -> str:
    return summary_text([_judged(cause) for cause in causes])


@pytest.mark.parametrize(
    ("steps", "words"),
    [
        ((3,), "1 breaks `avoid on_lava`, at step 3"),
        ((3, 3), "2 break `avoid on_lava`, at step 3"),
        ((3, 9, 3), "3 break `avoid on_lava`, mostly at step 3"),
        ((3, 4, 3, 4), "4 break `avoid on_lava`, at steps 3 to 4, half of them by step 3"),
        ((9, 2, 5), "3 break `avoid on_lava`, at steps 2 to 9, half of them by step 5"),
    ],
)
def test_the_summary_says_at_which_steps_a_clause_breaks(steps: tuple[int, ...], words: str) -> None:
    causes = [RejectionCause("broken", step, LAVA) for step in steps]
    assert _summary(None, *causes) == f"1 of {len(steps) + 1} accepted; {words}"


def test_a_group_can_be_said_with_the_number_of_all_traces() -> None:
    causes = (("a", RejectionCause("broken", 3, LAVA)), ("b", RejectionCause("broken", 3, LAVA)))
    (group,) = group_causes(causes)
    assert group_text(group, 100) == "2 of 100 break `avoid on_lava`, at step 3"


def test_broken_clauses_come_first_and_then_the_most_frequent_cause() -> None:
    text = _summary(
        RejectionCause("unfinished", 50, ("reach key", "reach out")),
        *[RejectionCause("unfinished", 50, ("reach out",))] * 2,
        RejectionCause("broken", 2, ()),
        RejectionCause("unfinished", 50, ()),
        *[RejectionCause("blocked", 7, ("reach out",))] * 2,
    )
    assert text == (
        "0 of 7 accepted; 1 breaks the spec, at step 2; "
        "2 make `reach out` impossible, at step 7; 2 end before `reach out` is met; "
        "1 ends before `reach key` and `reach out` are met; 1 ends too early"
    )


@pytest.mark.parametrize(
    ("cause", "text"),
    [
        (None, "accepted: holding after 50 steps"),
        (RejectionCause("broken", 3, LAVA), "not accepted: breaks `avoid on_lava` at step 3 of 50"),
        (RejectionCause("broken", 3, ()), "not accepted: breaks the spec at step 3 of 50"),
        (
            RejectionCause("broken", 3, ("keep health > 20",), ("health > 20",), Measure("health", 12.3456, 7.7, "")),
            "not accepted: breaks `keep health > 20` at step 3 of 50: health is 12.3",
        ),
        (
            RejectionCause("broken", 3, ("keep all g in guards: near(g)",), ("near(g1)",)),
            "not accepted: breaks `keep all g in guards: near(g)` at step 3 of 50: `near(g1)`",
        ),
        (RejectionCause("blocked", 3, ("reach a",)), "not accepted: makes `reach a` impossible at step 3 of 50"),
        (RejectionCause("unfinished", 50, ("reach a",)), "not accepted: `reach a` is not met after 50 steps"),
        (
            RejectionCause("unfinished", 50, ("reach a", "reach b")),
            "not accepted: `reach a` and `reach b` are not met after 50 steps",
        ),
        (RejectionCause("unfinished", 50, ()), "not accepted: it is too short after 50 steps"),
    ],
)
def test_a_line_says_why_a_trace_is_not_accepted(cause: RejectionCause | None, text: str) -> None:
    assert trace_text(_judged(cause)) == text


def test_traces_that_cannot_be_judged_are_counted_by_their_errors() -> None:
    assert summary_text([_judged(None), UNREAD]) == "1 of 2 accepted; 1 cannot be judged (1 TLT0622)"


def test_what_is_broken_before_an_error_is_said() -> None:
    assert trace_text(UNREAD) == "cannot be judged: line 4 of the trace cannot be read"
    broken = JudgedTrace("b.csv", None, UNREAD.diagnostics, RejectionCause("broken", 3, LAVA))
    assert trace_text(broken) == (
        "cannot be judged: line 4 of the trace cannot be read; before that, it breaks `avoid on_lava` at step 3"
    )


def test_steps_after_the_end_of_an_episode_do_not_count() -> None:
    assert trace_text(_judged(None, 80)) == "accepted: holding after 50 of 80 steps"
    late = _judged(RejectionCause("late", 50, ("reach a",)), 80)
    assert trace_text(late) == "not accepted: `reach a` is not met at the limit, after 50 of 80 steps"
    assert summary_text([late]) == "0 of 1 accepted; 1 reaches the limit before `reach a` is met"
