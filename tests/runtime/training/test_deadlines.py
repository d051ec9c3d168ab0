"""The time that the workers of a training have, by the deadlines of a game in another process."""

from __future__ import annotations

import json
import sys
from contextlib import closing
from pathlib import Path

import pytest

from tests.runtime.training.test_search_any_game import COUNTER, run_of, write_counter
from tests.waiting import HANG_S
from tltl_runtime.training.run.preparation import make_environments
from tltl_runtime.training.run.spaces import training_spaces
from tltlc.core.record import replace

START_S, STEP_S, LIMIT, SHARE = HANG_S, HANG_S, 40, 2


@pytest.mark.parametrize("searches", [False, True])
def test_a_worker_may_be_silent_for_as_long_as_the_deadlines_of_its_games_allow(
    tmp_path: Path, *, searches: bool
) -> None:
    process = json.dumps([sys.executable, str(COUNTER)])
    level = write_counter(tmp_path, f"process = {process}\nstart_s = {START_S}\nstep_s = {STEP_S}")
    run = run_of(tmp_path / "run", level, rollout__envs=3, rollout__workers=2)
    spaces = replace(training_spaces(run), searches=searches)
    with closing(make_environments(run, spaces)) as env:
        # A game that fails to start three times, a step, and in a search a whole episode that is replayed.
        least = 3 * START_S + STEP_S + (LIMIT * STEP_S if searches else 0)
        assert env._workers._timeout >= SHARE * least  # type: ignore[union-attr]
