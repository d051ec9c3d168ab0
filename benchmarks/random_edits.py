"""Edits of the assets that the shipped levels share, made at random: what designers do to them, harmless or not.

Each is an overlay; equal seeds give equal edits.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Any, Final

Asset = Mapping[str, Any]
"""What stands in the file of an asset."""

Values = dict[str, Any]
"""Keys of an asset, or of a thing in it, and their new values."""

Changes = dict[str, Values]
"""New values by the name of the thing; those of the asset itself are under ""."""

HARMLESS: Final = frozenset({"words", "hair", "top", "behind"})
"""Kinds of edits that are meant to change nothing."""

_TALL: Final = 2.0
"""Metres of height from which on nobody gets over a wall, or sees over it."""

_TRIES: Final = 200


@dataclass(frozen=True, slots=True)
class Edit:
    """An edit of ``asset`` for ``level``, as an overlay in TOML; ``number`` is from 1 on, ``kind`` how it was made."""

    number: int
    level: str
    asset: str
    kind: str
    doc: str
    overlay: str


@dataclass(frozen=True, slots=True)
class Wanted:
    """What kind of edit is wanted of which asset, for which level."""

    level: str
    asset: str
    kind: str


WANTED: Final = tuple(
    Wanted(level, asset, kind)
    for level, asset, kinds in (
        ("navigation", "corridor", "words hair hair top behind slight slight strong shut shut"),
        ("cover_and_hide", "guard", "words hair slight slight strong strong"),
        ("cover_and_hide", "crates", "hair top slight strong"),
        ("branching", "moving_obstacles", "hair top slight strong shut"),
        ("branching", "guard", "hair slight strong"),
        ("branching", "crates", "words slight"),
    )
    for kind in kinds.split()
)


def random_edits(
    seed: int, assets: Mapping[str, Asset], loads: Callable[[str, str], bool], wanted: Sequence[Wanted] = WANTED
) -> tuple[Edit, ...]:
    """An edit of each wanted kind; ``loads`` says of a level and an overlay whether the level loads with it.

    Raises ValueError where no edit of a kind loads.
    """
    return tuple(_edit(number, each, seed, assets[each.asset], loads) for number, each in enumerate(wanted, 1))


def _edit(number: int, wanted: Wanted, seed: int, asset: Asset, loads: Callable[[str, str], bool]) -> Edit:
    random = Random(f"{seed} {number}")
    for _ in range(_TRIES):
        made = _MAKERS[wanted.kind](random, asset)
        doc, added, changes = made
        overlay = _overlay(wanted.asset, doc, added, changes)
        if loads(wanted.level, overlay):
            return Edit(number, wanted.level, wanted.asset, wanted.kind, doc, overlay)
    raise ValueError(f"no edit of the kind {wanted.kind} of {wanted.asset} loads in {wanted.level}")


def _overlay(asset: str, doc: str, added: Sequence[Values], changes: Changes) -> str:
    lines = [f"doc = {json.dumps(doc)}"]
    for thing, values in changes.items():
        lines += ["", f"[change.{asset}.{thing}]" if thing else f"[change.{asset}]", *_lines(values)]
    for values in added:
        lines += ["", f"[[add.{asset}.wall]]", *_lines(values)]
    return "\n".join(lines) + "\n"


def _lines(values: Values) -> list[str]:
    return [f"{key} = {json.dumps(value)}" for key, value in values.items()]


Made = tuple[str, list[Values], Changes]
"""What an edit says of itself, the walls that it adds, and what it changes."""


def _words(random: Random, asset: Asset) -> Made:
    return "Other words about it, and nothing else.", [], {"": {"doc": f"{asset['doc']} ({random.randrange(1000)})"}}


def _hair(random: Random, asset: Asset) -> Made:
    """Less than a millimetre, or a hundred-thousandth."""
    if asset["type"] == "enemy":
        key, factor = random.choice(_NUMBERS), 1.0 + random.choice((-1, 1)) * random.uniform(2e-6, 1e-5)
        return f"Its {key} times {factor:.6f}.", [], {"": {key: round(asset[key] * factor, 7)}}
    thing = random.choice(_solids(asset))
    by = [random.uniform(-0.0009, 0.0009) for _ in range(2)]
    doc = f"{thing['name']} moves by {by[0] * 1000:+.2f} and {by[1] * 1000:+.2f} mm."
    return doc, [], {thing["name"]: {"at": _moved(thing["at"], by)}}


def _top(random: Random, asset: Asset) -> Made:
    """Higher still, where nobody gets over it or sees over it."""
    tall = [thing for thing in _solids(asset) if thing["at"][2] + thing["size"][2] >= _TALL]
    thing, by = random.choice(tall), random.uniform(0.05, 0.3)
    x, y, z = thing["size"]
    return f"{thing['name']} gets {by:.2f} m higher.", [], {thing["name"]: {"size": [x, y, round(z + by, 3)]}}


def _behind(random: Random, asset: Asset) -> Made:
    """A block between a wall of the corridor and the end of the level, where nobody ever is."""
    wall = next(thing for thing in _solids(asset) if thing["name"] == "south_wall")
    at = [round(random.uniform(1.0, 7.0), 2), round(wall["at"][1] - wall["size"][1] / 2 - 0.1, 3), 0.0]
    size = [round(random.uniform(0.3, 1.5), 2), 0.1, round(random.uniform(0.5, 2.5), 2)]
    return "A block stands behind the south wall.", [{"name": "behind", "at": at, "size": size}], {}


def _slight(random: Random, asset: Asset) -> Made:
    return _tuned(random, asset, 0.03, 0.1)


def _strong(random: Random, asset: Asset) -> Made:
    return _tuned(random, asset, 0.25, 0.6)


def _tuned(random: Random, asset: Asset, least: float, most: float) -> Made:
    """A number that is greater or smaller by such a share, or a thing that is moved by so many metres, and resized."""
    share = random.choice((-1, 1)) * random.uniform(least, most)
    if asset["type"] == "enemy":
        key = random.choice(_NUMBERS)
        value = round(asset[key] * (1.0 + share), 3)
        return f"Its {key} is {value:g}, not {asset[key]:g}.", [], {"": {key: value}}
    movers = asset.get("mover", [])
    thing = random.choice([*_blocks(asset), *movers, *movers])
    name = thing["name"]
    if thing in movers:
        value = round(thing["speed"] * (1.0 + share), 3)
        return f"The speed of {name} is {value:g}, not {thing['speed']:g}.", [], {name: {"speed": value}}
    by = [random.uniform(-most, most) for _ in range(2)]
    size = [round(length + random.uniform(-1, 1) * most / 2, 3) for length in thing["size"][:2]]
    doc = f"{name} moves by {by[0]:+.2f} and {by[1]:+.2f} m, and is {size[0]:.2f} by {size[1]:.2f} m."
    return doc, [], {name: {"at": _moved(thing["at"], by), "size": [*size, thing["size"][2]]}}


def _shut(random: Random, asset: Asset) -> Made:
    """From wall to wall, but for a gap that is too narrow, and too high to jump over."""
    thing = random.choice([each for each in _solids(asset) if each["name"] in _ACROSS])
    gap, height = random.uniform(0.0, 0.3), max(thing["size"][2], random.uniform(1.8, 2.4))
    at, size = [thing["at"][0], round(gap / 2, 3), 0.0], [thing["size"][0], round(4.0 - gap, 3), round(height, 2)]
    doc = f"{thing['name']} reaches across, {size[1]:.2f} m wide and {size[2]:.2f} m high."
    return doc, [], {thing["name"]: {"at": at, "size": size}}


def _solids(asset: Asset) -> list[Any]:
    return [*asset.get("wall", []), *asset.get("low", [])]


def _blocks(asset: Asset) -> list[Any]:
    """The solids that are not the walls along a corridor."""
    return [thing for thing in _solids(asset) if not thing["name"].endswith("_wall")]


def _moved(at: Sequence[float], by: Sequence[float]) -> list[float]:
    return [round(at[0] + by[0], 6), round(at[1] + by[1], 6), at[2]]


_NUMBERS: Final = (
    "sight_range",
    "sight_angle",
    "walk_speed",
    "chase_speed",
    "turn_speed",
    "reaction_time",
    "memory_time",
    "search_time",
    "search_radius",
)
"""Of a guard."""

_ACROSS: Final = ("block_1", "block_2", "block_3", "hurdle", "door_frame_south")
"""What can be stretched across its way, 4 m wide, and meets nothing else then."""

_MAKERS: Final[Mapping[str, Callable[[Random, Asset], Made]]] = {
    "words": _words,
    "hair": _hair,
    "top": _top,
    "behind": _behind,
    "slight": _slight,
    "strong": _strong,
    "shut": _shut,
}
