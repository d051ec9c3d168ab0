"""Find all uses of a name in the files of the workspace, and rename it."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable
from itertools import accumulate
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, TltlError
from tltlc.grammar.tables import load
from tltlc.interfaces.lsp.analysed_text import Document
from tltlc.interfaces.lsp.edits import applied
from tltlc.interfaces.lsp.file_renames import may_import
from tltlc.interfaces.lsp.names import MERGED, Occurrence, Symbol
from tltlc.interfaces.lsp.paths import path_of
from tltlc.interfaces.lsp.workspace import Workspace
from tltlc.resolve.scope import FUNCTIONS

_LOCAL: Final = ("parameter", "variable")
_OF_ONE_FILE: Final = ("variable", "spec")
"""Variables of formulas, and specs: they are used in one file only."""
_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z_][A-Za-z0-9_]*)*\Z")
_PLAIN: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")

Found = list[tuple[Document, list[Occurrence]]]
"""Documents, each with places in it."""


def references(symbol: Symbol, workspace: Workspace) -> Found:
    """Return every place that refers to the same thing as a symbol, by document."""
    documents = _documents(symbol, workspace)
    programs = _programs(symbol, documents)
    result = []
    for document in documents:
        if path_of(document.source.name) in programs:
            places = [place for place in document.names if place.symbol.is_same(symbol)]
            if places:
                result.append((document, places))
    return result


def may_have_references(symbol: Symbol, text: str) -> bool:
    """Whether the uses of a symbol may depend on the declarations and imports of another text."""
    if symbol.kind in _OF_ONE_FILE:
        return False
    # A signal that two files declare is the same one in a third file that imports both.
    return symbol.name in text or (symbol.kind in MERGED and may_import(text))


def may_refuse_rename(symbol: Symbol, text: str) -> bool:
    """Whether renaming a symbol may depend on the declarations and imports of another text."""
    return may_have_references(symbol, text) or (symbol.kind not in _LOCAL and may_import(text))


def rename(symbol: Symbol, name: str, workspace: Workspace) -> list[tuple[Document, list[Edit]]]:
    """Return the edits that rename a symbol everywhere.

    Raises TltlError: TLT0770 if it is declared outside the workspace, TLT0771 if the new name
    cannot be used.
    """
    check_renamable(symbol, workspace)
    if name == symbol.name:
        return []
    _check_form(symbol, name)
    matches = references(symbol, workspace)
    for document, _ in matches:
        if path_of(document.source.name) not in workspace.texts() and not workspace.is_own(document.source.name):
            raise _elsewhere(symbol, document.source.name)
    changed = [(document, [Edit(place.span, name) for place in _distinct(places)]) for document, places in matches]
    _check_free(symbol, name, changed, workspace)
    return changed


def check_renamable(symbol: Symbol, workspace: Workspace) -> None:
    """Raise TLT0770 if a symbol is declared outside the workspace."""
    if not workspace.is_own(symbol.source.name):
        raise _elsewhere(symbol, symbol.source.name)
    if symbol.kind in MERGED:
        for document in _documents(symbol, workspace):
            for loaded in document.resolution.modules:
                source = loaded.module.source
                if workspace.is_own(source.name) or not _declares(document, symbol, source):
                    continue
                raise _elsewhere(symbol, source.name)


def _declares(document: Document, symbol: Symbol, source: SourceFile) -> bool:
    """Whether a library declares the same thing, in a program that contains the symbol's file."""
    if path_of(symbol.source.name) not in document.reads:
        return False
    modules = document.resolution.modules
    return any(
        (type(declaration), getattr(declaration, "name", None)) == (type(symbol.declaration), symbol.name)
        for loaded in modules
        if loaded.module.source is source
        for declaration in loaded.module.declarations
    )


def _documents(symbol: Symbol, workspace: Workspace) -> list[Document]:
    """Return the documents that may contain a symbol, its own first."""
    own = workspace.named(path_of(symbol.source.name))
    candidates = [] if symbol.kind in _OF_ONE_FILE else [*workspace.all()]
    candidates = [document for document in candidates if may_have_references(symbol, document.source.text)]
    by_name = {document.source.name: document for document in candidates}
    if own is not None:
        by_name = {own.source.name: own, **by_name}
    return list(by_name.values())


