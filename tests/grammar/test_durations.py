"""How long something holds, in steps: the clause that is offered counts the samples."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.grammar.phrases_as_typed import fix
from tltlc import compile_text
from tltlc.monitor import Monitor


@pytest.mark.parametrize(
    ("typed", "accepts"),
    [
        ("avoid p for more than 4 steps", lambda steps: steps <= 4),
        ("avoid p for at least 4 steps", lambda steps: steps < 4),
        ("keep p for at most 4 steps", lambda steps: steps <= 4),
        ("keep p for less than 4 steps", lambda steps: steps < 4),
        ("reach p for at least 4 steps", lambda steps: steps >= 4),
        ("reach p for more than 4 steps", lambda steps: steps > 4),
    ],
)
def test_what_holds_for_steps_holds_at_as_many_samples(typed: str, accepts: Callable[[int], bool]) -> None:
    text, left = fix(f"clock 10 Hz\nsignal p: bool\nspec s {{\n    {typed}\n}}\n")
    assert not left
    (fspa,) = compile_text(text)
    for steps in range(1, 8):
        monitor = Monitor(fspa)
        for sample in [False] + [True] * steps + [False]:
            step = monitor.step({"p": sample})
        assert (step.verdict in ("satisfied", "holding")) == accepts(steps), (text, steps)
