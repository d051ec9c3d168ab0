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
    hoa: Hoa, library: SourceFile, given: Mapping[str, str], options: ResolveOptions
) -> tuple[Vocabulary, FormulaOf, tuple[Diagnostic, ...]]:
    """Return the atoms of a file in its order, a function that reads formulas over the library, and warnings.

    ``given`` maps the names of propositions to predicates; other propositions must be predicates as
    they are written.

    Raises:
        TltlError: the errors of the library; TLT0655 if a proposition is no atom or the same atom
            as another one, or if ``given`` names a proposition that the file does not have; any
            other error in the formula of a proposition.
    """
    module, diagnostics = parse(library)
    stop_at_errors(diagnostics)
    given = _by_name(hoa, given)
    written = [
        SourceFile(f"--atom {atom.text}", given[atom.text])
        if atom.text in given
        # This name differs for each position, unlike the file's name: otherwise equal messages would be merged.
        else SourceFile(f"{hoa.source.name}:{atom.span.start}", hoa.source.slice(atom.span))
        for atom in hoa.atoms
    ]
    vocabulary, formula_of, atom_diagnostics = resolve_atoms(module, written, options)
    starts = {
        source.name: atom.span.start for source, atom in zip(written, hoa.atoms, strict=True) if atom.text not in given
    }
    diagnostics += tuple(_in_file(diagnostic, starts, hoa.source) for diagnostic in atom_diagnostics)
    stop_at_errors(diagnostics)
    assert vocabulary is not None
    return vocabulary, formula_of, diagnostics


def _by_name(hoa: Hoa, given: Mapping[str, str]) -> dict[str, str]:
    """Return the given predicates by the names of the file's propositions.

    The command line splits ``NAME=PREDICATE`` at the first ``=``, but a name may contain ``=``: the
    longest name that matches is taken.
    """
    names = {atom.text for atom in hoa.atoms}
    predicates: dict[str, str] = {}
    for key, value in given.items():
        whole = f"{key}={value}"
        matches = [name for name in names if whole.startswith(f"{name}=")]
        if not matches:
            raise TltlError([_unknown(hoa, key)])
        name = max(matches, key=len)
        predicates[name] = whole[len(name) + 1 :]
    return predicates


def _unknown(hoa: Hoa, name: str) -> Diagnostic:
    from difflib import get_close_matches

    names = [atom.text for atom in hoa.atoms]
    close = get_close_matches(name, names, n=1)
    listed = ", ".join(f"`{name}`" for name in names[:10]) or "none"
    suggestion = f"did you mean `{close[0]}`?" if close else f"the file has {listed}"
    return Diagnostic("TLT0655", f"`{hoa.source.name}` has no atomic proposition `{name}`", help=suggestion)


def _in_file(message: Diagnostic, starts: Mapping[str, int], source: SourceFile) -> Diagnostic:
    """Return a diagnostic about a proposition's name with its labels moved to their positions in the file.

    ``starts`` maps the name of each proposition's source to the position where the proposition
    begins.
    """
    if not message.labels or message.labels[0].source.name not in starts:
        return message

    def placed(label: Label) -> Label:
        start = starts.get(label.source.name)
        if start is None:
            return label
        return replace(label, source=source, span=Span(label.span.start + start, label.span.end + start))

    mapped = f'say which predicate it is: `--atom "{message.labels[0].source.text.strip()}=…"`'
    # Other help texts are for the author of a formula.
    own_help = message.help if message.code in ("TLT0201", "TLT0655") else None
    suggestion = f"{own_help}; or {mapped}" if own_help else mapped
    return replace(message, labels=tuple(map(placed, message.labels)), help=suggestion)
