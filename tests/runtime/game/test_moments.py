"""Moments of episodes in words, with and without a clock."""

from __future__ import annotations

import numpy as np
import pytest

from tltl_runtime.game.moments import duration_text, has_clock, moment_text


@pytest.mark.parametrize(
    ("step_s", "is_timed", "moment", "duration"),
    [(0.1, True, "0.20 s", "0.40 s"), (1.0, False, "step 2", "4 steps")],
)
def test_moments_are_in_seconds_if_there_is_a_clock(step_s: float, is_timed: bool, moment: str, duration: str) -> None:
    times = np.arange(5) * step_s
    assert (has_clock(times), moment_text(times, 2), duration_text(times)) == (is_timed, moment, duration)


def test_one_step_is_no_plural() -> None:
    assert duration_text(np.arange(2.0)) == "1 step"
