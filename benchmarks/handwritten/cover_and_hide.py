"""Cover and Hide: near(s1), then near(s2), then near(exit), alive throughout; judged at the goal, 400 steps.

The three places exclude each other.
"""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.handwritten.common import Step, near, read

SIGNALS = ("distance(s1)", "distance(s2)", "distance(exit)", "health")
ATOMS = ("near(s1)", "near(s2)", "near(exit)")
LABELS = (
    "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive",
    "F(near(s2) & X F near(exit)) & G alive",
    "false",
    "F near(exit) & G alive",
    "G alive",
)
VERDICTS = ("pending", "pending", "violated", "pending", "holding")
PLACE = {0: 0, 1: 1, 3: 2}
NEXT = {0: 1, 1: 3, 3: 4}
TRAP, GOAL = 2, 4
LIMIT = 400


class Monitor:
    """States are numbered as in the compiled automaton.

    States 0, 1 and 3 wait for a place, 4 is the goal, and 2 is the trap.
    """

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
        to_s1, to_s2, to_exit, health = read(signals, SIGNALS)
        alive = min(max(health, 0.0), 1.0)
        level_size = self.level_size
        closeness = (near_s1, near_s2, near_exit) = (
            near(to_s1, level_size),
            near(to_s2, level_size),
            near(to_exit, level_size),
        )
        if (near_s1 > 0.0) + (near_s2 > 0.0) + (near_exit > 0.0) > 1:
            raise ValueError(f"only one of {', '.join(ATOMS)} may hold at a time")
        state, limiting, progress = self.state, None, 0.0
        if state == TRAP:
            robustness = 1.0
        elif alive <= 0.0:
            state, robustness = TRAP, 0.0
        elif state == GOAL:
            robustness, progress = alive, 1.0
        else:
            place = PLACE[state]
            here = closeness[place]
            if here > 0.0:
                state, robustness, progress = NEXT[state], min(here, alive), (place + 1) / 3
            else:
                # At another place the player is certainly not here, because the places exclude each other.
                robustness = min(max(-here, closeness[place - 1], closeness[place - 2]), alive)
                limiting = ATOMS[place]
                progress = (place + 1.0 + here) / 3
        self.steps += 1
        best = max(self.progress, progress)
        if self.done:
            reward = 0.0
        else:
            reward = best - self.progress - 1 / LIMIT
            if state == TRAP:
                reward -= (LIMIT - self.steps) / LIMIT
        self.state, self.progress = state, best
        self.done = self.done or state in (TRAP, GOAL) or self.steps >= LIMIT
        return Step(state, LABELS[state], VERDICTS[state], state == GOAL, self.done, best, reward, robustness, limiting)
