"""Lines of sight to a lattice's places are those by which enemies see."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.runtime.stealth.enemy_levels import level, low, places, solids
from tltl_runtime.stealth.enemies.enemy import CHEST, CROUCHED_HEAD, EYES, STANDING_HEAD
from tltl_runtime.stealth.enemies.segments import blocked, corners
from tltl_runtime.stealth.expert.lattice import lattice_of
from tltl_runtime.stealth.expert.lines import ROUNDED, Lines
from tltl_runtime.stealth.level import Solid


@settings(max_examples=25, deadline=None)
@given(solids(), places(), st.integers(0, 10**6))
def test_places_that_are_wholly_seen_or_hidden_are_so_for_enemies(
    boxes: tuple[Solid, ...], eyes: tuple[float, float], seed: int
) -> None:
    made = level(*boxes)
    lattice = lattice_of(made, frozenset())
    seen = Lines(made, frozenset()).seen_from(*eyes)
    x, y = (round(each / ROUNDED) * ROUNDED for each in eyes)
    found = [corners(each.box) for each in made.solids if each.box.high[2] > 0.0]
    count = len(lattice.places)
    for place in np.random.default_rng(seed).integers(count, size=40 if count else 0):
        px, py = lattice.places[place]
        for stance, head in enumerate((STANDING_HEAD, CROUCHED_HEAD)):
            free = any(not blocked((x, y, EYES), (px, py, part * head), found) for part in (1.0, CHEST))
            if seen[stance, place] in (0.0, 1.0):
                assert free == bool(seen[stance, place])


def test_who_crouches_behind_something_low_is_hidden() -> None:
    made = level(low(4.9, 1.0, 5.1, 7.0, height=1.2))
    behind = int(np.argmin(np.hypot(*(lattice_of(made, frozenset()).places - (5.6, 4.0)).T)))
    assert Lines(made, frozenset()).seen_from(1.0, 4.0)[:, behind].tolist() == [1.0, 0.0]
