"""Pictures: equal snapshots give equal pictures, everything is shown, and nothing hides the player."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tltl_runtime.stealth.enemies.enemy import Enemies, PlayerView
from tltl_runtime.stealth.level import Box
from tltl_runtime.stealth.levels.file import level_names, load_level
from tltl_runtime.stealth.rendering.camera import VIEWS, View, camera, pixels, sight_lines
from tltl_runtime.stealth.rendering.cone import SightField
from tltl_runtime.stealth.rendering.render import Renderer
from tltl_runtime.stealth.rendering.scene import PLAYER
from tltl_runtime.stealth.simulation import Simulation
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.player import PlayerState

SIZE = (240, 160)


@pytest.fixture(scope="module", params=level_names())
def drawn(request: Any) -> Iterator[tuple[Snapshot, Renderer]]:
    game = Simulation(load_level(request.param))
    renderer = Renderer(game.level, *SIZE)
    yield game.snapshot(), renderer
    renderer.close()
    game.close()


def changed(snapshot: Snapshot, **fields: Any) -> Snapshot:
    names = ("time", "player", "health", "enemies", "yaws", "modes", "sees", "movers", "active", "open")
    return Snapshot(**{**{name: getattr(snapshot, name) for name in names}, **fields})


def standing(place: tuple[float, float, float], crouching: bool = False) -> PlayerState:
    return PlayerState(place, (0.0, 0.0, 0.0), 0.0, crouching, True, 1.0)


def amount(frame: NDArray[np.uint8], colour: tuple[float, float, float]) -> int:
    """Return how many pixels have about this hue, bright or dark."""
    pixel = frame / np.linalg.norm(frame, axis=2, keepdims=True).clip(1)
    return int((pixel @ (np.array(colour) / np.linalg.norm(colour)) > 0.985).sum())


@pytest.mark.parametrize("view", VIEWS)
def test_the_same_snapshot_gives_the_same_picture(drawn: tuple[Snapshot, Renderer], view: View) -> None:
    snapshot, renderer = drawn
    frame = renderer.frame(snapshot, view)
    assert frame.shape == (SIZE[1], SIZE[0], 3) and frame.dtype == np.uint8
    renderer.frame(changed(snapshot, player=standing((5.0, 5.0, 0.0)), open=(True,) * len(snapshot.open)), view)
    assert np.array_equal(renderer.frame(snapshot, view), frame)
    second_renderer = Renderer(renderer.level, *SIZE)
    assert np.array_equal(second_renderer.frame(snapshot, view), frame)
    second_renderer.close()
    assert len(np.unique(frame.reshape(-1, 3), axis=0)) > 50


def test_the_player_is_visible_at_every_place(drawn: tuple[Snapshot, Renderer]) -> None:
    snapshot, renderer = drawn
    low, high = renderer.level.bounds.low, renderer.level.bounds.high
    solids = [solid.box for solid in renderer.level.solids if solid.kind != "floor"]
    rng = np.random.default_rng(1)
    for _ in range(12):
        x, y = (float(rng.uniform(low[axis] + 0.5, high[axis] - 0.5)) for axis in (0, 1))
        if any(is_in(box, x, y) for box in solids):
            continue
        frame = renderer.frame(changed(snapshot, player=standing((x, y, 0.0))))
        assert amount(frame, PLAYER) > 25, (x, y)


def is_in(box: Box, x: float, y: float) -> bool:
    return box.low[0] - 0.3 < x < box.high[0] + 0.3 and box.low[1] - 0.3 < y < box.high[1] + 0.3


def test_a_crouching_player_is_smaller(drawn: tuple[Snapshot, Renderer]) -> None:
    snapshot, renderer = drawn
    place = renderer.level.start.position
    upright = amount(renderer.frame(changed(snapshot, player=standing(place))), PLAYER)
    crouched = amount(renderer.frame(changed(snapshot, player=standing(place, True))), PLAYER)
    assert 0.4 < crouched / upright < 0.8


def test_open_barriers_disappear_and_active_switches_change(drawn: tuple[Snapshot, Renderer]) -> None:
    snapshot, renderer = drawn
    level = renderer.level
    shut = renderer.frame(snapshot, "top_down")
    opened = renderer.frame(changed(snapshot, open=(True,) * len(snapshot.open)), "top_down")
    eye = camera(level, "top_down", snapshot.player.position, SIZE[0] / SIZE[1])
    for box in (barrier.box for barrier in level.barriers if barrier.name != "gap"):
        top = [*np.add(box.low, box.high)[:2] / 2, box.high[2]]
        x, y = pixels(eye, np.array([top]), *SIZE)[0].astype(int)
        window = (slice(y - 1, y + 2), slice(x - 1, x + 2))
        assert np.abs(shut[window] - opened[window].astype(int)).max() > 30
    active = renderer.frame(changed(snapshot, active=(True,) * len(snapshot.active)), "top_down")
    assert np.abs(active - renderer.frame(snapshot, "top_down").astype(int)).max() > 30


def test_the_drawn_field_of_sight_agrees_with_the_enemy() -> None:
    level = load_level("cover_and_hide")
    enemies = Enemies(level)
    enemies.reset(np.random.default_rng(0))
    guard = enemies.guards[0]
    boxes = [solid.box for solid in level.solids]
    rng = np.random.default_rng(2)
    wrong = tried = 0
    for _ in range(20):
        guard.x, guard.y = rng.uniform((4.0, 1.0), (16.0, 13.0))
        if any(is_in(box, guard.x, guard.y) for box in boxes if box.high[2] > 0):
            continue
        guard.yaw = float(rng.uniform(-3, 3))
        field = SightField(guard.kind, (guard.x, guard.y, 0.0), guard.yaw, boxes)
        places = rng.uniform((0.5, 0.5), (19.5, 13.5), (60, 2))
        shown = field.visibility(places.astype(np.float32)) > 0.25
        for place, is_shown in zip(places, shown, strict=True):
            if any(is_in(box, *place) for box in boxes if box.high[2] > 0):
                continue
            guard.knows = False
            guard.dt = 0.0
            guard._look(PlayerView((place[0], place[1], 0.0)), enemies._boxes)
            tried += 1
            wrong += guard.sees != is_shown
    assert tried > 200
    # Exceptions are places at the edges of shadows, and players of whom only the chest is visible.
    assert wrong / tried < 0.03


def test_pixels_and_sight_lines_agree() -> None:
    level = load_level("branching")
    for view in VIEWS:
        eye = camera(level, view, (5.0, 5.0, 0.0), 1.5)
        lines = sight_lines(eye, 30, 20)
        places = np.array(eye.eye) + (eye.near + 7.0) * lines[[3, 11], [4, 25]]
        assert pixels(eye, places, 30, 20) == pytest.approx(np.array([[4.5, 3.5], [25.5, 11.5]]), abs=1e-3)


def test_names_are_drawn_at_their_entities(drawn: tuple[Snapshot, Renderer]) -> None:
    snapshot, renderer = drawn
    level = renderer.level
    shown = {name: (x, y) for name, x, y in renderer.names(snapshot, "top_down")}
    entities = (*level.switches, *level.exits, *level.barriers, *level.movers, *level.enemies)
    assert shown.keys() == {entity.name for entity in entities}
    # North is up and east is right.
    for axis, sign in ((0, 1), (1, -1)):
        order = sorted(level.switches, key=lambda switch: sign * switch.position[axis])
        coordinates = [shown[switch.name][axis] for switch in order]
        assert all(a < b + 0.5 for a, b in pairwise(coordinates))
    opened = renderer.names(changed(snapshot, open=(True,) * len(snapshot.open)), "top_down")
    assert not {name for name, *_ in opened} & {barrier.name for barrier in level.barriers}
    near = renderer.names(snapshot)
    assert all(0 <= x < SIZE[0] and 0 <= y < SIZE[1] for _, x, y in near)


def test_finer_samples_do_not_change_the_size() -> None:
    game = Simulation(load_level("branching"))
    renderer = Renderer(game.level, 60, 40, samples=2)
    assert renderer.frame(game.snapshot()).shape == (40, 60, 3)
    renderer.close()
    renderer.close()
    game.close()
