"""Lines of sight to the places of a lattice agree with the sight of enemies."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.runtime.stealth.enemy_levels import level, low, places, solids
from tltl_runtime.stealth.enemies.enemy import CHEST, CROUCHED_HEAD, EYES, STANDING_HEAD
from tltl_runtime.stealth.enemies.segments import corners, is_blocked
from tltl_runtime.stealth.expert.lattice import lattice_of
from tltl_runtime.stealth.expert.lines import ROUNDED, LinesOfSight
from tltl_runtime.stealth.level import Solid


@settings(max_examples=25, deadline=None)
@given(solids(), places(), st.integers(0, 10**6))
def test_enemies_agree_on_places_that_are_fully_seen_or_hidden(
    boxes: tuple[Solid, ...], eyes: tuple[float, float], seed: int
) -> None:
    game_level = level(*boxes)
    lattice = lattice_of(game_level, frozenset())
    seen_shares = LinesOfSight(game_level, frozenset()).visible_shares(*eyes)
    x, y = (round(coordinate / ROUNDED) * ROUNDED for coordinate in eyes)
    obstacles = [corners(solid.box) for solid in game_level.solids if solid.box.high[2] > 0.0]
    count = len(lattice.places)
    for place in np.random.default_rng(seed).integers(count, size=40 if count else 0):
        px, py = lattice.places[place]
        for stance, head in enumerate((STANDING_HEAD, CROUCHED_HEAD)):
            is_visible = any(not is_blocked((x, y, EYES), (px, py, part * head), obstacles) for part in (1.0, CHEST))
            if seen_shares[stance, place] in (0.0, 1.0):
                assert is_visible == bool(seen_shares[stance, place])


def test_a_player_crouching_behind_low_cover_is_hidden() -> None:
    game_level = level(low(4.9, 1.0, 5.1, 7.0, height=1.2))
    behind = int(np.argmin(np.hypot(*(lattice_of(game_level, frozenset()).places - (5.6, 4.0)).T)))
    assert LinesOfSight(game_level, frozenset()).visible_shares(1.0, 4.0)[:, behind].tolist() == [1.0, 0.0]
