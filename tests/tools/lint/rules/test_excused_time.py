"""TLT0482: conditions that excuse a time only at its first step."""

from __future__ import annotations

from itertools import product

import pytest

from tests.tools.lint.helpers import RANGES, SIGNALS, accepted_traces, block, codes, findings_in

BEFORE = f"clock 10 Hz\n{RANGES}signal d: bool\nsignal mode: (idle, alert, chase)\nlet done = once c\n"


@pytest.mark.parametrize(
    ("clause", "offered", "title"),
    [
        (
            "keep begins a implies (always for 0.5 s b) or c",
            "keep begins a implies (always for 0.5 s b) or (b until c)",
            "`c` counts only at the step of `begins a`",
        ),
        (
            "keep a implies c or (always for 0.5 s not b)",
            "keep a implies (always for 0.5 s not b) or (not b until c)",
            "`c` counts only at the step of `a`",
        ),
        (
            "keep a or d implies c or always for 3 steps b",
            "keep a or d implies (always for 3 steps b) or (b until c)",
            "`c` counts only at the step of `a or d`",
        ),
        (
            "keep (a iff d) implies (c or (always for 0.5 s (b or d)) or begins x > 3)",
            "keep (a iff d) implies (always for 0.5 s (b or d)) or ((b or d) until (c or begins x > 3))",
            "`c or begins x > 3` counts only at the step of `a iff d`",
        ),
        (
            "keep a implies (always for 0.5 s b) or (c and x > 3)",
            "keep a implies (always for 0.5 s b) or (b until (c and x > 3))",
            "`c and x > 3` counts only at the step of `a`",
        ),
        (
            "require always (a implies ((always for 0.5 s b) or mode is chase))",
            "((always for 0.5 s b) or (b until mode is chase))",
            "`mode is chase` counts only at the step of `a`",
        ),
    ],
)
def test_an_excuse_from_a_time_gets_a_note(clause: str, offered: str, title: str) -> None:
    (note,) = (
        item.diagnostic for item in findings_in(block(clause, before=BEFORE)) if item.diagnostic.code == "TLT0482"
    )
    assert (note.severity, note.title) == ("note", title)
    assert f"write `{offered}`;" in (note.help or "")
    if offered.startswith("keep"):
        assert "TLT0482" not in codes(block(offered, before=BEFORE))


@pytest.mark.parametrize("condition", ["a", "begins a"])
def test_the_offered_rule_ends_the_time(condition: str) -> None:
    typed, offered = (
        accepted_traces(block(f"keep {condition} implies (always for 3 steps b) or {end}", before=SIGNALS), "abc", 4)
        for end in ("c", "(b until c)")
    )
    samples = ["".join(names) for names in product(*(("", name) for name in "abc"))]
    traces = [trace for length in range(1, 5) for trace in product(samples, repeat=length)]
    assert typed < offered == {trace for trace in traces if is_kept(trace, condition)}


def is_kept(trace: tuple[str, ...], condition: str) -> bool:
    """Whether b holds at the three steps from each step with the condition on, or until c."""
    for start, sample in enumerate(trace):
        if "a" in sample and not (condition == "begins a" and start and "a" in trace[start - 1]):
            window = trace[start : start + 3]
            if not all("b" in now or "c" in "".join(window[: place + 1]) for place, now in enumerate(window)):
                return False
    return True


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies (always for 0.5 s b) or (b until c)",
        "keep a implies (always for 0.5 s b) or once c",
        "keep a implies (always for 0.5 s b) or done",
        "keep a implies (always for 0.5 s b) or previously c",
        "keep a implies (always for 0.5 s b) or times(c) > 2",
        "keep a implies (always for 0.5 s b) or time_since(c) < 2 s",
        "keep a implies (always for 0.5 s b) or not b",
        "keep a implies (always for 0.5 s b) or b",
        "keep a implies (always for 0.5 s x < 3) or x >= 2",
        "keep begins a implies (always for 0.5 s b) or not a",
        "keep begins mode is idle implies (always for 0.5 s b) or mode is chase",
        "keep a implies (always for 0.5 s b) or (eventually c)",
        "keep a implies (always b) or c",
        "keep a implies next ((always for 0.5 s b) or c)",
        "keep a implies always for 0.5 s (b or c)",
        # TLT0446 warns that `always` applies to b alone.
        "keep a implies always for 0.5 s b or c",
        "keep (always for 0.5 s b) or c",
        "avoid a and not ((always for 0.5 s b) or c)",
        "keep a implies (always for 0.5 s b) or c  // tltlc: allow TLT0482",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0482" not in codes(block(clause, before=BEFORE))


def test_a_clock_that_varies_gets_none() -> None:
    before = BEFORE.replace("10 Hz", "varies")
    assert "TLT0482" not in codes(block("keep begins a implies (always for 0.5 s b) or c", before=before))
