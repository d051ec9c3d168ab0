"""Films of an episode: a view of the game above a strip with the automaton's judgement."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from math import cos, sin
from pathlib import Path
from typing import Final

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from tltl_runtime.game.films import Picture
from tltl_runtime.game.palette import state_colour
from tltl_runtime.stealth.level import Point, StealthLevel
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.rendering.camera import FilmView, View
from tltl_runtime.stealth.rendering.hud import LOW_HEALTH
from tltl_runtime.stealth.rendering.interpolation import interpolate
from tltl_runtime.stealth.rendering.plan import BARRIERS, backdrop
from tltl_runtime.stealth.rendering.render import Renderer
from tltl_runtime.stealth.snapshot import Snapshot
from tltlc.api import Notation, label_text

Moment = tuple[int, Snapshot]
Pixel = Callable[[Point], tuple[float, float]]

STRIP: Final = 60
"""The height of the strip below the view, in pixels."""

_INSTANT: Final = 1e-6
"""Times that differ by no more than this many seconds are equal."""

_TEXT: Final = 12
_BAR: Final = 90
"""The greatest width of a bar, in pixels."""
_BARS_FROM: Final = 80
_GAP: Final = 6
_LINES: Final = (25, 41)
"""The vertical positions, in the strip, of the two lines that say what remains to be satisfied."""

_PAPER: Final = "#0f172a"
_PALE: Final = "#e2e8f0"
_EMPTY: Final = "#334155"
_AMBER: Final = "#f59e0b"
_GREEN: Final = "#22c55e"
_RED: Final = "#ef4444"
MODES: Final = {"patrol": "#7f1d1d", "chase": "#ff0000", "search": "#f97316", "return": "#64748b"}
_FONT: Final = Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")


def frames(
    episode: Episode, times: Sequence[float], view: FilmView, size: tuple[int, int], notation: Notation = "english"
) -> Iterator[Picture]:
    """Yield one RGB picture of ``size`` (width, height) for each of ``times``.

    ``times`` are in seconds since the reset, in rising order. At a time between two snapshots, the
    positions of bodies are interpolated, and the automaton is in the state of the earlier snapshot.
    """
    width, height = size
    font = ImageFont.truetype(str(_FONT), _TEXT)
    moments = [_moment(episode, time) for time in times]
    inner = (width, height - STRIP)
    pictures = _draw_plans(episode, moments, inner) if view == "plan" else _draw_view(episode, moments, view, inner)
    for moment, picture in zip(moments, pictures, strict=True):
        yield _add_strip(picture, episode, moment, font, notation)


def _moment(episode: Episode, time: float) -> Moment:
    """Return the number of time steps that are over at ``time``, and the snapshot at that time.

    Between two recorded snapshots, the result is interpolated. ``time`` is in seconds since the
    reset.
    """
    shots = episode.snapshots
    row = min(max(0, bisect_right(shots, time + _INSTANT, key=lambda shot: shot.time) - 1), len(shots) - 1)
    since = time - shots[row].time
    if since <= _INSTANT or row == len(shots) - 1:
        return row, shots[row]
    return row, interpolate(shots[row], shots[row + 1], since / (shots[row + 1].time - shots[row].time))


def _draw_view(episode: Episode, moments: Sequence[Moment], view: View, size: tuple[int, int]) -> Iterator[Picture]:
    renderer = Renderer(episode.level, *size)
    try:
        for _, shot in moments:
            yield renderer.frame(shot, view)
    finally:
        renderer.close()


# --- the plan with moving bodies --------------------------------------------------------------------


def _draw_plans(episode: Episode, moments: Sequence[Moment], size: tuple[int, int]) -> Iterator[Picture]:
    """Yield a picture of the level from above for each moment, with all bodies and the player's path so far."""
    empty, pixel = backdrop(episode.level, size)
    trail = Image.fromarray(empty)
    draw = ImageDraw.Draw(trail)
    places = [pixel(shot.player.position) for shot in episode.snapshots]
    drawn_to = moments[0][0]
    for row, shot in moments:
        for before in range(drawn_to, row):
            draw.line(places[before : before + 2], fill=state_colour(int(episode.states[before])), width=2)
        drawn_to = row
        picture = trail.copy()
        _populate(picture, pixel, episode.level, shot, state_colour(int(episode.states[row])))
        yield np.asarray(picture)


