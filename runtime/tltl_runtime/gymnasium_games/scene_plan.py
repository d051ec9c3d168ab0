"""The plan of a scene: its outline from above, with paths of players."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.game.geometry import Point
from tltl_runtime.game.mentions import region_text
from tltl_runtime.game.outline import LevelOutline, MapImage
from tltl_runtime.game.plan import Plan, area, draw_path, draw_paths, plan_axes, text_scale, write_name
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.gymnasium_games.scene_map_scale import bounds_around, scale_of
from tltl_runtime.gymnasium_games.scene_maps import AREA, BOX, FLOOR, LANDMARK
from tltlc.api import Fspa, Notation


def draw_scene_episode(episode: SceneEpisode, size: tuple[int, int] | None, notation: Notation) -> bytes:
    """Draw the path of an episode as a PNG: see :func:`~tltl_runtime.game.plan.draw_path`."""
    assert episode.positions is not None, "the game does not say where the player is"
    landmarks = {} if episode.entities is None else episode.entities.still()
    plan = _plan(episode.level, landmarks, episode.positions[:, :2], _unit(episode.fspa))
    path: list[Point] = [(x, y, z) for x, y, z in episode.positions.tolist()]
    return draw_path(plan, episode, path, size, notation)


def draw_scene_trajectories(level: SceneLevel, fspa: Fspa, trajectories: Sequence[Trajectory], title: str) -> bytes:
    """Draw the trajectories of many episodes as a PNG: see :func:`~tltl_runtime.game.plan.draw_paths`."""
    if level.is_one_of_many:
        title += ", on the map of one of them"
    points = np.concatenate([trajectory.points for trajectory in trajectories]).astype(np.float64)
    return draw_paths(_plan(level, dict(level.landmarks), points, _unit(fspa)), fspa, trajectories, title)


def _plan(level: SceneLevel, landmarks: dict[str, Point], points: NDArray[np.float64], unit: str) -> Plan:
    """Return the plan of a scene with its outline and landmarks.

    ``points``, (n, 2), are the points of the paths to draw. Without an outline, the plan's bounds
    enclose these points. ``unit`` is that of the coordinates; empty if it is not known.
    """
    bounds = bounds_around(points) if level.bounds is None else level.bounds
    metre = scale_of(bounds)

    def axes(figure: Figure) -> Any:
        scale = text_scale(figure, bounds, metre)
        drawn = plan_axes(figure, bounds, f"{level.name} {level.variant}", scale, unit)
        drawn.set_facecolor(FLOOR)
        if level.outline is not None:
            _add_outline(drawn, level.outline, 8 * scale)
        for name, place in landmarks.items():
            drawn.plot(*place[:2], marker="o", markersize=8 * scale, color=LANDMARK, markeredgecolor=BOX)
            write_name(drawn, name, place, 8 * scale)
        return drawn

    return Plan(bounds, axes, metre)


def _unit(fspa: Fspa) -> str:
    """Return the unit of positions: metres if a signal of the spec is a length; else it is not known, and empty."""
    return "m" if any(signal.type == "length" for signal in fspa.signals) else ""


def _add_outline(axes: Any, outline: LevelOutline, letters: float) -> None:
    if outline.image is not None:
        _add_image(axes, outline.image)
    for polygon in outline.polygons:
        axes.add_patch(Polygon(polygon.corners, facecolor=AREA, edgecolor="#0369a1", linewidth=0.6))
    for item in sorted(outline.boxes, key=lambda item: item.box.high[2]):
        axes.add_patch(area(item.box, facecolor=BOX, edgecolor="#94a3b8", linewidth=0.4))
    for region in outline.regions:
        axes.add_patch(area(region.box, fill=False, edgecolor="#64748b", linewidth=0.6, linestyle=":"))
        (west, _, _), (_, north, _) = region.box.low, region.box.high
        # matplotlib treats text between dollar signs as mathematics.
        name = region_text(region.name).replace("$", r"\$")
        axes.annotate(
            name, (west, north), xytext=(3, -3), textcoords="offset points", va="top", fontsize=letters, style="italic"
        )


def _add_image(axes: Any, image: MapImage) -> None:
    """Draw the image of an outline; do nothing if it is damaged, because recordings may contain anything."""
    from PIL import Image

    west, south, east, north = image.extent
    try:
        pixels = np.asarray(Image.open(BytesIO(image.png), formats=("PNG",)).convert("RGB"))
    except Exception:  # Pillow may raise many exceptions for damaged pictures
        return
    limits = axes.get_xlim(), axes.get_ylim()
    axes.imshow(pixels, extent=(west, east, south, north), interpolation="nearest", zorder=0)
    axes.set(xlim=limits[0], ylim=limits[1])
