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
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.edits import apply_edits
from tltlc.interfaces.lsp.file_renames import may_import
from tltlc.interfaces.lsp.occurrences import MERGED, Occurrence, Symbol
from tltlc.interfaces.lsp.paths import location_of
from tltlc.interfaces.lsp.workspace import Workspace
from tltlc.resolve.scope import FUNCTIONS

_LOCAL: Final = ("parameter", "variable")
_FILE_LOCAL: Final = ("variable", "spec")
"""The kinds of symbols that are used in one file only: variables of quantifiers, and specs."""
_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z_][A-Za-z0-9_]*)*\Z")
_PLAIN: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")

Matches = list[tuple[Document, list[Occurrence]]]
"""Documents, each with the places where the symbol occurs."""


def references(symbol: Symbol, workspace: Workspace) -> Matches:
    """Return every use and declaration of a symbol in the workspace, by document.

    Documents without any are left out.
    """
    documents = _documents(symbol, workspace)
    programs = _programs(symbol, documents)
    result = []
    for document in documents:
        if location_of(document.source) in programs:
            places = [place for place in document.names if place.symbol.is_same(symbol)]
            if places:
                result.append((document, places))
    return result


def may_have_references(symbol: Symbol, text: str) -> bool:
    """Whether another file with this text must be parsed to find the uses of a symbol.

    It must be parsed if it contains the name, or if it may import two files that declare the same
    signal, param or entity. Specs and variables of quantifiers are used in one file only.
    """
    if symbol.kind in _FILE_LOCAL:
        return False
    # If two files declare a signal of the same name, it is one signal in a third file that imports both.
    return symbol.name in text or (symbol.kind in MERGED and may_import(text))


def may_refuse_rename(symbol: Symbol, text: str) -> bool:
    """Whether another file with this text must be parsed to rename a symbol.

    It must be parsed if it may use the symbol, or if the new name may clash with another name there.
    """
    return may_have_references(symbol, text) or (symbol.kind not in _LOCAL and may_import(text))


def rename(symbol: Symbol, name: str, workspace: Workspace) -> list[tuple[Document, list[Edit]]]:
    """Return the edits that rename a symbol everywhere, by document; an empty list if the name stays the same.

    Raises TltlError: TLT0770 if a file outside the workspace declares or uses the symbol, TLT0771 if
    the new name cannot be used.
    """
    check_renamable(symbol, workspace)
    if name == symbol.name:
        return []
    _check_form(symbol, name)
    matches = references(symbol, workspace)
    for document, _ in matches:
        if location_of(document.source) not in workspace.texts() and not workspace.is_own(document.source):
            raise _outside_workspace(symbol, document.source.name)
    changes = [(document, [Edit(place.span, name) for place in _distinct(places)]) for document, places in matches]
    _check_free(symbol, name, changes, workspace)
    return changes


def check_renamable(symbol: Symbol, workspace: Workspace) -> None:
    """Raise TLT0770 if a symbol is declared outside the workspace."""
    if not workspace.is_own(symbol.source):
        raise _outside_workspace(symbol, symbol.source.name)
    if symbol.kind in MERGED:
        for document in _documents(symbol, workspace):
            for loaded in document.resolution.modules:
                source = loaded.module.source
                if workspace.is_own(source) or not _declares(document, symbol, source):
                    continue
                raise _outside_workspace(symbol, source.name)


def _declares(document: Document, symbol: Symbol, source: SourceFile) -> bool:
    """Whether ``source``, which ``document`` reads, declares a name of the same kind and spelling as ``symbol``.

    False if the document is not the file that declares ``symbol`` and does not import this file,
    even indirectly.
    """
    if location_of(symbol.source) not in document.reads:
        return False
    modules = document.resolution.modules
    return any(
        (type(declaration), getattr(declaration, "name", None)) == (type(symbol.declaration), symbol.name)
        for loaded in modules
        if loaded.module.source is source
        for declaration in loaded.module.declarations
    )


def _documents(symbol: Symbol, workspace: Workspace) -> list[Document]:
    """Return the documents that may contain a symbol; the document that declares it comes first."""
    own = workspace.document_at(location_of(symbol.source))
    candidates = [] if symbol.kind in _FILE_LOCAL else [*workspace.all()]
    candidates = [document for document in candidates if may_have_references(symbol, document.source.text)]
    by_name = {document.source.name: document for document in candidates}
    if own is not None:
        by_name = {own.source.name: own, **by_name}
    return list(by_name.values())


