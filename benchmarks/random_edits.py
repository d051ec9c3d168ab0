"""Make random edits of the assets that the shipped levels share, some of them harmless, as designers make them.

Each edit is an overlay; equal seeds give equal edits.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Any, Final

Asset = Mapping[str, Any]
"""The content of the file of an asset."""

Values = dict[str, Any]
"""New values by key, for an asset or for a thing in it."""

Changes = dict[str, Values]
"""New values by the name of the thing; the asset itself has the name ""."""

HARMLESS: Final = frozenset({"words", "hair", "top", "behind"})
"""Kinds of edits that are meant to change nothing."""

_TALL: Final = 2.0
"""Nobody gets over a wall that is at least this high, in metres, or sees over it."""

_TRIES: Final = 200


@dataclass(frozen=True, slots=True)
class Edit:
    """An edit of ``asset`` for ``level``, as an overlay in TOML; ``number`` counts from 1."""

    number: int
    level: str
    asset: str
    kind: str
    doc: str
    overlay: str


@dataclass(frozen=True, slots=True)
class EditRequest:
    """A kind of edit to make, with its asset and its level."""

    level: str
    asset: str
    kind: str


EDIT_REQUESTS: Final = tuple(
    EditRequest(level, asset, kind)
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
    seed: int,
    assets: Mapping[str, Asset],
    loads: Callable[[str, str], bool],
    requests: Sequence[EditRequest] = EDIT_REQUESTS,
) -> tuple[Edit, ...]:
    """Return an edit for each request; ``loads`` returns whether a level loads with an overlay.

    Raises ValueError if no edit of a kind loads.
    """
    return tuple(
        _edit(number, request, seed, assets[request.asset], loads) for number, request in enumerate(requests, 1)
    )


def _edit(number: int, request: EditRequest, seed: int, asset: Asset, loads: Callable[[str, str], bool]) -> Edit:
    random = Random(f"{seed} {number}")
    for _ in range(_TRIES):
        content = _MAKERS[request.kind](random, asset)
        doc, added, changes = content
        overlay = _overlay(request.asset, doc, added, changes)
        if loads(request.level, overlay):
            return Edit(number, request.level, request.asset, request.kind, doc, overlay)
    raise ValueError(f"no edit of the kind {request.kind} of {request.asset} loads in {request.level}")


def _overlay(asset: str, doc: str, added: Sequence[Values], changes: Changes) -> str:
    lines = [f"doc = {json.dumps(doc)}"]
    for thing, values in changes.items():
        lines += ["", f"[change.{asset}.{thing}]" if thing else f"[change.{asset}]", *_lines(values)]
    for values in added:
        lines += ["", f"[[add.{asset}.wall]]", *_lines(values)]
    return "\n".join(lines) + "\n"


def _lines(values: Values) -> list[str]:
    return [f"{key} = {json.dumps(value)}" for key, value in values.items()]


EditContent = tuple[str, list[Values], Changes]
"""The description of an edit, the walls that it adds, and its changes."""


def _make_words(random: Random, asset: Asset) -> EditContent:
    return "Other words about it, and nothing else.", [], {"": {"doc": f"{asset['doc']} ({random.randrange(1000)})"}}


def _make_hair(random: Random, asset: Asset) -> EditContent:
    """Change a place by less than a millimetre, or a number by less than a hundred-thousandth of it."""
    if asset["type"] == "enemy":
        key, factor = random.choice(_GUARD_NUMBERS), 1.0 + random.choice((-1, 1)) * random.uniform(2e-6, 1e-5)
        return f"Its {key} times {factor:.6f}.", [], {"": {key: round(asset[key] * factor, 7)}}
    thing = random.choice(_solids(asset))
    by = [random.uniform(-0.0009, 0.0009) for _ in range(2)]
    doc = f"{thing['name']} moves by {by[0] * 1000:+.2f} and {by[1] * 1000:+.2f} mm."
    return doc, [], {thing["name"]: {"at": _shifted(thing["at"], by)}}


def _make_top(random: Random, asset: Asset) -> EditContent:
    """Raise a wall that is already too high to get over or to see over."""
    tall = [thing for thing in _solids(asset) if thing["at"][2] + thing["size"][2] >= _TALL]
    thing, by = random.choice(tall), random.uniform(0.05, 0.3)
    x, y, z = thing["size"]
    return f"{thing['name']} gets {by:.2f} m higher.", [], {thing["name"]: {"size": [x, y, round(z + by, 3)]}}


def _make_behind(random: Random, asset: Asset) -> EditContent:
    """Add a block between a wall of the corridor and the end of the level, where nobody ever is."""
    wall = next(thing for thing in _solids(asset) if thing["name"] == "south_wall")
    at = [round(random.uniform(1.0, 7.0), 2), round(wall["at"][1] - wall["size"][1] / 2 - 0.1, 3), 0.0]
    size = [round(random.uniform(0.3, 1.5), 2), 0.1, round(random.uniform(0.5, 2.5), 2)]
    return "A block stands behind the south wall.", [{"name": "behind", "at": at, "size": size}], {}


def _make_slight(random: Random, asset: Asset) -> EditContent:
    return _changed_number(random, asset, 0.03, 0.1)


def _make_strong(random: Random, asset: Asset) -> EditContent:
    return _changed_number(random, asset, 0.25, 0.6)


def _changed_number(random: Random, asset: Asset, least: float, most: float) -> EditContent:
    """Change a number by a share of ``least`` to ``most``, or move and resize a thing by up to ``most`` metres."""
    share = random.choice((-1, 1)) * random.uniform(least, most)
    if asset["type"] == "enemy":
        key = random.choice(_GUARD_NUMBERS)
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
    return doc, [], {name: {"at": _shifted(thing["at"], by), "size": [*size, thing["size"][2]]}}


def _make_shut(random: Random, asset: Asset) -> EditContent:
    """Stretch a block across the corridor, too high to jump over, with a gap that is too narrow."""
    thing = random.choice([solid for solid in _solids(asset) if solid["name"] in _STRETCHABLE])
    gap, height = random.uniform(0.0, 0.3), max(thing["size"][2], random.uniform(1.8, 2.4))
    at, size = [thing["at"][0], round(gap / 2, 3), 0.0], [thing["size"][0], round(4.0 - gap, 3), round(height, 2)]
    doc = f"{thing['name']} reaches across, {size[1]:.2f} m wide and {size[2]:.2f} m high."
    return doc, [], {thing["name"]: {"at": at, "size": size}}


def _solids(asset: Asset) -> list[Any]:
    return [*asset.get("wall", []), *asset.get("low", [])]


def _blocks(asset: Asset) -> list[Any]:
    """Return the solids other than the walls along a corridor."""
    return [thing for thing in _solids(asset) if not thing["name"].endswith("_wall")]


def _shifted(at: Sequence[float], by: Sequence[float]) -> list[float]:
    return [round(at[0] + by[0], 6), round(at[1] + by[1], 6), at[2]]


_GUARD_NUMBERS: Final = (
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
"""The numbers of a guard that an edit may change."""

_STRETCHABLE: Final = ("block_1", "block_2", "block_3", "hurdle", "door_frame_south")
"""Blocks that can be stretched across the corridor, 4 m wide, without meeting anything else."""

_MAKERS: Final[Mapping[str, Callable[[Random, Asset], EditContent]]] = {
    "words": _make_words,
    "hair": _make_hair,
    "top": _make_top,
    "behind": _make_behind,
    "slight": _make_slight,
    "strong": _make_strong,
    "shut": _make_shut,
}
