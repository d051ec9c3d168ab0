"""Which places a player can reach, in rooms built in code and in the shipped levels.

In the physics, the player never gets to a place that counts as unreachable.
"""

from __future__ import annotations

from contextlib import closing
from types import SimpleNamespace

import numpy as np
import pytest

from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.capabilities.feasible import is_infeasible, reach_warnings
from tltl_runtime.stealth.capabilities.reach import Reach, compute_reach, highest_lift
from tltl_runtime.stealth.capabilities.space import Budget, SpaceGrid, distances, flood
from tltl_runtime.stealth.level import (
    Barrier,
    Box,
    Exit,
    Mover,
    Point,
    Sensors,
    Solid,
    Start,
    StealthLevel,
    Switch,
    Unlock,
)
from tltl_runtime.stealth.levels.file import level_names, load_level, variants
from tltl_runtime.stealth.levels.level_tables import enclosure
from tltl_runtime.stealth.world.physics import World
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import WORK

BOUNDS = Box((0.0, 0.0, -0.5), (12.0, 5.0, 4.0))
SHIPPED = [(name, variant) for name in level_names() for variant in variants(name)]
BLOCKED = ("navigation", "v2")


def room(*boxes: Box, end: Point = (10.5, 2.5, 0.0), movers: tuple[Mover, ...] = ()) -> StealthLevel:
    """Return a room 12 m long, with the start in the west, the exit in the east, and ``boxes`` between them."""
    solids = [Solid(f"box_{number}", "wall", box) for number, box in enumerate(boxes)]
    return StealthLevel(
        name="room",
        variant="v0",
        doc="A room.",
        bounds=BOUNDS,
        start=Start((1.5, 2.5, 0.0)),
        solids=(*enclosure(BOUNDS), *solids),
        switches=(),
        barriers=(),
        unlocks=(),
        movers=movers,
        enemies=(),
        exits=(Exit("exit", end),),
        sensors=Sensors((), (), None),
        spec=None,
        files=(),
    )


def wall(low: float, high: float, x: float = 6.0, thick: float = 0.2, south: float = 0.0, north: float = 5.0) -> Box:
    """Return a wall across the room, from the height ``low`` to ``high``."""
    return Box((x, south, low), (x + thick, north, high))


def pit(width: float) -> tuple[Box, Box]:
    """Return two platforms, 2 m high, with a gap between them. They cannot be climbed from the floor."""
    return Box((0.2, 0.2, 0.0), (4.0, 4.8, 2.0)), Box((4.0 + width, 0.2, 0.0), (11.8, 4.8, 2.0))


@pytest.mark.parametrize(
    ("boxes", "reached"),
    [
        ((), True),
        ((wall(0.0, 4.0),), False),
        ((wall(0.0, 1.2),), True),
        ((wall(0.0, 1.35),), False),
        ((wall(0.9, 4.0),), True),
        ((wall(0.7, 4.0),), False),
        ((wall(0.0, 4.0, north=2.2), wall(0.0, 4.0, south=2.9)), True),
        ((wall(0.0, 4.0, north=2.3), wall(0.0, 4.0, south=2.7)), False),
        ((wall(0.0, 2.0), Box((4.5, 2.0, 0.0), (5.3, 2.8, 1.0))), True),
        ((wall(0.0, 2.4), Box((4.5, 2.0, 0.0), (5.3, 2.8, 1.0))), False),
    ],
)
def test_the_exit_is_reached_exactly_if_the_boxes_leave_a_way(boxes: tuple[Box, ...], reached: bool) -> None:
    assert compute_reach(room(*boxes)).reaches("exit") == reached


@pytest.mark.parametrize(("width", "reached"), [(3.0, True), (5.0, False)])
def test_a_leap_crosses_3_m_and_not_5_m(width: float, reached: bool) -> None:
    level = room(*pit(width), end=(10.5, 2.5, 2.0))
    on_top = replace(level, start=Start((1.5, 2.5, 2.0)))
    assert compute_reach(on_top).reaches("exit") == reached
    # The platforms cannot be climbed from the floor.
    assert not compute_reach(level).reaches("exit")


def test_a_lift_carries_the_player() -> None:
    ledge = Box((7.0, 0.2, 0.0), (11.8, 4.8, 3.0))
    lift = Mover("lift", (1.0, 1.0, 0.2), ((6.3, 2.5, 0.1), (6.3, 2.5, 2.4)), 1.0)
    top = (10.5, 2.5, 3.0)
    assert not compute_reach(room(ledge, end=top)).reaches("exit")
    assert compute_reach(room(ledge, end=top, movers=(lift,))).reaches("exit")


