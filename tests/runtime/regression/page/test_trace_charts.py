"""The pictures of traces: the states of the automaton and the atoms over the steps."""

from __future__ import annotations

from tltl_runtime.regression.explain.explained_episode import Arrival
from tltl_runtime.regression.report.page.trace_charts import trace_charts
from tltl_runtime.regression.report.trace_curves import TraceCurves
from tltlc import compile_text

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
