"""The signals of the game: values in SI units that specs can read, computed when they are read."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import atan2, dist, pi
from typing import TYPE_CHECKING, Final

from tltl_runtime.stealth.level import Point, StealthLevel, fixed_places
from tltlc.api import record, specs

if TYPE_CHECKING:
    from tltl_runtime.stealth.simulation import Simulation

_EYES: Final = 0.15
"""Metres from the top of the body down to the eyes."""

Reader = Callable[["Simulation"], float]
_PositionReader = Callable[["Simulation"], Point]

AXES: Final = {"position.x": 0, "position.y": 1, "position.z": 2}
"""The axis of each coordinate of the player, by the name of its signal."""


@record
class LevelSignal:
    """A signal of a level.

    ``base`` is its name without its ``arguments``: ``open(door)`` has the base ``open`` and the
    arguments ``("door",)``. ``read`` returns the value of the signal in a simulation.
    """

    base: str
    arguments: tuple[str, ...]
    read: Reader


class Signals(Mapping[str, float]):
    """The current signals of a simulation, by name.

    - Of the player and the game: ``health stamina time position.x position.y position.z visible
      seen crouching grounded``. ``visible`` says that an enemy sees the player, ``seen`` that an
      enemy has noticed the player and still knows the player's position.
    - Of each entity: ``distance(ENTITY) bearing(ENTITY) line_of_sight(ENTITY)``.
    - Of each switch ``active(SWITCH)``, and of each barrier ``open(BARRIER)``.
    - The aliases that the level declares.
    """

    __slots__ = ("_game", "_readers")

    def __init__(self, game: Simulation) -> None:
        self._game = game
        self._readers = game.readers

    def __getitem__(self, name: str) -> float:
        return float(self._readers[name](self._game))

    def __contains__(self, name: object) -> bool:
        return name in self._readers

    def __iter__(self) -> Iterator[str]:
        return iter(self._readers)

    def __len__(self) -> int:
        return len(self._readers)


def readers(level: StealthLevel) -> dict[str, Reader]:
    """Return the functions that read the signals of a level from a simulation, by signal name."""
    return {name: signal.read for name, signal in level_signals(level).items()}


def level_signals(level: StealthLevel) -> dict[str, LevelSignal]:
    """Return the signals of a level, by name; an alias maps to the signal that it stands for."""
    plain: dict[str, Reader] = {
        "health": lambda game: game.health,
        "stamina": lambda game: game.world.player.stamina,
        "time": lambda game: game.time,
        "position.x": lambda game: game.world.player.position[0],
        "position.y": lambda game: game.world.player.position[1],
        "position.z": lambda game: game.world.player.position[2],
        "visible": lambda game: any(game.enemies.sees),
        "seen": lambda game: any(game.enemies.knows),
        "crouching": lambda game: game.world.player.crouching,
        "grounded": lambda game: game.world.player.grounded,
    }
    signals = [LevelSignal(name, (), read) for name, read in plain.items()]
    for entity, place in position_readers(level).items():
        signals += _entity_signals(entity, place)
    signals += [LevelSignal("active", (switch.name,), _active_reader(row)) for row, switch in enumerate(level.switches)]
    signals += [LevelSignal("open", (barrier.name,), _open_reader(row)) for row, barrier in enumerate(level.barriers)]
    by_name = {specs.full_name(signal.base, signal.arguments): signal for signal in signals}
    for alias, name in level.signals:
        by_name[alias] = by_name[name]
    return by_name


def signal_list(level: StealthLevel) -> str:
    """Return a text that lists the names of a level's signals, for messages.

    An example is "`health`, `time`; `active(…)` of s1, s2".
    """
    aliases = dict(level.signals)
    plain = [name for name, signal in level_signals(level).items() if name in aliases or not signal.arguments]
    plain_names = ", ".join(f"`{name}`" for name in plain)
    entities_of = {
        "`distance(…)`, `bearing(…)`, `line_of_sight(…)`": list(position_readers(level)),
        "`active(…)`": [switch.name for switch in level.switches],
        "`open(…)`": [barrier.name for barrier in level.barriers],
    }
    return "; ".join(
        [plain_names, *(f"{calls} of {', '.join(names)}" for calls, names in entities_of.items() if names)]
    )


def position_readers(level: StealthLevel) -> dict[str, _PositionReader]:
    """Return the functions that read the positions of the entities, by the names of the entities.

    The position of an enemy is at its feet, that of a barrier in the middle of its base, and that
    of a mover at its centre.
    """
    places: dict[str, _PositionReader] = {name: _fixed_position(place) for name, place in fixed_places(level).items()}
    places |= {enemy.name: _enemy_position(index) for index, enemy in enumerate(level.enemies)}
    places |= {mover.name: _mover_position(index) for index, mover in enumerate(level.movers)}
    return places


# --- readers of single signals and positions --------------------------------------------------------


def _entity_signals(name: str, place: _PositionReader) -> list[LevelSignal]:
    return [
        LevelSignal("distance", (name,), lambda game: dist(game.world.player.position, place(game))),
        LevelSignal("bearing", (name,), lambda game: _bearing(game, place(game))),
        LevelSignal("line_of_sight", (name,), lambda game: _has_line_of_sight(game, place(game))),
    ]


def _active_reader(switch: int) -> Reader:
    return lambda game: game.active[switch]


def _open_reader(barrier: int) -> Reader:
    return lambda game: game.open[barrier]


def _fixed_position(place: Point) -> _PositionReader:
    return lambda game: place


def _enemy_position(index: int) -> _PositionReader:
    return lambda game: game.enemies.guards[index].position


def _mover_position(index: int) -> _PositionReader:
    return lambda game: game.world.movers[index].place


def _bearing(game: Simulation, place: Point) -> float:
    """Return the angle from the direction in which the player looks to a place, in [-pi, pi).

    The angle is positive to the left. It is 0 if the player stands at the place.
    """
    player = game.world.player
    x, y = place[0] - player.position[0], place[1] - player.position[1]
    if x == y == 0.0:
        return 0.0
    return (atan2(y, x) - player.yaw + pi) % (2 * pi) - pi


def _has_line_of_sight(game: Simulation, place: Point) -> bool:
    """Whether the line from the player's eyes to the point 0.5 m above ``place`` is free."""
    player, kind = game.world.player, game.world.kind
    x, y, z = player.position
    eyes = (x, y, z + (kind.crouched_height if player.crouching else kind.height) - _EYES)
    return not game.world.ray_blocked(eyes, (place[0], place[1], place[2] + 0.5))
