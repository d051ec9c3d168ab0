"""Resolve the atomic propositions of a HOA file to predicates of a library."""

from __future__ import annotations

from collections.abc import Mapping

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError, stop_at_errors
from tltlc.grammar.parser import parse
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.resolution import FormulaOf, resolve_atoms
from tltlc.resolve.spec import Vocabulary
from tltlc.tools.hoa.tree import Hoa


def vocabulary_of(
    hoa: Hoa, library: SourceFile, predicates: Mapping[str, str], options: ResolveOptions
) -> tuple[Vocabulary, FormulaOf, tuple[Diagnostic, ...]]:
    """Return the atoms of a HOA file in order, a function that resolves formulas, and warnings.

    ``predicates`` maps the names of propositions to predicates of the library. The names of other
    propositions must be predicates themselves. The function resolves a syntax tree over the library
    to a formula, or to None.

    Raises:
        TltlError: the errors of the library; TLT0655 if a proposition is not an atom or is the same
            atom as another proposition, or if ``predicates`` has a proposition that the file does not
            have; any other error in the formula of a proposition.
    """
    module, diagnostics = parse(library)
    stop_at_errors(diagnostics)
    predicates = _by_proposition(hoa, predicates)
    sources = [
        SourceFile(f"--atom {atom.text}", predicates[atom.text])
        if atom.text in predicates
        # Each atom has a source name of its own: with the name of the file, equal messages would be merged.
        else SourceFile(f"{hoa.source.name}:{atom.span.start}", hoa.source.slice(atom.span))
        for atom in hoa.atoms
    ]
    vocabulary, formula_of, atom_diagnostics = resolve_atoms(module, sources, options)
    starts = {
        source.name: atom.span.start
        for source, atom in zip(sources, hoa.atoms, strict=True)
        if atom.text not in predicates
    }
    diagnostics += tuple(_with_places_in_file(diagnostic, starts, hoa.source) for diagnostic in atom_diagnostics)
    stop_at_errors(diagnostics)
    assert vocabulary is not None
    return vocabulary, formula_of, diagnostics


def _by_proposition(hoa: Hoa, options: Mapping[str, str]) -> dict[str, str]:
    """Return a dict from the names of propositions in the file to predicates.

    The command line splits ``NAME=PREDICATE`` at the first ``=``, but a name may contain ``=``. So
    this takes the longest name of a proposition that matches.
    """
    names = {atom.text for atom in hoa.atoms}
    by_proposition: dict[str, str] = {}
    for key, value in options.items():
        whole = f"{key}={value}"
        matches = [name for name in names if whole.startswith(f"{name}=")]
        if not matches:
            raise TltlError([_unknown(hoa, key)])
        name = max(matches, key=len)
        by_proposition[name] = whole[len(name) + 1 :]
    return by_proposition


def _unknown(hoa: Hoa, name: str) -> Diagnostic:
    from difflib import get_close_matches

    names = [atom.text for atom in hoa.atoms]
    close = get_close_matches(name, names, n=1)
    name_list = ", ".join(f"`{name}`" for name in names[:10]) or "none"
    help_ = f"did you mean `{close[0]}`?" if close else f"the file has {name_list}"
    return Diagnostic("TLT0655", f"`{hoa.source.name}` has no atomic proposition `{name}`", help=help_)


def _with_places_in_file(message: Diagnostic, starts: Mapping[str, int], source: SourceFile) -> Diagnostic:
    """Return a diagnostic about the name of a proposition with its labels moved into the file.

    ``starts`` maps the name of the source of each proposition to the offset in the file at which the
    proposition begins.
    """
    if not message.labels or message.labels[0].source.name not in starts:
        return message

    def place_in_file(label: Label) -> Label:
        start = starts.get(label.source.name)
        if start is None:
            return label
        return replace(label, source=source, span=Span(label.span.start + start, label.span.end + start))

    mapped = f'say which predicate it is: `--atom "{message.labels[0].source.text.strip()}=…"`'
    # Only these help texts fit a proposition; others are for the author of a formula.
    own_help = message.help if message.code in ("TLT0201", "TLT0655") else None
    help_ = f"{own_help}; or {mapped}" if own_help else mapped
    return replace(message, labels=tuple(map(place_in_file, message.labels)), help=help_)
