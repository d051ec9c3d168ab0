"""Paths that commands write to."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final, Literal

import click

STDOUT: Final = "-"
"""The path that stands for standard output where a command writes one text."""


class OutputPath(click.Path):
    """A file or a folder to write to: ``-`` means standard output where ``stdout`` is set, and is refused elsewhere.

    ``kind`` is what it must be if something is there already; "place" is either.  Without ``checked``, the writing
    itself reports something else that is there, with TLT0005.
    """

    def __init__(
        self, kind: Literal["file", "folder", "place"], *, stdout: bool = False, checked: bool = False
    ) -> None:
        super().__init__(
            path_type=Path,
            allow_dash=stdout,
            # One may write into a folder that one must not list.
            readable=False,
            file_okay=not checked or kind != "folder",
            dir_okay=not checked or kind != "file",
        )
        self.kind = kind
        self.stdout = stdout

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path; of a file with the name ``-``, which is written ``./-``, the absolute one."""
        if value == STDOUT and not self.stdout:
            kind = "file or a folder" if self.kind == "place" else self.kind
            # Where one is needed, standard output is none.
            self.fail(f"a {kind} is needed, and `-` is none (`./-` is one of that name)", param, ctx)
        path = Path(super().convert(value, param, ctx))  # type: ignore[arg-type] # `path_type` makes it one
        return Path.cwd() / path if str(path) == STDOUT != value else path


def is_stdout(path: Path | None) -> bool:
    """Whether a path that :class:`OutputPath` has read stands for standard output."""
    return path is not None and str(path) == STDOUT
