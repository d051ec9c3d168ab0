"""Number types for command-line options: bounded whole numbers and finite floats."""

from __future__ import annotations

from math import isfinite
from typing import Any, Final, NoReturn

import click

LARGEST: Final = 2**62
"""The largest whole number that an option accepts. The sum of two of them fits into 64 bits."""
_MOST_DIGITS: Final = 20


class WholeRange(click.IntRange):
    """The type of options that take a whole number in a range, at most :data:`LARGEST`."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the value as an int; raise a usage error if it is not a whole number in the range."""
        text = str(value).strip()
        digits = text.lstrip("+-").lstrip("0")
        # Python refuses to parse thousands of digits.
        if len(digits) > _MOST_DIGITS and digits.isdecimal():
            self._fail(f"{text[:_MOST_DIGITS]}…", param, ctx)
        number = super().convert(value, param, ctx)
        if abs(number) > LARGEST:
            self._fail(text, param, ctx)
        return number

    def _describe_range(self) -> str:
        # Without bounds, click would show `x<=None` in the help text.
        return "" if self.min is None and self.max is None else super()._describe_range()

    def _fail(self, text: str, param: click.Parameter | None, ctx: click.Context | None) -> NoReturn:
        self.fail(f"`{text}` is out of range: whole numbers go from -{LARGEST:,} to {LARGEST:,}", param, ctx)


class FiniteRange(click.FloatRange):
    """The type of options that take a finite number in a range; click's own type accepts `nan`."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the value as a float; raise a usage error if it is not a finite number in the range."""
        number = super().convert(value, param, ctx)
        if not isfinite(number):
            self.fail("write a finite number", param, ctx)
        return number
