"""Random predicates over one signal: their source text and their values."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from hypothesis import strategies as st

BEFORE = "signal x in [0, 10]\n"
_VALUES = tuple(step / 8 for step in range(81))


class Predicate(NamedTuple):
    """The source text of a predicate, and a function from x to its value."""

    text: str
    value: Callable[[float], float]

    @property
    def declaration(self) -> str:
        """The declaration of this predicate as ``p``."""
        return f"{BEFORE}predicate p in [-1, 1] = clamp({self.text}, -1, 1)\n"

    def values(self) -> list[float]:
        """Return the values for many values of x, including both ends of its range."""
        return [max(-1.0, min(1.0, self.value(x))) for x in _VALUES]


_SLOPES = st.sampled_from([-0.2, -0.1, 0.0, 0.1, 0.2])
_HEIGHTS = st.sampled_from([-1.0, -0.5, 0.0, 0.5, 1.0])
_LINES = st.builds(
    lambda slope, height: Predicate(f"({slope} * x + {height})", lambda x: slope * x + height), _SLOPES, _HEIGHTS
)


def _minimum(one: Predicate, other: Predicate) -> Predicate:
    return Predicate(f"min({one.text}, {other.text})", lambda x: min(one.value(x), other.value(x)))


def _maximum(one: Predicate, other: Predicate) -> Predicate:
    return Predicate(f"max({one.text}, {other.text})", lambda x: max(one.value(x), other.value(x)))


def _split(one: Predicate, other: Predicate, border: int) -> Predicate:
    text = f"(when x < {border}: {one.text} otherwise: {other.text})"
    return Predicate(text, lambda x: one.value(x) if x < border else other.value(x))


PREDICATES = st.recursive(
    _LINES,
    lambda inner: (
        st.builds(_minimum, inner, inner)
        | st.builds(_maximum, inner, inner)
        | st.builds(_split, inner, inner, st.integers(0, 10))
    ),
    max_leaves=3,
)
