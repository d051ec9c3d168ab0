"""Rows of the tables of a monitor in Python, and tests of values."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from tltlc.backends.languages.python_syntax import long_tuple, short_tuple
from tltlc.program.label_texts import LabelTexts
from tltlc.program.names import float_literal, string_literal
from tltlc.resolve.spec import Signal


def within(signal: Signal, variable: str) -> str:
    """Return a Python expression that is true if the float ``variable`` is finite and in the range of a signal."""
    if signal.type == "bool":
        return f"({variable} == 0.0 or {variable} == 1.0)"
    low = f"-inf < {variable}" if signal.low is None else f"{float_literal(signal.low)} <= {variable}"
    return f"{low} < inf" if signal.high is None else f"{low} <= {float_literal(signal.high)}"


def two_hold(atoms: Sequence[str]) -> str:
    """Return a Python expression that is true if at least two of the atoms hold; it is fast if none holds."""
    if len(atoms) > 8:
        return f"sum(value > 0.0 for value in {short_tuple(atoms)}) > 1"
    tests = [f"{atom} > 0.0" for atom in atoms]
    later_tests = [" or ".join(tests[index + 1 :]) for index in range(len(tests) - 1)]
    pairs = [f"({test} and {f'({rest})' if ' or ' in rest else rest})" for test, rest in zip(tests, later_tests)]  # noqa: B905
    return " or ".join(pairs)


def label_texts(labels: LabelTexts) -> str:
    """Return the tuple of the texts of labels, each as the tuple of its pieces."""
    return long_tuple([short_tuple([*map(string_literal, pieces)]) for pieces in labels.texts])


def signal_row(signal: Signal) -> str:
    """Return the row of a signal: its name, whether it is a bool, its least and greatest value."""
    low, high = low_literal(signal.low), high_literal(signal.high)
    return f"({string_literal(signal.name)}, {signal.type == 'bool'}, {low}, {high})"


def low_literal(low: float | None) -> str:
    """Return the literal of the lower end of a range."""
    return "-inf" if low is None else float_literal(low)


def high_literal(high: float | None) -> str:
    """Return the literal of the upper end of a range."""
    return float_literal(inf if high is None else high)
