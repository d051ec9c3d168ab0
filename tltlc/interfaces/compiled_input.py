"""A source text or an artefact that is compiled with the settings of its project.

An artefact is an automaton that was compiled before, ``NAME.fspa.json``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError, stop_at_errors
from tltlc.io.project import Project
from tltlc.io.spec_file import ARTEFACT_ENDING, STDIN, STDIN_NAME

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.core.source import SourceFile
    from tltlc.pipeline import CompileOptions, Session
    from tltlc.resolve.spec import ResolvedFile
    from tltlc.tools.judge.clauses import Clauses
    from tltlc.tools.judge.failing_step import ClausePlace


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

    def clauses(self) -> Clauses:
        """Return the clauses of the only automaton. Errors: as for :meth:`only_automaton`."""
        from tltlc.pipeline import CompileOptions
        from tltlc.tools.judge.clauses import clauses_of

        fspa = self.only_automaton()
        specs = self.program.specs if self.program else ()
        spec = next((spec for spec in specs if spec.name == fspa.name), None)
        options = self.session.options if self.session else CompileOptions()
        return clauses_of(fspa, spec, options.state_budget)

    def clause_places(self) -> tuple[ClausePlace, ...]:
        """Return the places of the clauses in the source; none if the input is an artefact.

        Errors: as for :meth:`only_automaton`.
        """
        from tltlc.tools.judge.failing_step import ClausePlace

        name = self.only_automaton().name
        specs = self.program.specs if self.program else ()
        parts = next((spec.parts for spec in specs if spec.name == name), ())
        return tuple(ClausePlace(part.source.name, part.source.position(part.span.start)[0]) for part in parts)


def compile_input(source: SourceFile, *, is_artefact: bool, project: Project, options: CompileOptions) -> Input:
    """Compile a source text, or read an artefact.

    ``project`` sets the severities of diagnostics. An artefact is compiled already, so only the specs
    and the params of ``options`` matter for it. Raises TltlError with all diagnostics if there are
    errors, and with TLT0652 if the text is an automaton in the Hanoi format (HOA).
    """
    from tltlc.pipeline import Session

    if source.text.startswith("HOA:") or source.name.endswith(".hoa"):
        raise TltlError([_hoa_diagnostic(source)])
    if is_artefact:
        return _artefact_input(source, project, options)
    session = Session(source, options)
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


def _artefact_input(source: SourceFile, project: Project, options: CompileOptions) -> Input:
    from tltlc.pipeline import read_artefact, unknown_spec, with_params

    fspa = read_artefact(source)
    for name in options.specs:
        if name != fspa.name:
            raise TltlError([unknown_spec(name, [fspa.name], source.name)])
    return Input(source.name, (with_params(fspa, options.params),), None, project, ())
