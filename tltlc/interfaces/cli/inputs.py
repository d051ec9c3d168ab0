"""What a command is given, compiled: ``SPEC.tltl``, ``SPEC.tltl:NAME``, an artefact, or ``-`` for standard input."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError, stop_at_errors
from tltlc.interfaces.cli.settings import Settings, check_libraries, compile_settings
from tltlc.io.project import Project, project_for
from tltlc.io.spec_file import ARTEFACT_ENDING, STDIN, STDIN_NAME, read, split

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.core.source import SourceFile
    from tltlc.resolve.spec import Program


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

    Errors: TltlError with everything that the file's reading and compilation found, at the levels of its project.
    """
    path, name = split(argument)
    if path.endswith(".toml"):
        message = f"`{path}` is no spec; where it is a level, `tltlc check --level {path}` checks it"
        raise click.UsageError(message, click.get_current_context(silent=True))
    wanted = (*specs, name) if name else tuple(specs)
    check_libraries(settings.libraries)
    project = project_for(path)
    try:
        source, is_artefact = read(path)
    except TltlError as error:
        from tltlc.interfaces.cli.spec_names import with_way_out

        raise with_way_out(error, path) from None
    if source.text.startswith("HOA:") or path.endswith(".hoa"):
        raise TltlError([_of_another_tool(source)])
    if is_artefact:
        return _artefact(source, settings, wanted, project)
    from tltlc.pipeline import compile_source

    with project.levelling():
        compiled = compile_source(source, compile_settings(settings, project, wanted))
    found = project.levelled(compiled.diagnostics)
    stop_at_errors(found)
    return Input(source.name, compiled.automata, compiled.program, project, found)


def check_text(source: SourceFile) -> None:
    """For commands that take source texts alone: error TLT0722 for an artefact, TLT0652 for an automaton of others."""
    if source.text.startswith("HOA:"):
        raise TltlError([_of_another_tool(source)])
    if source.text.lstrip().startswith("{") or source.name.endswith(ARTEFACT_ENDING):
        raise TltlError([no_text(source.name)])


def no_text(artefact: str) -> Diagnostic:
    """The message for an artefact where only a source text will do."""
    title = f"`{artefact}` is an artefact: it holds an automaton, and no source text"
    return Diagnostic("TLT0722", title, help="name the .tltl file that it was compiled from")


def _of_another_tool(source: SourceFile) -> Diagnostic:
    title = f"`{source.name}` is an automaton in the Hanoi format, and no spec"
    way_out = f"`tltlc import {source.name} --predicates LIB.tltl` makes an artefact of it"
    return Diagnostic("TLT0652", title, help=way_out)


def _artefact(source: SourceFile, settings: Settings, wanted: tuple[str, ...], project: Project) -> Input:
    from tltlc.pipeline import read_artefact, unknown_spec, with_params

    fspa = read_artefact(source)
    for name in wanted:
        if name != fspa.name:
            raise TltlError([unknown_spec(name, [fspa.name], source.name)])
    return Input(source.name, (with_params(fspa, settings.params),), None, project, ())
