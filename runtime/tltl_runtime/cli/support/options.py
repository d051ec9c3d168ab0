"""Options that several commands share, except for their help texts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeVar

import click

from tltlc.api import cli

Function = TypeVar("Function", bound=Callable[..., Any])

_OUTPUT: Final = ("--output", "--out", "-o")


def output_folder(help_text: str, default: Path | None = None) -> Callable[[Function], Function]:
    """Return a decorator for the option ``-o DIR``. The command gets its value as ``folder``."""
    return click.option(
        *_OUTPUT,
        "folder",
        metavar="DIR",
        type=cli.OutputPath("folder", checked=True),
        default=default,
        show_default=default is not None,
        help=help_text,
    )


def output_file(metavar: str, help_text: str) -> Callable[[Function], Function]:
    """Return a decorator for the option ``-o FILE``. The command gets its value as ``path``."""
    return click.option(*_OUTPUT, "path", metavar=metavar, type=cli.OutputPath("file", checked=True), help=help_text)


def seed_option(help_text: str) -> Callable[[Function], Function]:
    """Return a decorator for the option ``--seed N``, by default 0."""
    kind = cli.WholeRange(min=0)
    return click.option("--seed", metavar="N", type=kind, default=0, show_default=True, help=help_text)


summary_format = click.option(
    "--format",
    type=click.Choice(("text", "json")),
    default="text",
    show_default=True,
    help="The format of the summary and of messages.",
)
