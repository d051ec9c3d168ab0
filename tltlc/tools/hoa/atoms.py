"""What the atomic propositions of a HOA file mean: predicates of a library."""

from __future__ import annotations

from collections.abc import Mapping

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError, stop_at_errors
from tltlc.grammar.parser import parse
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import FormulaOf, resolve_atoms
from tltlc.resolve.spec import Vocabulary
from tltlc.tools.hoa.tree import Hoa


def vocabulary_of(
    hoa: Hoa, library: SourceFile, given: Mapping[str, str], options: ResolveOptions
) -> tuple[Vocabulary, FormulaOf, tuple[Diagnostic, ...]]:
    """The atoms of a file in its order, a way to read formulas over the library, and warnings.

    ``given`` says what a proposition means that is no predicate as it stands.

    Raises:
        TltlError: all that is wrong with the library; TLT0655, a proposition is no atom, the same as another one, or
            there is none that ``given`` names; what else keeps it from being a formula.
    """
    module, found = parse(library)
    stop_at_errors(found)
    given = _by_name(hoa, given)
    written = [
        SourceFile(f"--atom {atom.text}", given[atom.text])
        if atom.text in given
        # Unlike the name of the file, this name differs for each place: otherwise messages would be taken for one.
        else SourceFile(f"{hoa.source.name}:{atom.span.start}", hoa.source.slice(atom.span))
        for atom in hoa.atoms
    ]
    words, formula_of, more = resolve_atoms(module, written, options)
    starts = {
        source.name: atom.span.start for source, atom in zip(written, hoa.atoms, strict=True) if atom.text not in given
    }
    found += tuple(_in_file(each, starts, hoa.source) for each in more)
    stop_at_errors(found)
    assert words is not None
    return words, formula_of, found


def _by_name(hoa: Hoa, given: Mapping[str, str]) -> dict[str, str]:
    """What is given, by names that the file has; a name may hold ``=``, at which the command line was cut."""
    names = {atom.text for atom in hoa.atoms}
    found: dict[str, str] = {}
    for key, value in given.items():
        whole = f"{key}={value}"
        fitting = [name for name in names if whole.startswith(f"{name}=")]
        if not fitting:
            raise TltlError([_unknown(hoa, key)])
        name = max(fitting, key=len)
        found[name] = whole[len(name) + 1 :]
    return found


def _unknown(hoa: Hoa, name: str) -> Diagnostic:
    from difflib import get_close_matches

    names = [atom.text for atom in hoa.atoms]
    close = get_close_matches(name, names, n=1)
    listed = ", ".join(f"`{each}`" for each in names[:10]) or "none"
    way_out = f"did you mean `{close[0]}`?" if close else f"the file has {listed}"
    return Diagnostic("TLT0655", f"`{hoa.source.name}` has no atomic proposition `{name}`", help=way_out)


def _in_file(message: Diagnostic, starts: Mapping[str, int], source: SourceFile) -> Diagnostic:
    """A message that speaks of a name in the file alone, speaking of the whole file.

    ``starts`` is where each such name begins, by the name of its source.
    """
    if not message.labels or message.labels[0].source.name not in starts:
        return message

    def placed(label: Label) -> Label:
        start = starts.get(label.source.name)
        if start is None:
            return label
        return replace(label, source=source, span=Span(label.span.start + start, label.span.end + start))

    mapped = f'say which predicate it is: `--atom "{message.labels[0].source.text.strip()}=…"`'
    # Other advice is for whoever wrote the formula.
    own = message.help if message.code in ("TLT0201", "TLT0655") else None
    way_out = f"{own}; or {mapped}" if own else mapped
    return replace(message, labels=tuple(map(placed, message.labels)), help=way_out)