def _populate(picture: Image.Image, pixel: Pixel, level: StealthLevel, shot: Snapshot, colour: str) -> None:
    """Draw on a plan what can move: the shut barriers, the movers, the enemies and the player.

    The player is drawn in this ``colour``. ``pixel`` converts a position in the level to a pixel.
    """
    draw = ImageDraw.Draw(picture)
    metre = pixel((1.0, 0.0, 0.0))[0] - pixel((0.0, 0.0, 0.0))[0]
    for barrier, is_open in zip(level.barriers, shot.open, strict=True):
        if not is_open:
            draw.rectangle(_corners(pixel, barrier.box.low, barrier.box.high), fill=BARRIERS[barrier.kind])
    for mover, (x, y, z) in zip(level.movers, shot.movers, strict=True):
        half_x, half_y = mover.size[0] / 2, mover.size[1] / 2
        box = _corners(pixel, (x - half_x, y - half_y, z), (x + half_x, y + half_y, z))
        draw.rectangle(box, fill="#7c3aed")
    for place, yaw, mode in zip(shot.enemies, shot.yaws, shot.modes, strict=True):
        _figure(draw, pixel(place), yaw, 0.35 * metre, MODES.get(mode, _RED))
    radius = (0.22 if shot.player.crouching else 0.35) * metre
    _figure(draw, pixel(shot.player.position), shot.player.yaw, radius, colour)


def _corners(pixel: Pixel, low: Point, high: Point) -> tuple[float, ...]:
    (left, bottom), (right, top) = pixel(low), pixel(high)
    return left, top, right, bottom


def _figure(draw: ImageDraw.ImageDraw, at: tuple[float, float], yaw: float, radius: float, colour: str) -> None:
    """Draw a body from above, as a disc with a line in the direction of its ``yaw``.

    ``at`` and ``radius`` are in pixels.
    """
    x, y = at
    draw.line((x, y, x + 2 * radius * cos(yaw), y - 2 * radius * sin(yaw)), fill=_PAPER, width=2)
    draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=colour, outline=_PAPER)


# --- the strip --------------------------------------------------------------------------------------


def _add_strip(
    view: Picture, episode: Episode, moment: Moment, font: ImageFont.FreeTypeFont, notation: Notation
) -> Picture:
    """Add a strip below the view: time, progress, health, and what remains to be satisfied.

    The bars have the colours that they have in the window of the game.
    """
    height, width, _ = view.shape
    picture = Image.new("RGB", (width, height + STRIP), _PAPER)
    picture.paste(Image.fromarray(view), (0, 0))
    draw = ImageDraw.Draw(picture)
    row, shot = moment
    state = int(episode.states[row])
    top = height + 5
    draw.text((8, top), f"{shot.time:6.2f} s", _PALE, font)
    health = episode.snapshots[row].health
    bars = (
        ("progress", float(episode.progress[row]), _AMBER),
        ("health", health, _GREEN if health > LOW_HEALTH else _RED),
    )
    words = sum(int(font.getlength(text)) + 3 * _GAP for text in ("progress", "health", episode.end))
    bar = max(2 * _GAP, min(_BAR, (width - _BARS_FROM - words) // 2))
    x = _BARS_FROM
    for name, share, colour in bars:
        draw.text((x, top), name, _PALE, font)
        x += int(font.getlength(name)) + _GAP
        draw.rectangle((x, top + 3, x + bar, top + 12), fill=_EMPTY)
        if share > 0.0:
            draw.rectangle((x, top + 3, x + round(bar * share), top + 12), fill=colour)
        x += bar + 2 * _GAP
    if row == len(episode.actions):
        draw.text((x, top), episode.end, _PALE, font)
    draw.rectangle((8, height + _LINES[0] + 2, 16, height + _LINES[0] + 12), fill=state_colour(state))
    lines = _break_lines(label_text(episode.fspa, state, notation), width - 30, font)
    for line, y in zip(lines, _LINES, strict=False):
        draw.text((22, height + y), line, _PALE, font)
    return np.asarray(picture)


def _break_lines(text: str, width: int, font: ImageFont.FreeTypeFont) -> list[str]:
    """Break a text into lines at most ``width`` pixels wide, for a film's strip.

    Cut off what does not fit on two lines.
    """
    lines: list[str] = []
    while text and len(lines) < len(_LINES):
        line = text
        while font.getlength(line) > width:
            line = line.rpartition(" ")[0] if " " in line else line[:-1]
        text = text[len(line) :].lstrip()
        lines.append(line)
    if text:
        lines[-1] = lines[-1][:-1] + "…"
    return lines
