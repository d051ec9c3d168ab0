"""The option for the notation of formulas."""

from __future__ import annotations

from typing import Final

import click

NOTATIONS: Final = ("english", "unicode", "ascii")

notation_option = click.option(
    "--notation",
    type=click.Choice(NOTATIONS),
    default="english",
    show_default=True,
    help="The notation of the formulas in the picture.",
)
