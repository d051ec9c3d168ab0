"""Golden cases: one file holds a command, the files that it reads, and the message that it prints.

A case is called ``CODE[_variant].case``.  Its first line is the command, then each file follows under a line
``-- NAME --``, and last the expected text under ``-- stderr --``, as in the txtar format of Go.  A file that is not
plain UTF-8 text with a line feed at its end stands under ``-- NAME (bytes) --``, as a bytes literal of Python.
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
    """A command with its arguments, the files that it reads by their names, and what it prints to standard error."""

    path: Path
    arguments: tuple[str, ...]
    files: dict[str, bytes]
    expected: str

    @property
    def name(self) -> str:
        """The code of the message, and what is special about the case."""
        return self.path.stem

    def unpack(self, folder: Path) -> None:
        """Write the files into a folder, which may be missing."""
        folder.mkdir(exist_ok=True)
        for name, data in self.files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)

    def check(self, printed: str) -> None:
        """Assert that this was printed; with ``UPDATE_GOLDEN=1`` in the environment, write it into the case."""
        if os.environ.get("UPDATE_GOLDEN") == "1" and printed != self.expected:
            head = self.path.read_bytes().decode().rpartition(f"-- {_STDERR} --\n")[0]
            self.path.write_bytes(f"{head}-- {_STDERR} --\n{printed}".encode())
            return
        assert printed == self.expected


def cases(kind: str) -> list[Case]:
    """The cases of a folder beside this file, by name."""
    return [read(path) for path in sorted((FOLDER / kind).glob("*.case"))]


def read(path: Path) -> Case:
    """The case in a file."""
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
