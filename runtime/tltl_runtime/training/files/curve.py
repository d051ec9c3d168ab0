"""Plot the learning curve of a training: pass rate and progress over steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from io import BytesIO
from typing import Any, Final

from matplotlib.figure import Figure

_PASS_RATE, _PROGRESS, _INK = "#16a34a", "#2563eb", "#0f172a"
_SIZE: Final = (8.0, 4.5)
_DPI: Final = 100


def draw_curve(title: str, curve: Sequence[Mapping[str, Any]]) -> bytes:
    """Return a learning ``curve`` as a PNG.

    Each point has ``steps``, ``pass_rate`` and ``progress``. The last two are None before the first
    episode has ended.
    """
    picture = BytesIO()
    curve_figure(title, curve).savefig(picture, format="png", metadata={"Software": None})
    return picture.getvalue()


def curve_figure(title: str, curve: Sequence[Mapping[str, Any]]) -> Figure:
    """Return the figure that :func:`draw_curve` draws.

    If no episode has ended, the figure has a note instead of curves.
    """
    points = [point for point in curve if point["pass_rate"] is not None]
    steps = [point["steps"] for point in points]
    figure = Figure(figsize=_SIZE, dpi=_DPI, layout="constrained")
    axes = figure.add_subplot()
    # A single point makes no line, so it needs a marker.
    style: dict[str, Any] = {"marker": "o" if len(points) == 1 else None}
    axes.plot(steps, [point["progress"] for point in points], color=_PROGRESS, linewidth=1.2, label="progress", **style)
    axes.plot(
        steps, [point["pass_rate"] for point in points], color=_PASS_RATE, linewidth=2.0, label="pass rate", **style
    )
    axes.set_title(title, color=_INK, fontsize=11)
    axes.set_xlabel("steps (decisions of all environments)")
    axes.set_ylabel("pass rate, mean progress (0 to 1)")
    axes.set_ylim(-0.02, 1.02)
    axes.set_xlim(0, max((point["steps"] for point in curve), default=1))
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
    axes.grid(color="#e2e8f0")
    axes.spines[["top", "right"]].set_visible(False)
    if points:
        figure.legend(loc="outside lower center", ncols=2, frameon=False)
    else:
        note = "no episode has ended"
        axes.text(0.5, 0.5, note, color=_INK, ha="center", va="center", transform=axes.transAxes)
    return figure
