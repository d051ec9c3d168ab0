"""Golden cases: a case is one file with a command, the files that it reads, and the message that it prints.

The name of a case is ``CODE[_variant].case``.  The format is similar to Go's txtar.  The first line is the command.
Each file follows a line ``-- NAME --``, and the expected text follows ``-- stderr --`` at the end.  A file that is not
UTF-8 text with a final line feed follows ``-- NAME (bytes) --`` and is written as a Python bytes literal.
"""

from __future__ import annotations

import ast
import os
import re
import shlex
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).parent
_HEADER = re.compile(r"^-- (?P<name>[^\n]+?)(?P<literal> \(bytes\))? --\n", re.MULTILINE)
_STDERR = "stderr"


@dataclass(frozen=True)
class Case:
    """The arguments of a command, the files that it reads, by name, and its expected standard error."""

    path: Path
    arguments: tuple[str, ...]
    files: dict[str, bytes]
    expected: str

    @property
    def name(self) -> str:
        """The code of the message, and the variant if there is one."""
        return self.path.stem

    def unpack(self, folder: Path) -> None:
        """Write the files to a folder, which is created if necessary."""
        folder.mkdir(exist_ok=True)
        for name, data in self.files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)

    def check(self, printed: str) -> None:
        """Assert that the printed text is the expected one; with ``UPDATE_GOLDEN=1``, write it to the case instead."""
        if os.environ.get("UPDATE_GOLDEN") == "1" and printed != self.expected:
            head = self.path.read_bytes().decode().rpartition(f"-- {_STDERR} --\n")[0]
            self.path.write_bytes(f"{head}-- {_STDERR} --\n{printed}".encode())
            return
        assert printed == self.expected


def cases(kind: str) -> list[Case]:
    """Return the cases in a folder next to this file, sorted by name."""
    return [read(path) for path in sorted((FOLDER / kind).glob("*.case"))]


def read(path: Path) -> Case:
    """Parse a case."""
    text = path.read_bytes().decode()
    headers = [*_HEADER.finditer(text)]
    ends = [*(header.start() for header in headers[1:]), len(text)]
    sections = {header["name"]: text[header.end() : end] for header, end in zip(headers, ends, strict=True)}
    literals = {header["name"] for header in headers if header["literal"]}
    expected = sections.pop(_STDERR)
    files = {
        name: ast.literal_eval(section) if name in literals else section.encode() for name, section in sections.items()
    }
    command, *arguments = shlex.split(text[: headers[0].start()])
    assert command == "tltlc"
    return Case(path, tuple(arguments), files, expected)


def sources() -> dict[str, bytes]:
    """Return the source files of all cases, by the name of the case and their own."""
    return {
        f"{kind}/{case.name}/{name}": data
        for kind in ("error", "level", "suite", "game")
        for case in cases(kind)
        for name, data in case.files.items()
        if name.endswith(".tltl")
    }
