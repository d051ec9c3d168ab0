"""Branching: three switches in order, then the exit behind an open barrier, alive throughout; 600 steps."""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.handwritten.common import Step, near, read

SIGNALS = (
    "distance(s1)",
    "distance(s2)",
    "distance(s3)",
    "distance(e_right)",
    "distance(e_left)",
    "open_right",
    "open_left",
    "health",
)
ATOMS = ("near(s1)", "near(s2)", "near(s3)")
_EXIT = "open_right & near(e_right) | open_left & near(e_left)"
LABELS = (
    f"F(near(s1) & X F(near(s2) & X F(near(s3) & X F({_EXIT})))) & G alive",
    f"F(near(s2) & X F(near(s3) & X F({_EXIT}))) & G alive",
    "false",
    f"F(near(s3) & X F({_EXIT})) & G alive",
    f"F({_EXIT}) & G alive",
    "G alive",
)
VERDICTS = ("pending", "pending", "violated", "pending", "pending", "holding")
SWITCH = {0: 0, 1: 1, 3: 2}
NEXT = {0: 1, 1: 3, 3: 4}
TRAP, EXITS, GOAL = 2, 4, 5
LIMIT = 600


class Monitor:
    """States are numbered as in the compiled automaton.

    States 0, 1 and 3 wait for a switch, 4 waits for an exit, 5 is the goal, and 2 is the trap.
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
        s1, s2, s3, e_right, e_left, open_right, open_left, health = read(signals, SIGNALS)
        alive = min(max(health, 0.0), 1.0)
        state, limiting, progress = self.state, None, 0.0
        if state == TRAP:
            robustness = 1.0
        elif alive <= 0.0:
            state, robustness = TRAP, 0.0
        elif state == GOAL:
            robustness, progress = alive, 1.0
        elif state == EXITS:
            right_open, right_near = 2.0 * open_right - 1.0, near(e_right, self.level_size)
            left_open, left_near = 2.0 * open_left - 1.0, near(e_left, self.level_size)
            right, left = min(right_open, right_near), min(left_open, left_near)
            nearest = max(right, left)
            if nearest > 0.0:
                state, robustness, progress = GOAL, min(nearest, alive), 1.0
            else:
                robustness = min(-right, -left, alive)
                progress = (4.0 + nearest) / 4
                if right >= left:
                    limiting = "open_right" if right_open <= right_near else "near(e_right)"
                else:
                    limiting = "open_left" if left_open <= left_near else "near(e_left)"
        else:
            switch = SWITCH[state]
            closeness = near((s1, s2, s3)[switch], self.level_size)
            if closeness > 0.0:
                state, robustness, progress = NEXT[state], min(closeness, alive), (switch + 1) / 4
            else:
                robustness = min(-closeness, alive)
                limiting = ATOMS[switch]
                progress = (switch + 1.0 + closeness) / 4
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