def with_barriers(
    level: StealthLevel, place: Point, opened_by: tuple[str, ...], unlocks: tuple[Unlock, ...] = ()
) -> StealthLevel:
    door = Barrier("door", "solid", wall(0.0, 4.0), opened_by)
    return replace(level, switches=(Switch("lever", place, 1.0),), barriers=(door,), unlocks=unlocks)


def test_a_barrier_opens_if_its_switch_can_be_reached() -> None:
    assert compute_reach(with_barriers(room(), (3.0, 1.0, 0.0), ("lever",))).reaches("exit")
    behind = compute_reach(with_barriers(room(), (8.0, 1.0, 0.0), ("lever",)))
    assert (behind.switches, behind.barriers, behind.reaches("exit")) == ((), (), False)
    unlocked_at_random = with_barriers(room(), (3.0, 1.0, 0.0), (), (Unlock("lever", ("door", "other")),))
    assert compute_reach(unlocked_at_random).reaches("exit")


@pytest.mark.parametrize(("name", "variant"), SHIPPED)
def test_everything_in_the_shipped_levels_can_be_reached_except_in_navigation_v2(name: str, variant: str) -> None:
    level = load_level(name, variant)
    reach = compute_reach(level)
    if (name, variant) == BLOCKED:
        assert reach.switches == ("s1",) and reach.barriers == ("gap",)
        assert not reach.reaches("s2") and not reach.reaches("exit")
        # Nothing behind the block is reached. The block begins at x = 11.6 m.
        columns = np.flatnonzero(reach.ground.any(axis=0))
        assert reach.origin[0] + reach.cell * (columns.max() + 1) < 11.6
    else:
        assert all(reach.reaches(entity) for entity in reach.distances)
        assert len(reach.switches) == len(level.switches) and len(reach.barriers) == len(level.barriers)


def test_jumps_in_the_physics_stay_below_the_highest_lift() -> None:
    lift = highest_lift(PlayerKind())
    rng = np.random.default_rng(1)
    for top, possible in ((1.1, True), (lift + 0.02, False)):
        level = room(Box((6.0, 0.2, 0.0), (11.8, 4.8, top)))
        reach = compute_reach(level)
        assert reach.ground[:, int(8.0 / reach.cell)].any() == possible
        with closing(World(level)) as world:
            landed = 0
            for attempt in range(40):
                world.reset(None)
                for step in range(24):
                    side, crouch = int(rng.integers(3)), int(rng.random() < 0.2)
                    jumping = step >= attempt % 5
                    action = (1, side, 1, crouch, attempt % 2) if jumping else (1, 0, 0, 0, 0)
                    world.step(action)
                feet, grounded = world.player.position[2], world.player.grounded
                landed += grounded and feet > top - 0.2
                assert world.player.position[2] <= lift + (top if possible else 0.0)
            assert bool(landed) == possible


def has_ground(reach: Reach, x: float, y: float) -> bool:
    """Whether the cell of a place has ground that can be reached."""
    return bool(reach.ground[int((y - reach.origin[1]) / reach.cell), int((x - reach.origin[0]) / reach.cell)])


@pytest.mark.parametrize(("name", "variant"), SHIPPED)
def test_the_player_stands_only_on_reachable_ground(name: str, variant: str) -> None:
    reach = compute_reach(load_level(name, variant))
    rng = np.random.default_rng(7)
    with closing(World(load_level(name, variant))) as world:
        world.reset(rng)
        for index in range(len(world.level.barriers)):
            world.set_open(index, world.level.barriers[index].name in reach.barriers)
        action = [0, 0, 0, 0, 0]
        for step in range(300):
            if step % 6 == 0:
                action = [int(rng.integers(size)) for size in (3, 3, 2, 2, 2)]
            world.step(action)
            x, y, _ = world.player.position
            if world.player.grounded:
                assert has_ground(reach, x, y)


def test_a_flood_visits_the_cells_of_a_plain_search() -> None:
    rng = np.random.default_rng(0)
    free = rng.random((4, 9, 11)) < 0.6
    seeds = np.zeros_like(free)
    seeds[2, 4, 5] = free[2, 4, 5] = True
    visited = {(2, 4, 5)}
    stack = [(2, 4, 5)]
    while stack:
        z, y, x = stack.pop()
        for a, b, c in ((z + 1, y, x), (z - 1, y, x), (z, y + 1, x), (z, y - 1, x), (z, y, x + 1), (z, y, x - 1)):
            inside = 0 <= a < 4 and 0 <= b < 9 and 0 <= c < 11
            if inside and free[a, b, c] and (a, b, c) not in visited:
                visited.add((a, b, c))
                stack.append((a, b, c))
    assert set(zip(*(axis.tolist() for axis in np.nonzero(flood(free, seeds, Budget(10**6)))), strict=True)) == visited