def _programs(symbol: Symbol, documents: list[Document]) -> set[str]:
    """Return the locations of the files in which the name of ``symbol`` may mean this symbol.

    These are the file that declares the symbol and the documents that import this file. Signals,
    params and entities may be declared in several files. For these, add all files that these
    documents import, then the documents that import any of the added files, and so on.
    """
    known = {location_of(symbol.source)}
    if symbol.kind not in MERGED:
        return known | {location_of(document.source) for document in documents if document.reads & known}
    while True:
        # If two files declare a signal of the same name, it is one signal in a third file that imports both.
        connected = set().union(*(document.reads for document in documents if document.reads & known))
        if connected <= known:
            return known
        known |= connected


def _distinct(places: list[Occurrence]) -> list[Occurrence]:
    return list({place.span: place for place in places}.values())


# --- checks of the new name ---------------------------------------------------------------------


def _check_form(symbol: Symbol, name: str) -> None:
    pattern = _NAME if symbol.kind in ("signal", "param", "predicate", "let", "entity", "group") else _PLAIN
    if not pattern.match(name):
        raise _rename_error(f"`{name}` is not a name", "use ASCII letters, digits and `_`, and no digit first")
    if name in load().words:
        raise _rename_error(f"`{name}` is a reserved word", f"choose another one, e.g. `{name}_`")
    if name in FUNCTIONS:
        raise _rename_error(f"`{name}` is a function of the language", f"choose another one, e.g. `{name}_of`")


def _check_free(symbol: Symbol, name: str, changes: list[tuple[Document, list[Edit]]], workspace: Workspace) -> None:
    """Raise TLT0771 if the rename would change what any name refers to, or add errors."""
    texts = workspace.texts()
    for document, edits in changes:
        texts[location_of(document.source)] = apply_edits(document.source.text, edits)
    for document, edits in changes:
        after = Document(document.source.with_text(texts[location_of(document.source)]), document.project, texts)
        where, before, now = (
            document.source.name,
            _name_targets(document, edits),
            _name_targets(after, edits, shift=True),
        )
        if _errors(after) > _errors(document) or not set(before) <= set(now):
            raise _rename_error(
                f"`{name}` already means something else in `{where}`", "choose a name that is not taken"
            )
        if before != now:
            title = f"`{name}` already stands in `{where}`, where it means nothing yet"
            raise _rename_error(title, "choose another name, or correct this one there first")
    importing = (
        [] if symbol.kind in _LOCAL else [document for document in workspace.all() if may_import(document.source.text)]
    )
    for document in importing:
        if any(location_of(changed.source) in document.reads for changed, _ in changes) and not any(
            changed.source.name == document.source.name for changed, _ in changes
        ):
            after = Document(document.source, document.project, texts)
            if _errors(after) > _errors(document):
                title = f"`{name}` already means something else in `{document.source.name}`"
                raise _rename_error(title, "choose a name that is not taken")


def _name_targets(document: Document, edits: list[Edit], *, shift: bool = False) -> list[tuple[int, str, int]]:
    """Return for each name in a document a triple that a correct rename does not change.

    It has the offset of the name, the kind and file of the declaration (``"let lib.tltl"``), and the
    offset of the declaration, given as 0 in other files. With ``shift``, the document is the text
    after ``edits``, and its offsets are converted to those before ``edits``, so that the caller can
    compare the lists of both texts.
    """
    own = document.source.name
    before = _offset_before(edits if shift else [])
    targets = []
    for occurrence in document.names:
        symbol = occurrence.symbol
        # Other files may be edited as well, so for declarations in them, compare only kind and file.
        target = before(symbol.span.start) if symbol.source.name == own else 0
        targets.append((before(occurrence.span.start), f"{symbol.kind} {symbol.source.name}", target))
    return targets


def _offset_before(edits: list[Edit]) -> Callable[[int], int]:
    """Return a function that maps a character offset after the edits to the offset before them."""
    ordered = sorted(edits, key=lambda edit: edit.span.start)
    shifts = [0, *accumulate(len(edit.text) - (edit.span.end - edit.span.start) for edit in ordered)]
    starts = [edit.span.start + shift for edit, shift in zip(ordered, shifts, strict=False)]
    return lambda offset: offset - shifts[bisect_left(starts, offset)]


def _errors(document: Document) -> int:
    diagnostics = (*document.syntax_errors, *document.resolution.diagnostics)
    return sum(diagnostic.severity == "error" for diagnostic in diagnostics)


def _outside_workspace(symbol: Symbol, name: str) -> TltlError:
    title = f"`{symbol.name}` is declared in `{name}`, outside of this workspace"
    let_help = "give it another name with a `let` of your own"
    help_ = let_help if symbol.kind in ("predicate", "let") else "rename it there, in an editor that shows its folder"
    return TltlError([Diagnostic("TLT0770", title, help=help_)])


def _rename_error(title: str, help_: str) -> TltlError:
    return TltlError([Diagnostic("TLT0771", title, help=help_)])
