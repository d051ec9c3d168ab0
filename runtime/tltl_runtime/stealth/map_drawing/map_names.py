"""Place the names of regions and things on the map of a level."""

from __future__ import annotations

from collections.abc import Iterator

from tltl_runtime.game.map_labels import LABEL_OFFSET, MapLabel, placed_labels, thing_label
from tltl_runtime.game.map_scale import MapScale
from tltl_runtime.game.mentions import Mentions
from tltl_runtime.stealth.level import StealthLevel


def map_labels(level: StealthLevel, scale: MapScale, mentions: Mentions) -> Iterator[MapLabel]:
    """Place the names of the things and regions of a level on its map.

    Switches, exits, barriers, enemies and regions are always named. Solids and movers (moving
    boxes) are named only if they are in ``mentions``.
    """
    obstacles = [scale.rect(solid.box) for solid in level.solids if solid.kind in ("wall", "low")]
    obstacles += [scale.rect(barrier.box) for barrier in level.barriers]
    return placed_labels(_thing_labels(level, scale, mentions), obstacles, level.regions, scale, mentions)


def _thing_labels(level: StealthLevel, scale: MapScale, mentions: Mentions) -> Iterator[MapLabel]:
    """Yield the names of things at their default positions on the map."""
    small = [(switch.name, scale.at(switch.position)) for switch in level.switches]
    small += [(exit_.name, scale.at(exit_.position)) for exit_ in level.exits]
    wide = [(barrier.name, scale.middle(barrier.box)) for barrier in level.barriers]
    wide += [(solid.name, scale.middle(solid.box)) for solid in level.solids if solid.name in mentions.things]
    wide += [(mover.name, scale.at(mover.path[0])) for mover in level.movers if mover.name in mentions.things]
    enemies = [(enemy.name, scale.at(enemy.route[0])) for enemy in level.enemies]
    for things, kind, above in (
        (small, "thing-name", LABEL_OFFSET),
        (wide, "thing-name", 0),
        (enemies, "enemy-name", LABEL_OFFSET),
    ):
        for name, place in things:
            yield thing_label(name, kind, place, above, scale, mentions)