def _programs(symbol: Symbol, documents: list[Document]) -> set[str]:
    """Return the paths of the files that are parts of one program with the symbol's file."""
    known = {path_of(symbol.source.name)}
    if symbol.kind not in MERGED:
        return known | {path_of(document.source.name) for document in documents if document.reads & known}
    while True:
        # A signal that two files declare is the same one in a third file that imports both.
        connected = set().union(*(document.reads for document in documents if document.reads & known))
        if connected <= known:
            return known
        known |= connected


def _distinct(places: list[Occurrence]) -> list[Occurrence]:
    return list({place.span: place for place in places}.values())


# --- refusals -----------------------------------------------------------------------------------


def _check_form(symbol: Symbol, name: str) -> None:
    pattern = _NAME if symbol.kind in ("signal", "param", "predicate", "let", "entity") else _PLAIN
    if not pattern.match(name):
        raise _refused(f"`{name}` is no name", "a name has letters, digits and `_`, and begins with no digit")
    if any(part in load().words for part in name.split(".")[:1]) and name in load().words:
        raise _refused(f"`{name}` is a reserved word", f"choose another one, e.g. `{name}_`")
    if name in FUNCTIONS:
        raise _refused(f"`{name}` is a function of the language", f"choose another one, e.g. `{name}_of`")


def _check_free(symbol: Symbol, name: str, changed: list[tuple[Document, list[Edit]]], workspace: Workspace) -> None:
    """Raise TLT0771 if the rename would change what any name refers to, or add errors."""
    texts = workspace.texts()
    for document, edits in changed:
        texts[path_of(document.source.name)] = applied(document.source.text, edits)
    for document, edits in changed:
        after = Document(
            SourceFile(document.source.name, texts[path_of(document.source.name)]), document.project, texts
        )
        if _shape(document, edits) != _shape(after, edits, shift=True) or _errors(after) > _errors(document):
            where = document.source.name
            raise _refused(f"`{name}` means something else in `{where}` already", "choose a name that is not taken")
    importing = (
        [] if symbol.kind in _LOCAL else [document for document in workspace.all() if may_import(document.source.text)]
    )
    for document in importing:
        if any(path_of(other.source.name) in document.reads for other, _ in changed) and not any(
            other.source.name == document.source.name for other, _ in changed
        ):
            after = Document(document.source, document.project, texts)
            if _errors(after) > _errors(document):
                title = f"`{name}` means something else in `{document.source.name}` already"
                raise _refused(title, "choose a name that is not taken")


def _shape(document: Document, edits: list[Edit], *, shift: bool = False) -> list[tuple[int, str, int]]:
    """Return where the names of a text lead to, with offsets before the edit.

    A correct rename preserves this.
    """
    own = document.source.name
    before = _before(edits if shift else [])
    targets = []
    for occurrence in document.names:
        symbol = occurrence.symbol
        # Another file may be edited as well, so compare only the kind and the file there.
        target = before(symbol.span.start) if symbol.source.name == own else 0
        targets.append((before(occurrence.span.start), f"{symbol.kind} {symbol.source.name}", target))
    return targets


def _before(edits: list[Edit]) -> Callable[[int], int]:
    """Return a function that maps a character offset after the edits to the one before them."""
    ordered = sorted(edits, key=lambda edit: edit.span.start)
    shifts = [0, *accumulate(len(edit.text) - (edit.span.end - edit.span.start) for edit in ordered)]
    starts = [edit.span.start + shift for edit, shift in zip(ordered, shifts, strict=False)]
    return lambda offset: offset - shifts[bisect_left(starts, offset)]


def _errors(document: Document) -> int:
    diagnostics = (*document.syntax_errors, *document.resolution.diagnostics)
    return sum(diagnostic.severity == "error" for diagnostic in diagnostics)


def _elsewhere(symbol: Symbol, name: str) -> TltlError:
    title = f"`{symbol.name}` is declared in `{name}`, outside of this workspace"
    let_help = "a `let` of yours may give it another name"
    help_ = let_help if symbol.kind in ("predicate", "let") else "change it there, in an editor that shows its folder"
    return TltlError([Diagnostic("TLT0770", title, help=help_)])


def _refused(title: str, help_: str) -> TltlError:
    return TltlError([Diagnostic("TLT0771", title, help=help_)])
