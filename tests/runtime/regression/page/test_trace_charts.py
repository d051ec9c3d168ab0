"""The pictures of traces: the states of the automaton and the atoms over the steps."""

from __future__ import annotations

import re

from tltl_runtime.regression.explain.explained_episode import Arrival
from tltl_runtime.regression.report.page.trace_charts import trace_charts
from tltl_runtime.regression.report.trace_curves import TraceCurves
from tltlc import compile_text
from tltlc.core.record import replace

SPEC = "signal x: number in [0, 9]\nsignal y: number in [0, 9]\nspec s { reach x >= 7  keep y < 5 }"


def test_a_goal_with_an_inclusive_comparison_holds_where_the_sides_are_equal() -> None:
    (fspa,) = compile_text(SPEC)
    assert [atom.name for atom in fspa.atoms] == ["x < 7", "y < 5"]
    # At the last two samples, both atoms are 0: x is 7, and y is 5.
    curves = TraceCurves("t.csv", "", ((0.5, 0.5), (0.0, 0.0), (0.0, 0.0)), (Arrival(0, 0),))
    charts = trace_charts(fspa, {0: curves}, "case")
    assert "x &gt;= 7 holds from step 2 to 3" in charts
    assert "y &lt; 5 holds at step 1" in charts
    assert "x &lt; 7 holds" not in charts


def test_failed_traces_come_first_and_their_last_state_can_be_seen() -> None:
    (fspa,) = compile_text(f"clock 10 Hz\n{SPEC}")
    (violated,) = (state.id for state in fspa.states if state.verdict == "violated")
    steps = 700
    accepted = TraceCurves("a.csv", "accepted", ((0.5, 0.5),) * steps, (Arrival(0, 0),), is_accepted=True)
    broken = replace(
        accepted, name="b.csv", ended="breaks `keep y < 5`", arrivals=(Arrival(0, 0), Arrival(violated, steps))
    )
    charts = trace_charts(fspa, {0: accepted, 1: replace(broken, is_accepted=False)}, "case")
    assert charts.index("b.csv") < charts.index("a.csv")
    (box,) = (tag for tag in re.findall(r"<rect[^>]*>", charts) if "stay violated" in tag)
    (left, width), (picture,) = (
        re.findall(r'(?: x| width)="([\d.]+)"', box),
        set(re.findall(r'viewBox="0 0 (\d+)', charts)),
    )
    assert float(width) >= 20 and float(left) + float(width) <= float(picture)
    assert f"state {violated}, from step 700 (69.9 s): " in charts
