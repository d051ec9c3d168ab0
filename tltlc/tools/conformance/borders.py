"""Comparisons over ranges of all sizes, with values next to their thresholds.

They test that scaling a comparison to a value in [-1, 1] does not change whether it is true.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import inf, ldexp, nextafter
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.traces import table


@record
class Border:
    """A comparison ``x OP threshold``, where x is a signal with the range [low, high].

    If ``threshold`` is None, x is compared with another signal of the same range, not with a number.
    """

    op: str
    threshold: float | None
    low: float
    high: float

    def declaration(self, number: int) -> str:
        """Return the declaration of the signal ``xN``, where N is ``number``.

        If the threshold is a signal, the text also declares this signal, ``yN``.
        """
        names = [f"x{number}"] if self.threshold is not None else [f"x{number}", f"y{number}"]
        return "".join(f"signal {name} in [{self.low!r}, {self.high!r}]\n" for name in names)

    def comparison(self, number: int) -> str:
        """Return the comparison as a spec contains it: ``x1 > 0.5``."""
        return f"x{number} {self.op} {f'y{number}' if self.threshold is None else repr(self.threshold)}"

    def values(self) -> Iterator[tuple[float, ...]]:
        """Yield values of x at and next to the threshold, and at the ends of the range.

        Each is a tuple of x alone, or of x and the threshold if the threshold is a signal.
        """
        for threshold in (self.low, self.high, 0.0) if self.threshold is None else (self.threshold,):
            for x in (threshold, *_neighbours(threshold), self.low, self.high, 1e-30, -1e-30):
                if self.low <= x <= self.high and self.low <= threshold <= self.high:
                    yield (x, threshold) if self.threshold is None else (x,)

    def holds(self, x: float, threshold: float | None = None) -> bool:
        """Whether the comparison is true for ``x``.

        If the threshold is a signal, pass its value as ``threshold``.
        """
        right = self.threshold if threshold is None else threshold
        assert right is not None, "a threshold that varies is given"
        return {"<": x < right, "<=": x <= right, ">": x > right, ">=": x >= right}[self.op]

    def true_values(self) -> tuple[float, ...]:
        """Return values at which the comparison is true, in the form of :meth:`values`."""
        x, threshold = (self.high, self.low) if self.op[0] == ">" else (self.low, self.high)
        return (x, threshold) if self.threshold is None else (x,)


def _neighbours(number: float) -> tuple[float, float]:
    return nextafter(number, -inf), nextafter(number, inf)


EXTREMES: Final = (
    Border(">", -1e308, -1e308, 1e308),
    Border("<", 0.0, -1.7e308, 1.7e308),
    Border(">", 0.0, 0.0, 1e300),
    Border(">=", 0.0, -1e300, 3.0),
    Border("<", 5e-324, 0.0, 1e-300),
    Border("<=", 30.0, 0.0, 100.0),
    Border(">", None, -1.5e308, 1.5e308),
    Border("<=", None, 0.0, 1e300),
)


def random_borders(draw: Draw, count: int) -> tuple[Border, ...]:
    """Return ``count`` random comparisons. Their ranges and thresholds are normal floats of any size."""
    borders: list[Border] = []
    while len(borders) < count:
        low, threshold, high = sorted(_random_number(draw) for _ in range(3))
        if low < threshold < high:
            op = draw.choice(("<", "<=", ">", ">="))
            borders.append(Border(op, None if draw.chance(0.25) else threshold, low, high))
    return tuple(borders)


def _random_number(draw: Draw) -> float:
    """Return a random normal float.

    Subnormal floats are left out: Mono, which runs the monitors in C#, misreads them by one bit.
    """
    sign = -1.0 if draw.chance(0.5) else 1.0
    return sign * ldexp(1 + draw.below(1 << 20) / (1 << 20), draw.below(2046) - 1022)


def _case(name: str, borders: tuple[Border, ...]) -> ConformanceCase:
    """Return a case whose spec requires all comparisons again and again.

    In each row of its trace, at most one comparison is false.
    """
    numbered = list(enumerate(borders, start=1))
    declarations = "".join(border.declaration(number) for number, border in numbered)
    formula = " and ".join(border.comparison(number) for number, border in numbered)
    text = f"{declarations}\nspec {name} = always eventually ({formula})\n"
    (fspa,) = compile_source(SourceFile(f"{name}.tltl", text), CompileOptions(specs=(name,))).automata
    columns = [f"{letter}{number}" for number, border in numbered for letter in "xy"[: len(border.true_values())]]
    rows = [
        [value for n, b in numbered for value in (values if n == number else b.true_values())]
        for number, border in numbered
        for values in border.values()
    ]
    return ConformanceCase(
        fspa, "Comparisons next to their thresholds, in ranges of all sizes.", (table(columns, rows),), text
    )


def _random_case(name: str, seed: int) -> ConformanceCase:
    return _case(name, random_borders(Draw(seed), 8))


CASES: Final[CaseBuilders] = {
    "borders": partial(_case, "borders", EXTREMES),
    **{f"borders_{n}": partial(_random_case, f"borders_{n}", 8000 + n) for n in range(1, 4)},
}
