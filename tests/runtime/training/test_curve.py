"""The picture of the learning curve of a training."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from tltl_runtime.training.files.curve import curve_figure, draw_curve


def _point(steps: int, rate: float | None) -> dict[str, Any]:
    return {"steps": steps, "pass_rate": rate, "progress": rate}


CURVE = [_point(4096, None), *(_point(4096 * number, number / 10) for number in range(2, 11))]


def _texts(figure: Figure) -> set[str]:
    return {text.get_text() for text in figure.findobj(Text)}  # type: ignore[attr-defined]


def test_the_axes_are_labelled() -> None:
    texts = _texts(curve_figure("plans", CURVE))
    assert {"plans", "steps (decisions of all environments)", "pass rate, mean progress (0 to 1)"} < texts
    assert {"pass rate", "progress"} < texts
    assert "no episode has ended" not in texts


def test_the_legend_does_not_cover_the_axes() -> None:
    figure = curve_figure("plans", CURVE)
    figure.draw_without_rendering()
    (legend,) = figure.legends
    (axes,) = figure.axes
    assert not legend.get_window_extent().overlaps(axes.get_window_extent())


@pytest.mark.parametrize("curve", [[], CURVE[:1]])
def test_a_curve_without_episodes_has_a_note(curve: list[dict[str, Any]]) -> None:
    figure = curve_figure("plans", curve)
    assert "no episode has ended" in _texts(figure)
    assert not figure.legends


def test_a_single_point_is_visible() -> None:
    assert draw_curve("plans", CURVE[:2]) != draw_curve("plans", CURVE[:1])


def test_equal_curves_give_equal_pictures() -> None:
    pictures = [draw_curve("plans", curve) for curve in (CURVE, list(CURVE), CURVE[:-1])]
    assert [one == other for one, other in pairwise(pictures)] == [True, False]
    assert pictures[0].startswith(b"\x89PNG")
