"""The option ``--workers``: processes or a Ray cluster."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    _Type = click.ParamType[Any]
else:
    # In older versions of click, a ParamType cannot have a type in brackets.
    _Type = click.ParamType


class WorkersType(_Type):
    """The click type of ``--workers``: a number of processes, 0 for the number of cores, or ``ray``."""

    name = "workers"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Convert the value to a number or to ``ray``."""
        if value == "ray" or isinstance(value, int):
            return value
        from tltl_runtime.training.files.settings_file import KINDS

        kind = KINDS["rollout"]["workers"]
        try:
            number = kind.read(int(value))
        except ValueError:
            number = None
        if number is None:
            self.fail(f"`{value}` is neither `ray` nor {kind}", param, ctx)
        return number


all_cores_option = click.option(
    "--workers",
    metavar="N|ray",
    type=WorkersType(),
    default=0,
    help="The number of processes that play (default: one per core), or `ray` for a Ray cluster.",
)
