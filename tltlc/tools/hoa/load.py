"""Load a HOA file and a library of predicates as an :class:`~tltlc.automaton.fspa.Fspa`."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
from tltlc.automaton.finite.machine import OutOfStates
from tltlc.automaton.fspa import Fspa, Text
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.infinite.assembly import assemble
from tltlc.automaton.work import DEFAULT_WORK, OutOfWork, Work
from tltlc.core.record import EMPTY, record
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.parser import parse_formula
from tltlc.io.files import MAX_ARTEFACT_BYTES, read_source
from tltlc.io.resources import resource_limits
from tltlc.io.spec_file import is_plain_name
from tltlc.logic.formula import Formula
from tltlc.logic.text.printer import ascii_text
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.resolution import FormulaOf
from tltlc.resolve.spec import JudgeMode
from tltlc.tools.hoa.atoms import vocabulary_of
from tltlc.tools.hoa.build import automaton_of
from tltlc.tools.hoa.checks import check, is_finite
from tltlc.tools.hoa.metadata import metadata
from tltlc.tools.hoa.reader import read_hoa
from tltlc.tools.hoa.tree import Hoa

if TYPE_CHECKING:
    import os


@record
class ImportOptions:
    """What :func:`load` needs besides a HOA file and a library.

    ``atoms`` maps the names of atomic propositions to predicates. A proposition that is not in
    ``atoms`` must itself have the name of a predicate. ``name`` is the name of the spec. If it is
    None, the name comes from the header ``name:`` if a spec can have this name, else from the name
    of the file. ``level``, ``limit_steps`` and ``judge`` are those of the spec. If one of them is
    None, its value comes from a header of the file, if there is one. ``resolve`` has the options for
    the library. The automaton may have at most ``state_budget`` states, and its computation may take
    at most ``work`` steps.
    """

    atoms: Mapping[str, str] = EMPTY
    name: str | None = None
    level: str | None = None
    limit_steps: int | None = None
    judge: JudgeMode | None = None
    resolve: ResolveOptions = ResolveOptions()
    state_budget: int = DEFAULT_STATE_BUDGET
    work: int = DEFAULT_WORK


def load(source: SourceFile, library: SourceFile, options: ImportOptions) -> tuple[Fspa, tuple[Diagnostic, ...]]:
    """Return the automaton of the HOA file ``source``, and warnings.

    The atomic propositions of the file become predicates of ``library``.

    Raises:
        TltlError: the errors of :func:`~tltlc.tools.hoa.reader.read_hoa`,
            :func:`~tltlc.tools.hoa.checks.check`, :func:`~tltlc.tools.hoa.atoms.vocabulary_of` and
            :func:`~tltlc.tools.hoa.build.automaton_of`; TLT0501 or TLT0502 if the automaton is too
            large; TLT0652 if a ``tltlc-`` header has a wrong value.
    """
    hoa = read_hoa(source)
    check(hoa)
    vocabulary, formula_of, warnings = vocabulary_of(hoa, library, options.atoms, options.resolve)
    names = [atom.name for atom in vocabulary.atoms]
    finite = is_finite(hoa)
    with recursion_room():
        try:
            automaton, analysis = automaton_of(
                hoa, names, vocabulary.exclusive, Work(options.work), options.state_budget
            )
            if len(automaton.steps) > options.state_budget:
                raise OutOfStates
            state_names = _state_names(hoa, automaton.labels)

            def label(state: int) -> Formula | Text:
                return _label(state_names[state], formula_of)

            places = {state.number: place for place, state in enumerate(hoa.states)}
            in_file_order = sorted(range(len(state_names)), key=lambda state: places[automaton.labels[state]])
            parts = assemble(automaton, analysis, names, vocabulary.exclusive, label, in_file_order)
        except (OutOfStates, OutOfWork, OutOfSteps, TooManyPrimes, RecursionError) as reason:
            raise TltlError([_too_large(source, reason, options)]) from None
    headers = metadata(hoa)
    title = headers.formula or (hoa.name.text if hoa.name and not is_plain_name(hoa.name.text) else state_names[0])
    fspa = Fspa(
        name=options.name or _name(hoa),
        doc="",
        formula=_label(title, formula_of),
        level=options.level or headers.level,
        limit_steps=options.limit_steps or headers.limit_steps,
        judge=options.judge or headers.judge or analysis.default_judge(),
        semantics="finite" if finite else "infinite",
        tags=(),
        clock_s=vocabulary.clock_s,
        clock_varies=vocabulary.clock_varies,
        registers=vocabulary.registers,
        signals=vocabulary.signals,
        params=vocabulary.params,
        atoms=vocabulary.atoms,
        exclusive=vocabulary.exclusive,
        states=parts.states,
        edges=parts.edges,
        spec_size=parts.spec_size,
        acceptance=parts.acceptance,
    )
    return fspa, (*warnings, *_trivial_warnings(fspa, source))


def _trivial_warnings(fspa: Fspa, source: SourceFile) -> tuple[Diagnostic, ...]:
    """Return a warning if the automaton accepts every trace, or no trace."""
    if fspa.states[0].verdict == "violated":
        title, help_ = f"`{source.name}` accepts no trace", "check its acceptance, and which atoms are `exclusive`"
        return (Diagnostic("TLT0410", title, help=help_, severity="warning"),)
    if fspa.states[0].verdict == "satisfied":
        title, help_ = (
            f"`{source.name}` accepts every trace",
            "check its acceptance: it requires nothing of the game",
        )
        return (Diagnostic("TLT0411", title, help=help_, severity="warning"),)
    return ()


def _name(hoa: Hoa) -> str:
    """Return the name of the automaton in the file if a spec can have this name, else one made from the file name."""
    if hoa.name and is_plain_name(hoa.name.text):
        return hoa.name.text
    if hoa.source.kind == "text":
        return "automaton"
    stem = re.sub("[^A-Za-z0-9_]+", "_", PurePath(hoa.source.name).stem).strip("_")
    return stem if is_plain_name(stem) else f"automaton_{stem}".rstrip("_")


def _state_names(hoa: Hoa, numbers: Sequence[int]) -> list[str]:
    """Return a name for each state of the automaton: the name in the file, or ``state 3``.

    ``numbers`` has, for each state of the automaton, the number of the state in the file from which
    it comes. If several come from the same state of the file, they are counted: ``state 3 (1 of 2)``.
    """
    names = {state.number: state.name or f"state {state.number}" for state in hoa.states}
    totals, counts = Counter(numbers), Counter[int]()
    state_names = []
    for number in numbers:
        counts[number] += 1
        suffix = f" ({counts[number]} of {totals[number]})" if totals[number] > 1 else ""
        state_names.append(names[number] + suffix)
    return state_names


def _label(name: str, formula_of: FormulaOf) -> Formula | Text:
    """Return the name of a state or automaton as a formula if possible, else as text.

    The name counts as a formula only if it parses, and if the formula is printed exactly like it.
    """
    expression, _ = parse_formula(SourceFile("<name>", name, "text"))
    formula = None if expression is None else formula_of(expression)
    # Compare, because the tool that wrote the name may give its operators other precedences.
    if formula is not None and ascii_text(formula) == name:
        return formula
    return Text(name.encode("ascii", "backslashreplace").decode(), name, name)


def _too_large(source: SourceFile, reason: Exception, options: ImportOptions) -> Diagnostic:
    if isinstance(reason, TooManyPrimes):
        help_ = "declare the condition as a predicate, and use the predicate in the automaton"
        return Diagnostic("TLT0502", reason.title(source.name), help=help_)
    if isinstance(reason, OutOfStates):
        title = f"the automaton of `{source.name}` needs more than {options.state_budget} states"
        return Diagnostic("TLT0501", title, help="use a smaller one, or allow more with `--state-budget`")
    title = f"the automaton of `{source.name}` is too large, or its acceptance is too large for Rabin pairs"
    return Diagnostic("TLT0501", title, help="use one with parity acceptance, e.g. from Spot: `autfilt --parity -D -C`")


@resource_limits()
def load_hoa(
    path: str | os.PathLike[str], predicates: str | os.PathLike[str], options: ImportOptions | None = None
) -> Fspa:
    """Return the automaton of the HOA file at ``path``.

    ``predicates`` is the path of a tltl file, and the atomic propositions of the automaton must be
    predicates of that file.

    Raises :class:`TltlError` if one of the files cannot be read, the automaton is not deterministic
    or not complete, or a proposition is not a predicate.

    >>> import tltlc, tempfile, pathlib
    >>> from tltlc.backends import emit
    >>> text = "signal a: bool  spec again { semantics infinite  require G F a }"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     library, file = pathlib.Path(folder, "again.tltl"), pathlib.Path(folder, "again.hoa")
    ...     _ = library.write_text(text)
    ...     _ = file.write_text(emit("hoa", *tltlc.compile_file(library))["again.hoa"])
    ...     fspa = tltlc.load_hoa(file, library)
    >>> len(fspa.states), len(fspa.acceptance)
    (1, 1)
    """
    source = read_source(path, max_bytes=MAX_ARTEFACT_BYTES)
    fspa, _ = load(source, read_source(predicates), options or ImportOptions())
    return fspa
