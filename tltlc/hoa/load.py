"""From the text of a HOA file and a library of predicates to an :class:`~tltlc.automaton.fspa.Fspa`."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import Final

from tltlc.automaton.blowup import recursion_room
from tltlc.automaton.build import DEFAULT_STATE_BUDGET, text_of
from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.fspa import Fspa, Text
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.machine import OutOfStates
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.grammar.parser import parse, parse_formula
from tltlc.grammar.tree import Expr
from tltlc.hoa.build import automaton_of
from tltlc.hoa.checks import check, is_finite
from tltlc.hoa.reader import read
from tltlc.hoa.tree import Hoa
from tltlc.logic.printer import ascii_text
from tltlc.rabin.assembly import assembled
from tltlc.rabin.work import OutOfWork, Work
from tltlc.record import EMPTY, record, replace
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import FormulaOf, resolve_atoms
from tltlc.resolve.spec import Judge, Vocabulary
from tltlc.source import SourceFile
from tltlc.spec_file import STDIN_NAME, is_plain_name

DEFAULT_WORK: Final = 20_000_000
"""Steps, each about a microsecond, that an import may take."""


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
        TltlError: all that :func:`~tltlc.hoa.reader.read`, :func:`~tltlc.hoa.checks.check` and
            :func:`~tltlc.hoa.build.automaton_of` raise; what is wrong with the library or a predicate; TLT0655, a
            proposition is no atom, or the same as another one; TLT0501 and TLT0502, the automaton becomes too large.
    """
    hoa = read(source)
    check(hoa)
    words, formula_of, found = _vocabulary(hoa, library, options)
    names = [atom.name for atom in words.atoms]
    with recursion_room():
        try:
            automaton, analysis = automaton_of(hoa, names, words.exclusive, Work(options.work))
            if len(automaton.steps) > options.state_budget:
                raise OutOfStates
            names_of = {state.number: state.name for state in hoa.states}

            def text(state: int) -> Text:
                number = automaton.labels[state]
                return _text(names_of[number] or f"state {number}", formula_of)

            parts = assembled(automaton, analysis, names, words.exclusive, text)
        except (OutOfStates, OutOfWork, OutOfSteps, TooManyPrimes, RecursionError) as reason:
            raise TltlError([_too_large(source, reason, options)]) from None
    title = hoa.name.text if hoa.name and not is_plain_name(hoa.name.text) else parts.states[0].label.ascii
    fspa = Fspa(
        name=options.name or _name(hoa),
        doc="",
        formula=_text(title, formula_of),
        level=options.level,
        limit_steps=options.limit_steps,
        judge=options.judge or analysis.default_judge(),
        semantics="finite" if is_finite(hoa) else "infinite",
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
    """A warning for an automaton that accepts all traces, or none."""
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


def _text(words: str, formula_of: FormulaOf) -> Text:
    """What a state is called, in three notations where that is a formula as tltlc writes it, else as it stands."""
    expression, _ = parse_formula(SourceFile("<name>", words))
    formula = None if expression is None else formula_of(expression)
    # Other tools' operators may bind otherwise.
    if formula is not None and ascii_text(formula) == words:
        return text_of(formula)
    return Text(words.encode("ascii", "backslashreplace").decode(), words, words)


def _too_large(source: SourceFile, reason: Exception, options: ImportOptions) -> Diagnostic:
    if isinstance(reason, TooManyPrimes):
        title = f"{reason.whose} of `{source.name}` needs more than {reason.limit} prime implicants"
        return Diagnostic("TLT0502", title, help="name the condition as a predicate, and use that in the automaton")
    if isinstance(reason, OutOfStates):
        title = f"the automaton of `{source.name}` needs more than {options.state_budget} states"
        return Diagnostic("TLT0501", title, help="give a smaller one, or allow more by `--state-budget`")
    title = f"the automaton of `{source.name}` is too large, or its acceptance for Rabin pairs"
    return Diagnostic("TLT0501", title, help="give a smaller one, e.g. by Spot's `autfilt --small -G -D -C`")


# --- atoms ----------------------------------------------------------------------------------------


def _vocabulary(
    hoa: Hoa, library: SourceFile, options: ImportOptions
) -> tuple[Vocabulary, FormulaOf, tuple[Diagnostic, ...]]:
    module, found = parse(library)
    _stop_at_errors(found)
    _check_given(hoa, options.atoms)
    written: list[tuple[Expr, SourceFile]] = []
    names: list[SourceFile] = []
    for atom in hoa.atoms:
        given = options.atoms.get(atom.text)
        # Blanks up to the name, so that places are those in the file.
        names.append(SourceFile(hoa.source.name, " " * atom.span.start + hoa.source.slice(atom.span)))
        source = names[-1] if given is None else SourceFile(f"--atom {atom.text}", given)
        expression, problems = parse_formula(source)
        found += problems
        if expression is not None:
            written.append((expression, source))
    found = _in_file(found, names, hoa.source)
    _stop_at_errors(found)
    words, formula_of, more = resolve_atoms(module, written, options.resolve)
    found += _in_file(more, names, hoa.source)
    _stop_at_errors(found)
    assert words is not None
    return words, formula_of, found


def _in_file(found: Sequence[Diagnostic], names: Sequence[SourceFile], source: SourceFile) -> tuple[Diagnostic, ...]:
    """Messages that speak of a name in the file alone, speaking of the whole file."""

    def placed(label: Label) -> Label:
        return replace(label, source=source) if label.source in names else label

    def shown(each: Diagnostic) -> Diagnostic:
        way_out = each.help
        if each.code == "TLT0201" and each.labels[0].source in names:
            name = each.labels[0].source.text.strip()
            way_out = f'{way_out}; or say which predicate it is: `--atom "{name}=…"`'
        return replace(each, labels=tuple(map(placed, each.labels)), help=way_out)

    return tuple(map(shown, found))


def _check_given(hoa: Hoa, given: Mapping[str, str]) -> None:
    names = [atom.text for atom in hoa.atoms]
    for name in given:
        if name not in names:
            from difflib import get_close_matches

            close = get_close_matches(name, names, n=1)
            listed = ", ".join(f"`{each}`" for each in names[:10]) or "none"
            way_out = f"did you mean `{close[0]}`?" if close else f"the file has {listed}"
            title = f"`{hoa.source.name}` has no atomic proposition `{name}`"
            raise TltlError([Diagnostic("TLT0655", title, help=way_out)])


def _stop_at_errors(found: Sequence[Diagnostic]) -> None:
    if any(diagnostic.severity == "error" for diagnostic in found):
        raise TltlError(found)
