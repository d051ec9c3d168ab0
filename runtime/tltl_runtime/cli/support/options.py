"""Options that several commands share, except for their help texts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeVar

import click

from tltlc.api import cli

Function = TypeVar("Function", bound=Callable[..., Any])

_OUTPUT: Final = ("--output", "--out", "-o")


def output_folder(about: str, default: Path | None = None) -> Callable[[Function], Function]:
    """The option ``-o DIR``, passed to the command as ``folder``."""
    return click.option(
        *_OUTPUT,
        "folder",
        metavar="DIR",
        type=cli.OutputPath("folder", checked=True),
        default=default,
        show_default=default is not None,
        help=about,
    )


def output_file(metavar: str, about: str) -> Callable[[Function], Function]:
    """The option ``-o FILE``, passed to the command as ``path``."""
    return click.option(*_OUTPUT, "path", metavar=metavar, type=cli.OutputPath("file", checked=True), help=about)


def seed_option(about: str) -> Callable[[Function], Function]:
    """The option ``--seed N``, by default 0."""
    kind = cli.WholeRange(min=0)
    return click.option("--seed", metavar="N", type=kind, default=0, show_default=True, help=about)


summary_format = click.option(
    "--format",
    type=click.Choice(("text", "json")),
    default="text",
    show_default=True,
    help="Of the summary, and of messages.",
)
