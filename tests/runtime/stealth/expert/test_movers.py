"""The positions of movers are predicted from where they were seen."""

from __future__ import annotations

import pytest

from tltl_runtime.stealth.expert.movers import Clocks, swept_bounds
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.simulation import Simulation
from tltlc.core.record import replace


@pytest.mark.parametrize("unseen", [1, 7])
def test_the_positions_of_movers_are_predicted_ten_decisions_ahead(unseen: int) -> None:
    """Predict ten decisions ahead, also if the player looks at the movers only now and then."""
    game = Simulation(load_level("branching", "v1"))
    clocks = Clocks(game.level)
    for _ in range(12):
        for _ in range(unseen):
            game.step((0, 0, 0, 0, 0))
        clocks.see(game.snapshot())
    predicted = clocks.swept_boxes(9)
    for _ in range(10):
        game.step((0, 0, 0, 0, 0))
    for box, place, mover in zip(predicted, game.snapshot().movers, game.level.movers, strict=True):
        reach = swept_bounds(mover)
        for axis in range(3):
            half = mover.size[axis] / 2
            assert reach.low[axis] - 1e-9 <= box.low[axis] <= place[axis] - half + 1e-9
            assert place[axis] + half - 1e-9 <= box.high[axis] <= reach.high[axis] + 1e-9
    game.close()


def test_a_mover_that_waits_for_the_player_is_noticed() -> None:
    """The clock of a mover stops while a player who has no room to move is in its way."""
    game = Simulation(load_level("branching"))
    clocks = Clocks(game.level)
    clocks.see(game.snapshot())
    for _ in range(20):
        game.step((0, 0, 0, 0, 0))
    before = game.snapshot()
    game.step((0, 0, 0, 0, 0))
    after = game.snapshot()
    # As if the movers had stood still in the last decision.
    clocks.see(replace(after, movers=before.movers))
    for box, place, mover in zip(clocks.swept_boxes(0), before.movers, game.level.movers, strict=True):
        for axis in range(3):
            half = mover.size[axis] / 2
            assert box.low[axis] - 1e-9 <= place[axis] - half and place[axis] + half <= box.high[axis] + 1e-9
    game.close()