def test_distances_are_measured_between_the_nearest_points_of_cells() -> None:
    field = np.zeros((6, 7), dtype=np.bool_)
    field[1, 2] = field[5, 6] = True
    computed = distances(field, 5)
    for row in range(6):
        for column in range(7):
            offsets = [(max(abs(row - y) - 1, 0), max(abs(column - x) - 1, 0)) for y, x in ((1, 2), (5, 6))]
            nearest = min(np.hypot(*offset) for offset in offsets)
            assert computed[row, column] == (pytest.approx(nearest) if nearest < 5 else np.inf)


@pytest.mark.parametrize("seed", range(5))
def test_distance_is_measured_to_the_nearest_cell(seed: int) -> None:
    random = np.random.default_rng(seed)
    grid = SpaceGrid(BOUNDS, [], [0.0, 1.0, 2.5], PlayerKind(), Budget(10**9))
    space = random.random(grid.shape) < 0.003
    lows = np.array([axis.ravel() for axis in np.meshgrid(grid.lows, grid.south, grid.west, indexing="ij")])
    widths = np.array([0.0, grid.cell, grid.cell])[:, None]
    highs = lows + widths
    highs[0] = np.repeat(grid.highs, grid.shape[1] * grid.shape[2])
    for point in random.uniform(-2.0, 14.0, (20, 3)):
        offsets = np.maximum(np.maximum(lows - point[::-1, None], point[::-1, None] - highs), 0.0)
        nearest = float(np.sqrt((offsets**2).sum(axis=0)[space.ravel()].min()))
        x, y, z = point.tolist()
        assert grid.distance(space, (x, y, z)) == pytest.approx(nearest)
        assert grid.distance(space, (x, y, z), 1.5) == pytest.approx(nearest if nearest <= 1.5 else np.inf)
    assert grid.distance(np.zeros(grid.shape, dtype=np.bool_), (1.0, 1.0, 1.0)) == np.inf


def test_a_near_switch_is_found_with_little_work() -> None:
    grid = SpaceGrid(Box((0.0, 0.0, 0.0), (100.0, 100.0, 2.0)), [], [1.0], PlayerKind(), budget := Budget(10**9))
    before = budget._remaining
    assert grid.distance(np.ones(grid.shape, dtype=np.bool_), (50.0, 50.0, 0.5), 1.0) == 0.0
    assert before - budget._remaining < 100


def test_a_level_that_takes_too_long_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    level = room(wall(0.0, 4.0))
    fspa = load_task("import spatial\nentity exit\nspec out { limit 9 steps  reach near(exit) }").fspa
    (warning,) = reach_warnings(level, fspa)
    assert warning.code == "TLT0814"
    assert "the way ends at `box_0`" in (warning.help or "")
    limited = SimpleNamespace(limits=SimpleNamespace(WORK={"cells of reachable space": 1000}))
    monkeypatch.setattr("tltl_runtime.stealth.capabilities.feasible.fileio", limited)
    (warning,) = reach_warnings(level, fspa)
    # Only the search for the obstacle exceeds its limit.
    assert (warning.code, warning.help) == ("TLT0814", "the player gets no nearer to it than 4.5 m")
    monkeypatch.setattr("tltl_runtime.stealth.capabilities.reach.fileio", limited)
    with pytest.raises(TltlError, match="TLT0006: it takes too long to find out what can be reached in `room:v0`"):
        compute_reach(level)
    # A player gets a warning, and can play.
    assert [(diagnostic.code, diagnostic.severity) for diagnostic in reach_warnings(level, fspa)] == [
        ("TLT0006", "warning")
    ]
    assert not is_infeasible(level, fspa)


def test_shipped_levels_need_a_small_part_of_the_work_limit() -> None:
    for name, variant in SHIPPED:
        budget = Budget(WORK["cells of reachable space"] // 20)
        assert compute_reach(load_level(name, variant), budget=budget).highest >= 0.0


def test_what_is_remembered_of_a_place_out_of_reach_is_no_error_by_itself() -> None:
    level = room(wall(0.0, 4.0))
    text = "import spatial\nentity exit\nspec out { limit 9 steps  reach once near(exit) or times(near(exit)) < 1 }"
    (warning,) = reach_warnings(level, load_task(text).fspa)
    assert (warning.code, warning.severity) == ("TLT0814", "warning")
    assert not is_infeasible(level, load_task(text).fspa)
