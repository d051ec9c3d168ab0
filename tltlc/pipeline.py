"""Compile a source text to automata in three stages: parse, resolve names, build automata.

A :class:`Session` runs the stages for one text. A stage does not stop at its first error, but
reports all its diagnostics. Automata are built only if the stages before have no errors.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

from tltlc.automaton.broken_clauses import with_broken_clauses
from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET, build
from tltlc.automaton.verdict_warnings import verdict_warnings
from tltlc.core.record import EMPTY, record, replace
from tltlc.core.source import SourceFile, SourceKind
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError, stop_at_errors
from tltlc.grammar.allow_index import drop_silenced
from tltlc.grammar.parser import parse
from tltlc.io.files import MAX_ARTEFACT_BYTES, read_source
from tltlc.io.resources import resource_limits
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.resolution import Resolution, resolve

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from tltlc.automaton.fspa import Fspa
    from tltlc.grammar.module import Module
    from tltlc.resolve.spec import ResolvedFile, Spec

_TEXT_NAME: Final = "<text>"
"""The name, in messages, of a text that has no name."""


@record
class CompileOptions:
    """Options of the compiler.

    ``library_dirs`` are searched for imports, after the folder of the file itself. ``params`` maps
    names of params to values that replace those in the text, written as in the language
    (``{"level_size": "30 m"}``). ``state_budget`` is the most states that the construction of an
    automaton may explore; for a spec over infinite traces, a number of steps proportional to it is
    the limit instead. ``specs`` has the names of the specs to build; if it is empty, all are built.
    ``unfolded`` has the names of specs in which each bound becomes states, however many these are.
    """

    library_dirs: tuple[Path, ...] = ()
    params: Mapping[str, str] = EMPTY
    state_budget: int = DEFAULT_STATE_BUDGET
    specs: tuple[str, ...] = ()
    unfolded: tuple[str, ...] = ()


@record
class Compiled:
    """A compiled source text: its ``program`` (specs and tests), its ``automata``, and its ``diagnostics``.

    ``automata`` are in the order of the specs. ``diagnostics`` has the warnings and notes that no
    comment in the text silences.
    """

    program: ResolvedFile
    automata: tuple[Fspa, ...]
    diagnostics: tuple[Diagnostic, ...]


class Session:
    """A source text and the results of each stage of the compiler.

    A stage runs when its result is first needed, and only once. ``module``, ``syntax_errors``,
    ``resolution`` and ``source_diagnostics`` work for any text: they leave out the parts with
    errors. All other properties raise a :class:`TltlError` if parsing or resolving has errors, and
    ``automata`` also if an automaton cannot be built. If ``proofs`` is false, the session does not
    prove that the values of predicates stay in their ranges: the proofs take longer than everything
    else.

    >>> session = Session(SourceFile("hide.tltl", "signal seen: bool  spec hide = G !seen"))
    >>> [spec.name for spec in session.specs], [len(fspa.states) for fspa in session.automata]
    (['hide'], [2])
    """

    def __init__(self, source: SourceFile, options: CompileOptions | None = None, *, proofs: bool = True) -> None:
        self.source = source
        self.options = options or CompileOptions()
        self._proofs = proofs

    @property
    def module(self) -> Module:
        """The syntax tree of the text, without the declarations and clauses that have syntax errors."""
        return self._parsed[0]

    @property
    def syntax_errors(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of the parser."""
        return self._parsed[1]

    @cached_property
    def resolution(self) -> Resolution:
        """The names, specs and tests of the declarations in :attr:`module` and in the files that they import."""
        options = self.options
        settings = ResolveOptions(options.library_dirs, options.params, self._proofs, options.unfolded)
        return resolve(self.module, settings)

    @property
    def source_diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of parsing and resolving, including those that comments silence."""
        return self.syntax_errors + self.resolution.diagnostics

    @cached_property
    def program(self) -> ResolvedFile:
        """The specs and tests of the source text, with all names resolved.

        Errors: :class:`TltlError` with the diagnostics of parsing and resolving. If the text has syntax
        errors, those of resolving are only the errors that cannot be consequences of them.
        """
        if any(diagnostic.severity == "error" for diagnostic in self.syntax_errors):
            from tltlc.resolve.follow_up_errors import independent_errors

            raise TltlError(independent_errors(self.module, self.syntax_errors, self.resolution.diagnostics))
        stop_at_errors(self._unsilenced(self.source_diagnostics))
        return self.resolution.program

    @cached_property
    def specs(self) -> tuple[Spec, ...]:
        """The specs that :attr:`CompileOptions.specs` names, or all specs, in the order of the text.

        Errors: as for :attr:`program`; TLT0720 if the options name a spec that does not exist.
        """
        return pick_specs(self.program.specs, self.options.specs, self.source.name)

    @cached_property
    def reported(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of all stages, including those that comments silence.

        They include the errors of automata that cannot be built. Raises what :attr:`specs` raises.
        """
        # Raise the errors of parsing and resolving before automata are built.
        built = self._built
        return self.source_diagnostics + tuple(diagnostic for _, warnings in built for diagnostic in warnings)

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics in :attr:`reported`, without those that comments silence. Errors: as for :attr:`specs`."""
        return self._unsilenced(self.reported)

    @property
    def automata(self) -> tuple[Fspa, ...]:
        """The automata of :attr:`specs`, in the same order.

        Errors: :class:`TltlError` with the diagnostics of all stages up to the one that failed; TLT0720
        if the options name a spec that does not exist.
        """
        stop_at_errors(self.diagnostics)
        return tuple(fspa for fspa, _ in self._built if fspa is not None)

    @resource_limits()
    def compiled(self) -> Compiled:
        """Return the result of all stages. Errors: as for :attr:`automata`."""
        automata = self.automata
        return Compiled(self.program, automata, self.diagnostics)

    def without_timers(self, spec: str) -> Fspa:
        """Return the automaton of the spec with this name, in which states take the place of timers.

        Errors: as for :attr:`automata`; TLT0501 if this needs too many states.
        """
        options = replace(self.options, specs=(spec,), unfolded=(spec,))
        (fspa,) = Session(self.source, options, proofs=False).automata
        return fspa

    @cached_property
    def _parsed(self) -> tuple[Module, tuple[Diagnostic, ...]]:
        return parse(self.source)

    @cached_property
    def _built(self) -> tuple[tuple[Fspa | None, tuple[Diagnostic, ...]], ...]:
        """For each spec, its automaton and the warnings; or None and the errors if it cannot be built."""
        return tuple(build_spec(spec, self.options) for spec in self.specs)

    def _unsilenced(self, diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
        return drop_silenced((loaded.module for loaded in self.resolution.modules), diagnostics)


def compile_source(source: SourceFile, options: CompileOptions | None = None) -> Compiled:
    """Compile all specs of a source text, or those that :attr:`CompileOptions.specs` names.

    Errors: :class:`TltlError` with the diagnostics of all stages up to the one that failed; TLT0720 if
    the options name a spec that does not exist.
    """
    return Session(source, options).compiled()


def build_spec(spec: Spec, options: CompileOptions) -> tuple[Fspa | None, tuple[Diagnostic, ...]]:
    """Return the automaton of a spec and the warnings; or None and the errors if it cannot be built."""
    try:
        if spec.semantics == "infinite":
            from tltlc.automaton.infinite.build import build_infinite

            fspa = build_infinite(spec, state_budget=options.state_budget)
        else:
            fspa = build(spec, state_budget=options.state_budget)
    except TltlError as error:
        return None, error.diagnostics
    return with_broken_clauses(fspa, spec, options.state_budget), verdict_warnings(spec, fspa)


def pick_specs(specs: tuple[Spec, ...], names: tuple[str, ...], file: str) -> tuple[Spec, ...]:
    """Return the specs with these names in the order of ``specs``; all specs if ``names`` is empty.

    ``file`` is the name of the file in messages. Errors: TLT0720 for a name that no spec has.
    """
    known = [spec.name for spec in specs]
    for name in names:
        if name not in known:
            raise TltlError([unknown_spec(name, known, file)])
    return tuple(spec for spec in specs if not names or spec.name in names)


def unknown_spec(name: str, known: list[str], file: str) -> Diagnostic:
    """Return the error TLT0720 for a name that no spec of the file has.

    ``known`` are the names of the specs in the file.
    """
    from difflib import get_close_matches

    close = get_close_matches(name, known, n=1)
    listed = ", ".join(f"`{spec}`" for spec in known[:10]) + (", …" if len(known) > 10 else "")
    suggestion = f"did you mean `{close[0]}`?" if close else f"it contains {listed}" if known else "it contains no spec"
    return Diagnostic("TLT0720", f"`{file}` has no spec `{name}`", help=suggestion)


def compile_text(text: str, name: str = _TEXT_NAME, options: CompileOptions | None = None) -> tuple[Fspa, ...]:
    """Return the automata of the specs of a text, in order.

    ``name`` is the name of the text in messages. If ``name`` is a path, the text can import files from
    the folder of the path. Errors: :class:`TltlError`.

    >>> import tltlc
    >>> fspa, = tltlc.compile_text("signal seen: bool  spec hide = G !seen")
    >>> fspa.name, len(fspa.states), fspa.judge
    ('hide', 2, 'limit')
    >>> options = tltlc.CompileOptions(params={"most": "30 %"})
    >>> fspa, = tltlc.compile_text("signal n: ratio  param most: ratio = 10 %  spec hush = G n < most", options=options)
    >>> [param.value for param in fspa.params]
    [0.3]
    >>> tltlc.compile_text("spec hide = G !seem  signal seen: bool")
    Traceback (most recent call last):
    ...
    tltlc.diagnostics.diagnostic.TltlError: TLT0201: no predicate `seem` here
    """
    kind: SourceKind = "text" if name == _TEXT_NAME else "file"
    return compile_source(SourceFile(name, text, kind), options).automata


def compile_file(path: str | os.PathLike[str], options: CompileOptions | None = None) -> tuple[Fspa, ...]:
    """Return the automata of the specs of a file, in order.

    Errors: :class:`TltlError`, with one of the codes TLT0001 to TLT0004 if the file cannot be read as
    text.

    >>> import tltlc
    >>> fspa, = tltlc.compile_file("examples/cover_and_hide.tltl")
    >>> fspa.spec_size
    3
    """
    return compile_source(read_source(path), options).automata


@resource_limits()
def load(path: str | os.PathLike[str]) -> Fspa:
    """Return the automaton in an artefact, a file ``NAME.fspa.json`` that ``tltlc compile`` wrote.

    Errors: :class:`TltlError` if the file cannot be read, is not an artefact, or contradicts
    itself.

    >>> import tltlc, tempfile, pathlib
    >>> from tltlc.backends import emit
    >>> fspa, = tltlc.compile_text("signal seen: bool  spec hide = G !seen")
    >>> (name, text), = emit("json", fspa).items()
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, name)
    ...     _ = path.write_bytes(text.encode() if isinstance(text, str) else text)
    ...     tltlc.load(path) == fspa
    True
    """
    return read_artefact(read_source(path, max_bytes=MAX_ARTEFACT_BYTES))


@resource_limits()
def read_artefact(source: SourceFile) -> Fspa:
    """Return the automaton in the text of an artefact. Errors: as for :func:`load`."""
    from tltlc.artefact.decode import read

    return read(source)


@resource_limits()
def decode_artefact(document: object, name: str) -> Fspa:
    """Return the automaton in the parsed JSON of an artefact.

    ``document`` is what :func:`tltlc.io.json_text.loads` returns, and ``name`` the name of the
    artefact in messages. Errors: TLT0006, and TLT0601 to TLT0604.
    """
    from tltlc.artefact.decode import decode

    return decode(document, name)


def encode_artefact(fspa: Fspa) -> dict[str, Any]:
    """Return the artefact of an automaton as JSON data, for a file that also contains other things.

    Errors: TLT0004 and TLT0006 if the artefact would be too large to be read again.
    """
    from tltlc.backends.json import document_and_text

    return document_and_text(fspa)[0]


def with_params(fspa: Fspa, values: Mapping[str, str]) -> Fspa:
    """Return the automaton with new values for some of its params.

    ``values`` maps names of params to values as the language writes them, such as
    ``{"level_size": "30 m"}``.

    Errors: TLT0307 if a value lies outside the range of its param; TLT0308 if there is no param with
    this name, or if a text is no value for the param.
    """
    if not values:
        return fspa
    from tltlc.resolve.overrides import apply_overrides

    params, errors = apply_overrides({param.name: param for param in fspa.params}, values)
    stop_at_errors(errors)
    return replace(fspa, params=tuple(params.values()))
