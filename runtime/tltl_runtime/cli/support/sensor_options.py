"""The options for the agent's sensors: which entities, signals and map of the level the agent observes."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from shlex import quote
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from tltl_runtime.game.sensors import Sensors

    _Type = click.ParamType[Any]
else:
    # In older versions of click, a ParamType cannot have a type in brackets.
    _Type = click.ParamType

Function = TypeVar("Function", bound=Callable[..., Any])


def sensor_options(command: Function) -> Function:
    """Add the options ``--entities``, ``--variables``, ``--map`` and their ``--no-`` forms to a command.

    The command gets ``sensors``, a mapping for
    :meth:`tltl_runtime.game.game.Game.choose_sensors`. Without options, it is empty: the level's own
    sensors apply.
    """

    @wraps(command)
    def with_sensors(
        *args: Any,
        entities: list[str] | None,
        no_entities: bool,
        variables: list[str] | None,
        no_variables: bool,
        map_: dict[str, Any] | None,
        no_map: bool,
        **rest: Any,
    ) -> Any:
        sensors: dict[str, Any] = {}
        for key, values, none, empty in (
            ("entities", entities, no_entities, []),
            ("variables", variables, no_variables, []),
            ("map", map_, no_map, None),
        ):
            if none and values is not None:
                raise click.UsageError(f"--{key} and --no-{key} cannot be used together", click.get_current_context())
            if none or values is not None:
                sensors[key] = empty if none else values
        return command(*args, sensors=sensors, **rest)

    for option in reversed(_OPTIONS):
        with_sensors = option(with_sensors)
    return with_sensors  # type: ignore[return-value]


def option_of(key: str, sensors: Sensors) -> str:
    """Return the command-line option that selects one part of ``sensors``, quoted for a shell.

    ``key`` is the part: ``entities``, ``variables`` or ``map``. Examples of the result are
    ``--entities s1,exit`` and ``--no-map``.
    """
    if key == "map" and sensors.map is not None:
        value = f"cell={sensors.map.cell!r},extent={sensors.map.extent},types={','.join(sensors.map.types)}"
    else:
        value = ",".join(getattr(sensors, key) or ())
    return f"--{key} {quote(value)}" if value else f"--no-{key}"


class _Names(_Type):
    """The click type of an option value ``a,b``: a list of one or more names."""

    name = "names"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if isinstance(value, list):
            return value
        names = [name.strip() for name in value.split(",")]
        if not all(names):
            self.fail(f"`{value}` is not of the form A,B", param, ctx)
        return names


class _Map(_Type):
    """The click type of an option value such as ``cell=0.5,extent=15,types=wall,low``.

    The keys may come in any order, and ``types`` may have several values. The result is a dict.
    """

    name = "map"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if isinstance(value, dict):
            return value
        items_by_key: dict[str, list[str]] = {}
        for piece in value.split(","):
            key, equals, item = (part.strip() for part in piece.rpartition("="))
            if equals and key in items_by_key:
                self.fail(f"`{key}` is given twice", param, ctx)
            if not item or not (equals or items_by_key):
                self.fail(f"`{value}` is not of the form cell=0.5,extent=15,types=wall,low", param, ctx)
            items_by_key.setdefault(key if equals else list(items_by_key)[-1], []).append(item)
        return {
            key: items if key == "types" else self._number(key, items, param, ctx)
            for key, items in items_by_key.items()
        }

    def _number(self, key: str, items: list[str], param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Convert the value of ``key``: to a number if it is ``cell`` or ``extent``, else keep the text.

        Unknown keys are reported later, when the sensors are checked against the level.
        """
        kind = {"cell": float, "extent": int}.get(key, str)
        try:
            (item,) = items
            return kind(item)
        except ValueError:
            expected = "a whole number" if kind is int else "a number"
            self.fail(f"`{key}` must be {expected}, not `{','.join(items)}`", param, ctx)


_OPTIONS = (
    click.option(
        "--entities",
        metavar="A,B",
        type=_Names(),
        help="In a level: the agent observes the positions of these entities, e.g. `door,exit`.",
    ),
    click.option("--no-entities", is_flag=True, help="In a level: the agent observes no entity."),
    click.option(
        "--variables",
        metavar="A,B",
        type=_Names(),
        help="In a level: the agent observes these signals, e.g. `health,distance(exit)`.",
    ),
    click.option("--no-variables", is_flag=True, help="In a level: the agent observes no signal."),
    click.option(
        "--map",
        "map_",
        metavar="KEY=VALUE,…",
        type=_Map(),
        help="In a level: the agent observes a map around itself, e.g. `cell=0.5,extent=15,types=wall,low`. Missing "
        "keys keep the values of the level.",
    ),
    click.option("--no-map", is_flag=True, help="In a level: the agent observes no map."),
)
