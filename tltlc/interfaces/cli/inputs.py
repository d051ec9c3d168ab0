"""Read and compile the argument of a command.

An argument is ``SPEC.tltl``, ``SPEC.tltl:NAME``, an artefact (an automaton that was compiled before,
``NAME.fspa.json``), or ``-`` for standard input.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError, stop_at_errors
from tltlc.interfaces.cli.settings import CompileSettings, check_libraries, compile_settings
from tltlc.io.project import GAME_SUFFIX, Project, project_for
from tltlc.io.spec_file import ARTEFACT_ENDING, STDIN, STDIN_NAME, read, split

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.core.source import SourceFile
    from tltlc.pipeline import Session
    from tltlc.resolve.spec import ResolvedFile


@record
class Input:
    """A compiled argument of a command: one automaton per spec, in the order of the specs.

    ``name`` is the name of the file in messages. ``session`` is the compiler's session for the
    source text; None for an artefact. ``diagnostics`` are warnings and notes, no errors.
    """

    name: str
    automata: tuple[Fspa, ...]
    session: Session | None
    project: Project
    diagnostics: tuple[Diagnostic, ...]

    @property
    def program(self) -> ResolvedFile | None:
        """The specs and tests of the source text; None for an artefact."""
        return self.session.program if self.session else None

    def only_automaton(self) -> Fspa:
        """Return the only automaton; raise TltlError, TLT0721, if there are several or none."""
        if len(self.automata) == 1:
            return self.automata[0]
        names = [fspa.name for fspa in self.automata]
        title = (
            f"`{self.name}` contains {len(names)} specs, but this command takes one"
            if names
            else (f"`{self.name}` contains no spec")
        )
        path = STDIN if self.name == STDIN_NAME else self.name
        help_ = f"name one of them, e.g. `{path}:{names[0]}`" if names else "declare one: `spec NAME { … }`"
        raise TltlError([Diagnostic("TLT0721", title, help=help_)])


def open_input(argument: str, settings: CompileSettings, specs: Sequence[str] = ()) -> Input:
    """Read and compile an argument, such as ``SPEC.tltl`` or ``SPEC.tltl:NAME``.

    ``specs`` are names of specs to compile; NAME is added to them. Without any name, all specs are
    compiled. If there are errors, raises TltlError with all diagnostics; their severities are those
    that the project file sets. Raises click.UsageError if the argument is a TOML file.
    """
    path, name = split(argument)
    if path.endswith(".toml"):
        message = f"`{path}` is not a spec; if it is a level, check it with `tltlc check --level {path}`"
        if path.endswith(GAME_SUFFIX):
            message = f"`{path}` is not a spec, but a game file; check it with `tltlc check --game {path}`"
        raise click.UsageError(message, click.get_current_context(silent=True))
    spec_names = (*specs, name) if name else tuple(specs)
    check_libraries(settings.libraries)
    project = project_for(path)
    try:
        source, is_artefact = read(path)
    except TltlError as error:
        from tltlc.interfaces.cli.spec_names import with_suggestion

        raise with_suggestion(error, path) from None
    if source.text.startswith("HOA:") or path.endswith(".hoa"):
        raise TltlError([_hoa_diagnostic(source)])
    if is_artefact:
        return _artefact_input(source, settings, spec_names, project)
    from tltlc.pipeline import Session

    session = Session(source, compile_settings(settings, project, spec_names))
    with project.apply_lint_levels():
        compiled = session.compiled()
    diagnostics = project.with_lint_levels(compiled.diagnostics)
    stop_at_errors(diagnostics)
    return Input(source.name, compiled.automata, session, project, diagnostics)


def check_text(source: SourceFile) -> None:
    """Check that a file contains a source text and not an automaton.

    Raise TltlError: TLT0722 for an artefact, TLT0652 for an automaton in the Hanoi format (HOA).
    """
    if source.text.startswith("HOA:"):
        raise TltlError([_hoa_diagnostic(source)])
    if source.text.lstrip().startswith("{") or source.name.endswith(ARTEFACT_ENDING):
        raise TltlError([artefact_error(source.name)])


def artefact_error(artefact: str) -> Diagnostic:
    """Return error TLT0722 for a command that needs a source text, but got ``artefact``, the name of an artefact."""
    title = f"`{artefact}` is an artefact: it contains an automaton and no source text"
    return Diagnostic("TLT0722", title, help="name the .tltl file that it was compiled from")


def _hoa_diagnostic(source: SourceFile) -> Diagnostic:
    title = f"`{source.name}` is an automaton in the Hanoi format, not a spec"
    path = STDIN if source.kind == "text" else source.name
    help_ = f"make an artefact of it with `tltlc import {path} --predicates LIB.tltl`"
    return Diagnostic("TLT0652", title, help=help_)


def _artefact_input(
    source: SourceFile, settings: CompileSettings, spec_names: tuple[str, ...], project: Project
) -> Input:
    from tltlc.pipeline import read_artefact, unknown_spec, with_params

    fspa = read_artefact(source)
    for name in spec_names:
        if name != fspa.name:
            raise TltlError([unknown_spec(name, [fspa.name], source.name)])
    return Input(source.name, (with_params(fspa, settings.params),), None, project, ())
