"""Navigation: near(s1), then near(s2), then near(exit); judged at the goal, 300 steps."""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.handwritten.common import Step, near, read

SIGNALS = ("distance(s1)", "distance(s2)", "distance(exit)")
ATOMS = ("near(s1)", "near(s2)", "near(exit)")
LABELS = ("F(near(s1) & X F(near(s2) & X F near(exit)))", "F(near(s2) & X F near(exit))", "F near(exit)", "true")
LIMIT = 300


class Monitor:
    """The state is the number of places that were reached in order."""

    __slots__ = ("done", "level_size", "progress", "state", "steps")

    def __init__(self, level_size: float = 20.0) -> None:
        self.level_size = level_size
        self.reset()

    def reset(self) -> None:
        self.state = 0
        self.steps = 0
        self.progress = 0.0
        self.done = False

    def step(self, signals: Mapping[str, float]) -> Step:
        distances = read(signals, SIGNALS)
        state, limiting, robustness = self.state, None, 1.0
        progress = 1.0
        if state < 3:
            closeness = near(distances[state], self.level_size)
            if closeness > 0.0:
                robustness = closeness
                state += 1
                progress = state / 3
            else:
                robustness = -closeness
                limiting = ATOMS[state]
                progress = (state + 1.0 + closeness) / 3
        self.steps += 1
        best = max(self.progress, progress)
        reward = 0.0 if self.done else best - self.progress - 1 / LIMIT
        self.state, self.progress = state, best
        self.done = self.done or state == 3 or self.steps >= LIMIT
        return Step(
            state,
            LABELS[state],
            "satisfied" if state == 3 else "pending",
            state == 3,
            self.done,
            best,
            reward,
            robustness,
            limiting,
        )
