"""From the text of a HOA file and a library of predicates to an :class:`~tltlc.automaton.fspa.Fspa`."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
from tltlc.automaton.finite.build import text_of as finite_text
from tltlc.automaton.finite.machine import OutOfStates
from tltlc.automaton.fspa import Fspa, Text
from tltlc.automaton.guards import TooManyPrimes
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.parser import parse_formula
from tltlc.tools.hoa.atoms import vocabulary_of
from tltlc.tools.hoa.build import automaton_of
from tltlc.tools.hoa.checks import check, is_finite
from tltlc.tools.hoa.metadata import metadata
from tltlc.tools.hoa.reader import read
from tltlc.tools.hoa.tree import Hoa

if TYPE_CHECKING:
    import os
from tltlc.automaton.infinite.assembly import assembled
from tltlc.automaton.infinite.readback import text_of as infinite_text
from tltlc.automaton.infinite.work import DEFAULT_WORK, OutOfWork, Work
from tltlc.core.record import EMPTY, record
from tltlc.core.source import SourceFile
from tltlc.io.files import MAX_ARTEFACT_BYTES, read_source
from tltlc.io.resources import bounded
from tltlc.io.spec_file import STDIN_NAME, is_plain_name
from tltlc.logic.text.printer import ascii_text
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import FormulaOf
from tltlc.resolve.spec import Judge


@record
class ImportOptions:
    """What a HOA file does not say.

    ``atoms`` gives predicates for atomic propositions, by their names; others are predicates as they stand.  ``name``
    is that of the spec, by default the file's ``name:`` where that is a word, else the name of the file.  The other
    fields are as of :class:`~tltlc.resolve.spec.Spec` and of :class:`~tltlc.resolve.options.ResolveOptions`.
    """

    atoms: Mapping[str, str] = EMPTY
    name: str | None = None
    level: str | None = None
    limit_steps: int | None = None
    judge: Judge | None = None
    resolve: ResolveOptions = ResolveOptions()
    state_budget: int = DEFAULT_STATE_BUDGET
    work: int = DEFAULT_WORK


def load(source: SourceFile, library: SourceFile, options: ImportOptions) -> tuple[Fspa, tuple[Diagnostic, ...]]:
    """The automaton of a HOA file, whose atomic propositions are predicates of ``library``; and warnings.

    Raises:
        TltlError: all that :func:`~tltlc.tools.hoa.reader.read`, :func:`~tltlc.tools.hoa.checks.check` and
            :func:`~tltlc.tools.hoa.build.automaton_of` raise; what is wrong with the library or a predicate; TLT0655, a
            proposition is no atom, or the same as another one; TLT0501 and TLT0502, the automaton becomes too large.
    """
    hoa = read(source)
    check(hoa)
    words, formula_of, found = vocabulary_of(hoa, library, options.atoms, options.resolve)
    names = [atom.name for atom in words.atoms]
    finite = is_finite(hoa)
    with recursion_room():
        try:
            automaton, analysis = automaton_of(hoa, names, words.exclusive, Work(options.work), options.state_budget)
            if len(automaton.steps) > options.state_budget:
                raise OutOfStates
            called = _called(hoa, automaton.labels)

            def text(state: int) -> Text:
                return _text(called[state], formula_of, finite=finite)

            places = {state.number: place for place, state in enumerate(hoa.states)}
            in_file = sorted(range(len(called)), key=lambda state: places[automaton.labels[state]])
            parts = assembled(automaton, analysis, names, words.exclusive, text, in_file)
        except (OutOfStates, OutOfWork, OutOfSteps, TooManyPrimes, RecursionError) as reason:
            raise TltlError([_too_large(source, reason, options)]) from None
    own = metadata(hoa)
    title = own.formula or (hoa.name.text if hoa.name and not is_plain_name(hoa.name.text) else called[0])
    fspa = Fspa(
        name=options.name or _name(hoa),
        doc="",
        formula=_text(title, formula_of, finite=finite),
        level=options.level or own.level,
        limit_steps=options.limit_steps or own.limit_steps,
        judge=options.judge or own.judge or analysis.default_judge(),
        semantics="finite" if finite else "infinite",
        tags=(),
        clock_s=words.clock_s,
        signals=words.signals,
        params=words.params,
        atoms=words.atoms,
        exclusive=words.exclusive,
        states=parts.states,
        edges=parts.edges,
        spec_size=parts.spec_size,
        acceptance=parts.acceptance,
    )
    return fspa, (*found, *_decided(fspa, source))


def _decided(fspa: Fspa, source: SourceFile) -> tuple[Diagnostic, ...]:
    """A warning where every trace is accepted, or no trace is."""
    if fspa.states[0].verdict == "violated":
        title, way_out = f"`{source.name}` accepts no trace", "look at its acceptance, and at what is `exclusive`"
        return (Diagnostic("TLT0410", title, help=way_out, severity="warning"),)
    if fspa.states[0].verdict == "satisfied":
        title, way_out = f"`{source.name}` accepts every trace", "look at its acceptance: it asks nothing of the game"
        return (Diagnostic("TLT0411", title, help=way_out, severity="warning"),)
    return ()


def _name(hoa: Hoa) -> str:
    """A word for the automaton: what it is called, or what its file is."""
    if hoa.name and is_plain_name(hoa.name.text):
        return hoa.name.text
    if hoa.source.name == STDIN_NAME:
        return "automaton"
    stem = re.sub("[^A-Za-z0-9_]+", "_", PurePath(hoa.source.name).stem).strip("_")
    return stem if is_plain_name(stem) else f"automaton_{stem}".rstrip("_")


def _called(hoa: Hoa, numbers: Sequence[int]) -> list[str]:
    """What states are called that come from those of these numbers, counted where one became several."""
    names = {state.number: state.name or f"state {state.number}" for state in hoa.states}
    several, met = Counter(numbers), Counter[int]()
    found = []
    for number in numbers:
        met[number] += 1
        count = f" ({met[number]} of {several[number]})" if several[number] > 1 else ""
        found.append(names[number] + count)
    return found


def _text(words: str, formula_of: FormulaOf, *, finite: bool) -> Text:
    """What a state is called, in three notations where that is a formula as tltlc writes it, else as it stands."""
    expression, _ = parse_formula(SourceFile("<name>", words))
    formula = None if expression is None else formula_of(expression)
    # Other tools' operators may bind otherwise.
    if formula is not None and ascii_text(formula) == words:
        return finite_text(formula) if finite else infinite_text(formula)
    return Text(words.encode("ascii", "backslashreplace").decode(), words, words)


def _too_large(source: SourceFile, reason: Exception, options: ImportOptions) -> Diagnostic:
    if isinstance(reason, TooManyPrimes):
        help_ = "name the condition as a predicate, and use that in the automaton"
        return Diagnostic("TLT0502", reason.title(source.name), help=help_)
    if isinstance(reason, OutOfStates):
        title = f"the automaton of `{source.name}` needs more than {options.state_budget} states"
        return Diagnostic("TLT0501", title, help="give a smaller one, or allow more by `--state-budget`")
    title = f"the automaton of `{source.name}` is too large, or its acceptance for Rabin pairs"
    return Diagnostic("TLT0501", title, help="give one with parity acceptance, e.g. by Spot: `autfilt --parity -D -C`")


@bounded()
def load_hoa(
    path: str | os.PathLike[str], predicates: str | os.PathLike[str], options: ImportOptions | None = None
) -> Fspa:
    """The automaton of a HOA file whose atomic propositions are predicates of the library ``predicates``.

    Errors: :class:`TltlError` where one of the files cannot be read, the automaton is not deterministic or not
    complete, or a proposition is no predicate.

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
