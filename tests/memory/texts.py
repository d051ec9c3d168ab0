"""Random formulas about the trace so far, as source texts, and random traces for them; each made from a seed."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Final

DECLARATIONS: Final = """
entity a, b
entity both = a, b
signal p: bool
signal q: bool
signal r: bool
signal near(t: entity): bool
signal hp in [0, 10]
signal x in [-4, 4]
signal d(t: entity): length in [0 m, 20 m]
param k in [1, 6] = 3
predicate low in [-1, 1] = (5 - hp) / 5
predicate far(t: entity, lim: length = 10 m) = clamp((d(t) - lim) / 10 m, -1, 1)
predicate often(t: entity) = clamp((times(near(t), 5) - 2) / 3, -1, 1)
predicate jump = when hp < previous(hp): 0.5 when times(once p and q) == 2: -0.25 otherwise: previous(x) / 4
let danger = p or hp < 3
let rising(f, g) = f and previously g
let close(t: entity) = near(t) or d(t) < 3 m
let twice(f) = times(f) >= 2 or once (f and previously f)
"""
CLOCKS: Final = ("10 Hz", "4 Hz", "0.05 s", "0.03 s", "150 ms", "60 Hz")
PERIODS: Final = (0.1, 0.25, 0.05, 0.03, 0.15, 1 / 60)
SIGNALS: Final = ("p", "q", "r", "near(a)", "near(b)", "hp", "x", "d(a)", "d(b)")

_STATES: Final = ("p", "q", "r", "near(a)", "near(b)", "danger", "low", "far(a)", "far(b, lim = 5 m)", "close(b)")
_STATES_WITH_MEMORY: Final = ("often(a)", "jump", "twice(q)", "previous(p)", "highest(q)", "initial(near(a))")


class Texts:
    """Makes formulas, for a clock of ``CLOCKS`` by its number."""

    def __init__(self, random: Random, clock: int) -> None:
        self._random = random
        self._period = PERIODS[clock]

    def past(self, depth: int) -> str:
        """Return a formula about the trace so far; no more than ``depth`` operators contain each other."""
        random = self._random
        if depth <= 0:
            return random.choice(_STATES if random.random() < 0.85 else _STATES_WITH_MEMORY)
        kind = random.randrange(10)
        if kind < 4:
            return self.operator(depth)
        if kind < 7:
            return self.comparison(depth)
        if kind == 7:
            return f"not ({self.past(depth - 1)})"
        if kind == 8:
            op = random.choice(("and", "or", "implies", "iff"))
            return f"(({self.past(depth - 1)}) {op} ({self.past(depth - 1)}))"
        inner = random.choice((self.past(depth - 1), f"near(t) {random.choice(('and', 'or'))} once close(t)"))
        if random.random() < 0.3:
            return f"rising({inner.replace('(t)', '(a)')}, {self.past(depth - 2)})"
        group = random.choice(("(a, b)", "both"))
        return f"({random.choice(('all', 'any'))} t in {group}: {inner})"

    def operator(self, depth: int) -> str:
        """Return a past operator over formulas."""
        random = self._random
        operand = f"({self.past(depth - 1)})"
        kind = random.randrange(9)
        if kind < 5:
            return f"{('once', 'historically', 'previously', 'begins', 'ends')[kind]} {operand}"
        if kind < 7:
            return f"({operand} since ({self.past(depth - 1)}))"
        bound = f"{random.randint(1, 5)} steps" if random.random() < 0.5 else self._time()
        return f"once within {bound} {operand}" if kind == 7 else f"historically for {bound} {operand}"

    def comparison(self, depth: int) -> str:
        """Return a comparison of two numbers; it may be always or never true, and so in error."""
        random = self._random
        op = random.choice(("<", "<=", ">", ">="))
        kind = random.randrange(7)
        inner = self.past(depth - 1)
        if kind == 0:
            maximum = f", {random.randint(1, 5)}" if random.random() < 0.3 else ""
            if random.random() < 0.3:
                other = random.choice(("0", "1", "2", "3", f"times({self.past(depth - 1)}, 3)"))
                return f"times({inner}{maximum}) {random.choice(('==', '!='))} {other}"
            return f"times({inner}{maximum}) {op} {random.choice(('1', '2', '3', '1.5', 'k', 'hp', '0'))}"
        if kind == 6:
            maximum = f", {random.randint(1, 5)}" if random.random() < 0.3 else ""
            if random.random() < 0.5:
                window = random.choice((f"{random.randint(0, 5)} steps", self._time()))
                return f"times_within({inner}, {window}{maximum}) {op} {random.choice(('1', '2', '3', 'k'))}"
            return f"times_since({inner}, {self.past(depth - 1)}{maximum}) {op} {random.choice(('1', '2', '3', 'k'))}"
        if kind < 3:
            function = random.choice(("time_since", "total_time")) if kind == 1 else "time_holding"
            if random.random() < 0.2:
                function, inner = "total_time_since", f"{inner}, {self.past(depth - 1)}"
            elif random.random() < 0.2:
                window = random.choice((f"{random.randint(1, 6)} steps", self._time()))
                function, inner = "total_time_within", f"{inner}, {window}"
            maximum = f", {self._time()}" if random.random() < 0.3 else ""
            return f"{function}({inner}{maximum}) {op} {self._time()}"
        if kind == 3:
            return f"{self._length()} {op} {random.choice(('3', '7', '12.5'))} m"
        if kind == 4:
            return f"{self._plain(depth)} {op} {self._plain(depth)}"
        return f"{self._plain(depth)} {op} {random.choice(('0', '1', '2', '-1', '5', 'k'))}"

    def spec(self, depth: int) -> str:
        """Return a formula about the whole trace, whose parts speak of the trace so far."""
        random = self._random
        kind = random.randrange(8)
        if depth <= 0 or kind == 0:
            return f"({self.past(2)})"
        if kind < 4:
            op = random.choice(("F", "G", "X", "N", "not", "eventually within 2 steps", "always for 2 steps"))
            return f"{op} ({self.spec(depth - 1)})"
        op = random.choice(("U", "W", "R", "M", "and", "or", "implies"))
        return f"(({self.spec(depth - 1)}) {op} ({self.spec(depth - 1)}))"

    def _time(self) -> str:
        """Return a time that is a whole number of steps, or nearly one."""
        steps = self._random.choice((1, 2, 3, 3, 4, 6, 9))
        nearly = self._random.choice((0, 0, 0, 0.001, -0.001))
        return f"{round(steps * self._period + nearly, 6)} s"

    def _length(self) -> str:
        entity = self._random.choice("ab")
        function = self._random.choice(("previous", "initial", "highest", "lowest", ""))
        return f"{function}(d({entity}))"

    def _plain(self, depth: int) -> str:
        random = self._random
        kind = random.randrange(7)
        if depth <= 0 or kind == 0:
            return random.choice(("hp", "x", "far(a)", "jump", "low"))
        if kind == 1:
            return f"times({self.past(depth - 1)}, {random.randint(1, 5)})"
        if kind == 2:
            op = random.choice("+-*")
            return f"({self._plain(depth - 1)} {op} {self._plain(depth - 1)})"
        if kind == 3:
            inner = self._plain(depth - 1)
            return random.choice((f"abs({inner})", f"min({inner}, hp)", f"-({inner})", f"max(x, {inner}) / 2"))
        if random.random() < 0.2:
            function = random.choice(("value_at", "highest_since", "lowest_since"))
            return f"{function}({self._plain(depth - 1)}, {self.past(depth - 1)})"
        if random.random() < 0.2:
            function = random.choice(("previous", "highest_within", "lowest_within"))
            return (
                f"{function}({self._plain(depth - 1)}, {random.choice(('1 step', '2 steps', '5 steps', self._time()))})"
            )
        return f"{random.choice(('previous', 'initial', 'highest', 'lowest'))}({self._plain(depth - 1)})"


def trace(random: Random, length: int) -> list[dict[str, float]]:
    """Return samples of all signals; numbers are often at the borders at which formulas change."""
    stays = random.choice((0.3, 0.6, 0.8))
    samples: list[dict[str, float]] = []
    for _ in range(length):
        sample = _sample(random)
        if samples:
            sample = {name: samples[-1][name] if random.random() < stays else sample[name] for name in sample}
        samples.append(sample)
    return samples


def _sample(random: Random) -> dict[str, float]:
    def number(values: Sequence[float], low: float, high: float) -> float:
        return random.choice(values) if random.random() < 0.7 else random.uniform(low, high)

    bools = {name: float(random.random() < 0.5) for name in SIGNALS[:5]}
    lengths = {name: number((3.0, 5.0, 7.0, 10.0), 0.0, 20.0) for name in ("d(a)", "d(b)")}
    return {**bools, **lengths, "hp": number((0, 1, 2, 3, 5, 6, 10), 0, 10), "x": number((-4, -1, 0, 1, 4), -4, 4)}
