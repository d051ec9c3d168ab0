"""The type of arguments and options that name a file or folder to write to."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final, Literal

import click

STDOUT: Final = "-"
"""The path that means standard output for commands that write one text."""


class OutputPath(click.Path):
    """The type of arguments and options that name a file or folder to write to.

    ``-`` means standard output if ``stdout`` is set; otherwise ``-`` is refused. ``kind`` is what
    an existing path must be: a file, a folder, or either ("place"). If ``checked``, an existing
    path of the wrong kind is refused at once; otherwise it is reported with TLT0005 when the
    command writes.
    """

    def __init__(
        self, kind: Literal["file", "folder", "place"], *, stdout: bool = False, checked: bool = False
    ) -> None:
        super().__init__(
            path_type=Path,
            allow_dash=stdout,
            # A folder may be writable without being readable.
            readable=False,
            file_okay=not checked or kind != "folder",
            dir_okay=not checked or kind != "file",
        )
        self.kind = kind
        self.stdout = stdout

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the value as a path; fail with a usage error if it is refused.

        For ``./-``, a file that is named ``-``, return the absolute path, because the path ``-`` means
        standard output.
        """
        if value == STDOUT and not self.stdout:
            kind = "file or a folder" if self.kind == "place" else self.kind
            # Without `stdout`, the option needs a file or folder; standard output is neither.
            self.fail(f"expected a {kind}, found `-` (write `./-` for a {kind} with this name)", param, ctx)
        path = Path(super().convert(value, param, ctx))  # type: ignore[arg-type] # `path_type` makes it one
        return Path.cwd() / path if str(path) == STDOUT != value else path


def is_stdout(path: Path | None) -> bool:
    """Whether a path that :class:`OutputPath` parsed means standard output."""
    return path is not None and str(path) == STDOUT
