"""Small levels built in code, and random obstacles."""

from __future__ import annotations

from math import pi

from hypothesis import strategies as st

from tltl_runtime.stealth.level import (
    Barrier,
    Box,
    Enemy,
    EnemyKind,
    Exit,
    MapSensor,
    Mover,
    Point,
    Sensors,
    Solid,
    Start,
    StealthLevel,
    Switch,
)

GUARD = EnemyKind(
    name="guard",
    sight_range=8.0,
    sight_angle=2 * pi / 3,
    walk_speed=1.5,
    chase_speed=5.2,
    turn_speed=4.0,
    reaction_time=0.45,
    memory_time=1.0,
    search_time=3.0,
    search_radius=2.0,
    attack_range=1.2,
    attack_damage=0.5,
)


def box(x0: float, y0: float, x1: float, y1: float, z0: float = 0.0, z1: float = 3.0) -> Box:
    return Box((x0, y0, z0), (x1, y1, z1))


def bounds(x0: float, y0: float, x1: float, y1: float) -> tuple[Point, Point]:
    """Return the corners of a box, as :meth:`Enemies.step` takes those of movers."""
    return (x0, y0, 0.0), (x1, y1, 3.0)


def wall(x0: float, y0: float, x1: float, y1: float) -> Solid:
    return Solid("wall", "wall", box(x0, y0, x1, y1))


def low(x0: float, y0: float, x1: float, y1: float, height: float = 1.0) -> Solid:
    return Solid("low", "low", box(x0, y0, x1, y1, 0.0, height))


def level(
    *solids: Solid,
    routes: tuple[tuple[Point, ...], ...] = (((1.0, 1.0, 0.0), (9.0, 1.0, 0.0)),),
    kind: EnemyKind = GUARD,
    barriers: tuple[Barrier, ...] = (),
    movers: tuple[Mover, ...] = (),
    switches: tuple[Switch, ...] = (),
    size: tuple[float, float] = (10.0, 8.0),
    map_sensor: MapSensor | None = None,
) -> StealthLevel:
    floor = Solid("floor", "floor", box(0.0, 0.0, *size, -0.2, 0.0))
    return StealthLevel(
        name="test",
        variant="v0",
        doc="",
        bounds=box(0.0, 0.0, *size, -1.0, 4.0),
        start=Start((5.0, 4.0, 0.0)),
        solids=(floor, *solids),
        switches=switches,
        barriers=barriers,
        unlocks=(),
        movers=movers,
        enemies=tuple(Enemy(f"guard{i}", kind, route) for i, route in enumerate(routes)),
        exits=(Exit("exit", (9.5, 7.5, 0.0)),),
        sensors=Sensors((), (), map_sensor),
        spec=None,
        files=(),
    )


@st.composite
def solids(draw: st.DrawFn, most: int = 8) -> tuple[Solid, ...]:
    """Draw up to ``most`` boxes anywhere in 10 m by 8 m, on the floor or above it."""
    boxes = []
    for _ in range(draw(st.integers(0, most))):
        x, y = draw(st.floats(0, 9.8)), draw(st.floats(0, 7.8))
        dx, dy = draw(st.floats(0.05, 4)), draw(st.floats(0.05, 4))
        z, dz = draw(st.sampled_from([0.0, 0.0, 1.2, 2.0])), draw(st.sampled_from([0.3, 1.0, 2.0]))
        boxes.append(Solid("solid", "wall", box(x, y, min(x + dx, 10.0), min(y + dy, 8.0), z, z + dz)))
    return tuple(boxes)


def places() -> st.SearchStrategy[tuple[float, float]]:
    return st.tuples(st.floats(0.0, 10.0), st.floats(0.0, 8.0))
