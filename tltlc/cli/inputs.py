"""What a command is given: ``SPEC.tltl``, ``SPEC.tltl:NAME``, an artefact, or ``-`` for standard input."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tltlc.cli.main import STDIN_NAME
from tltlc.cli.project import Project, project_for
from tltlc.cli.settings import Settings, check_libraries
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.files import MAX_ARTEFACT_BYTES, MAX_SOURCE_BYTES, decode, reading_error
from tltlc.record import record
from tltlc.source import SourceFile

if TYPE_CHECKING:
    from typing import BinaryIO

    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Program

STDIN: Final = "-"
_PLAIN_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


@record
class Input:
    """A compiled argument: its automata in order, and the program unless it is an artefact."""

    name: str
    automata: tuple[Fspa, ...]
    program: Program | None
    project: Project
    diagnostics: tuple[Diagnostic, ...]

    def one(self) -> Fspa:
        """The only automaton; error TLT0721 where there are several or none."""
        if len(self.automata) == 1:
            return self.automata[0]
        names = [fspa.name for fspa in self.automata]
        title = (
            f"`{self.name}` holds {len(names)} specs, and this command takes one"
            if names
            else (f"`{self.name}` holds no spec")
        )
        path = STDIN if self.name == STDIN_NAME else self.name
        way_out = f"name one of them, e.g. `{path}:{names[0]}`" if names else "declare one: `spec NAME { … }`"
        raise TltlError([Diagnostic("TLT0721", title, help=way_out)])


def open_input(argument: str, settings: Settings, specs: Sequence[str] = ()) -> Input:
    """Read and compile an argument; ``specs`` picks by name beside what the argument itself says.

    Errors: TltlError with everything that the file's reading and compilation found.
    """
    path, name = split(argument)
    wanted = (*specs, name) if name else tuple(specs)
    check_libraries(settings.libraries)
    project = project_for(path)
    source, is_artefact = read(path)
    if is_artefact:
        return _artefact(source, settings, wanted, project)
    from tltlc.automaton.build import DEFAULT_STATE_BUDGET
    from tltlc.pipeline import CompileOptions, compile_source

    options = CompileOptions(
        library_dirs=(*settings.libraries, *project.libraries),
        params=settings.params,
        state_budget=settings.state_budget or DEFAULT_STATE_BUDGET,
        specs=wanted,
    )
    compiled = compile_source(source, options)
    return Input(source.name, compiled.automata, compiled.program, project, compiled.diagnostics)


def split(argument: str) -> tuple[str, str | None]:
    """The path and the name of ``PATH:NAME``; a path that exists, or a drive letter, is never split."""
    path, colon, name = argument.rpartition(":")
    if not colon or not path or not _PLAIN_NAME.match(name) or os.path.exists(argument):  # noqa: PTH110
        return argument, None
    if len(path) == 1 and path.isalpha() and os.name == "nt":
        return argument, None
    return STDIN if path == STDIN_NAME else path, name


def read(path: str) -> tuple[SourceFile, bool]:
    """The text of a file or of standard input, and whether it is an artefact: no source begins with a brace."""
    if path == STDIN:
        return _read_stream(sys.stdin.buffer, STDIN_NAME)
    try:
        with Path(path).open("rb") as file:
            return _read_stream(file, path)
    except (OSError, ValueError) as error:
        raise reading_error(path, error) from None


def _read_stream(stream: BinaryIO, name: str) -> tuple[SourceFile, bool]:
    data = stream.read(MAX_SOURCE_BYTES + 1)
    if not data.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"):
        return decode(data, name), False
    data += stream.read(MAX_ARTEFACT_BYTES + 1 - len(data))
    return decode(data, name, max_bytes=MAX_ARTEFACT_BYTES), True


def _artefact(source: SourceFile, settings: Settings, wanted: tuple[str, ...], project: Project) -> Input:
    from tltlc.pipeline import read_artefact, unknown_spec, with_params

    fspa = read_artefact(source)
    for name in wanted:
        if name != fspa.name:
            raise TltlError([unknown_spec(name, [fspa.name], source.name)])
    return Input(source.name, (with_params(fspa, settings.params),), None, project, ())
