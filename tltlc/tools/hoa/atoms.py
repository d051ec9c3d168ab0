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

    ``library`` is a source text that declares predicates. ``predicates`` maps the names of
    propositions in the file to predicates of the library, such as ``near(exit)``. A proposition that
    is not in ``predicates`` must itself have the name of a predicate. The returned function takes a
    syntax tree. It returns the formula, or None if the tree is not a formula over the library.

    Raises:
        TltlError: the errors of the library and of the predicates; TLT0655 if a proposition is not
            an atom, if two propositions are the same atom, or if ``predicates`` names a proposition
            that the file does not have.
    """
    module, diagnostics = parse(library)
    stop_at_errors(diagnostics)
    predicates = _by_proposition(hoa, predicates)
    sources = [
        SourceFile(f"--atom {atom.text}", predicates[atom.text], "text")
        if atom.text in predicates
        # Each atom has a source name of its own: with the name of the file, equal messages would be merged.
        else SourceFile(f"{hoa.source.name}:{atom.span.start}", hoa.source.slice(atom.span), "text")
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

    ``options`` has the two parts of each ``--atom NAME=PREDICATE``, which the command line splits
    at the first ``=``. But a name may contain ``=`` itself. So this function joins the two parts to
    one text again, and splits it after the longest name in the file with which it begins.

    Raises TltlError, TLT0655, if the text begins with no name in the file.
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
    """Return a diagnostic about a proposition, with labels that point into the HOA file.

    Each proposition was parsed as a separate source. ``starts`` maps the names of these sources to
    the offsets at which the propositions begin in the HOA file ``source``. The help of the result
    mentions ``--atom``. A diagnostic about anything else is returned unchanged.
    """
    if not message.labels or message.labels[0].source.name not in starts:
        return message

    def place_in_file(label: Label) -> Label:
        start = starts.get(label.source.name)
        if start is None:
            return label
        return replace(label, source=source, span=Span(label.span.start + start, label.span.end + start))

    mapped = f'say which predicate it is: `--atom "{message.labels[0].source.text.strip()}=…"`'
    # Only the help texts of these codes fit a proposition; the rest are for the author of a
    # formula.
    own_help = message.help if message.code in ("TLT0201", "TLT0655") else None
    help_ = f"{own_help}; or {mapped}" if own_help else mapped
    return replace(message, labels=tuple(map(place_in_file, message.labels)), help=help_)
