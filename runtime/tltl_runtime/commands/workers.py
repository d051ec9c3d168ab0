"""The option that says who plays: processes, or a Ray cluster."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import click

if TYPE_CHECKING:
    _Type = click.ParamType[Any]
else:
    # Only newer versions of click have a type there.
    _Type = click.ParamType

_MOST: Final = 10_000


class WorkersType(_Type):
    """How many processes play, 0 for as many as there are cores, or ``ray``."""

    name = "workers"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number, or ``ray``."""
        if value == "ray" or isinstance(value, int):
            return value
        if not (value.isascii() and value.isdecimal()) or int(value) > _MOST:
            self.fail(f"`{value}` is neither a number of processes nor `ray`", param, ctx)
        return int(value)
