"""Where else a name stands, in all files of the workspace, and giving it another one."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable
from itertools import accumulate
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, TltlError
from tltlc.grammar.parser import parse
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
"""What is local to a formula, and specs, stand in one file."""
_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z_][A-Za-z0-9_]*)*\Z")
_PLAIN: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")

Found = list[tuple[Document, list[Occurrence]]]
"""Documents, each with places in it."""


def references(symbol: Symbol, workspace: Workspace) -> Found:
    """Every place that stands for what a symbol does, file by file."""
    documents = _documents(symbol, workspace)
    programs = _programs(symbol, documents)
    found = []
    for document in documents:
        if path_of(document.source.name) in programs:
            places = [each for each in document.names if each.symbol.is_same(symbol)]
            if places:
                found.append((document, places))
    return found


def may_have_references(symbol: Symbol, text: str) -> bool:
    """Whether places for a symbol may depend on what a source text declares and imports; its own file aside."""
    if symbol.kind in _OF_ONE_FILE:
        return False
    # A signal that two files declare is one where a third one imports both.
    return symbol.name in text or (symbol.kind in MERGED and may_import(text))


def may_refuse_rename(symbol: Symbol, text: str) -> bool:
    """Whether a new name for a symbol may depend on what a source text declares and imports; its own file aside."""
    return may_have_references(symbol, text) or (symbol.kind not in _LOCAL and may_import(text))


def rename(symbol: Symbol, name: str, workspace: Workspace) -> list[tuple[Document, list[Edit]]]:
    """The edits that give what a symbol stands for another name, everywhere.

    Errors: TLT0770 where it is declared outside of the workspace, TLT0771 where the new name cannot be used.
    """
    check_renamable(symbol, workspace)
    if name == symbol.name:
        return []
    _check_form(symbol, name)
    found = references(symbol, workspace)
    for document, _ in found:
        if path_of(document.source.name) not in workspace.texts() and not workspace.is_own(document.source.name):
            raise _elsewhere(symbol, document.source.name)
    changed = [(document, [Edit(each.span, name) for each in _distinct(places)]) for document, places in found]
    _check_free(symbol, name, changed, workspace)
    return changed


def check_renamable(symbol: Symbol, workspace: Workspace) -> None:
    """Error TLT0770 where a name is not ours to change."""
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
    """Whether a library declares the same signal, param or entity, in a program that has the symbol's file."""
    if path_of(symbol.source.name) not in document.reads:
        return False
    modules = document.resolution.modules
    return any(
        (type(each), getattr(each, "name", None)) == (type(symbol.declaration), symbol.name)
        for loaded in modules
        if loaded.module.source is source
        for each in loaded.module.declarations
    )


def _documents(symbol: Symbol, workspace: Workspace) -> list[Document]:
    """The documents in which a symbol may stand, its own first."""
    own = workspace.named(path_of(symbol.source.name))
    others = [] if symbol.kind in _OF_ONE_FILE else [*workspace.all()]
    others = [each for each in others if may_have_references(symbol, each.source.text)]
    found = {each.source.name: each for each in others}
    if own is not None:
        found = {own.source.name: own, **found}
    return list(found.values())


def _programs(symbol: Symbol, documents: list[Document]) -> set[str]:
    """The paths of the files that are parts of one program with the symbol's file."""
    known = {path_of(symbol.source.name)}
    if symbol.kind not in MERGED:
        return known | {path_of(each.source.name) for each in documents if each.reads & known}
    while True:
        # A signal that two files declare is one where a third one imports both.
        more = set().union(*(each.reads for each in documents if each.reads & known))
        if more <= known:
            return known
        known |= more


def _distinct(places: list[Occurrence]) -> list[Occurrence]:
    return list({each.span: each for each in places}.values())


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
    """Error TLT0771 where the new name would stand for something else, or something else for it."""
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
    importing = [] if symbol.kind in _LOCAL else [each for each in workspace.all() if may_import(each.source.text)]
    for document in importing:
        if any(path_of(other.source.name) in document.reads for other, _ in changed) and not any(
            other.source.name == document.source.name for other, _ in changed
        ):
            after = Document(document.source, document.project, texts)
            if _errors(after) > _errors(document):
                title = f"`{name}` means something else in `{document.source.name}` already"
                raise _refused(title, "choose a name that is not taken")


def _shape(document: Document, edits: list[Edit], *, shift: bool = False) -> list[tuple[int, str, int]]:
    """Where the names of a text lead to, in terms of the text before an edit: the same before and after a rename."""
    own = document.source.name
    before = _before(edits if shift else [])
    found = []
    for each in document.names:
        symbol = each.symbol
        # Another file may be edited as well: what counts there is the kind alone.
        target = before(symbol.span.start) if symbol.source.name == own else 0
        found.append((before(each.span.start), f"{symbol.kind} {symbol.source.name}", target))
    return found


def _before(edits: list[Edit]) -> Callable[[int], int]:
    """A function from the offset of a character after the edits to the one before them."""
    ordered = sorted(edits, key=lambda each: each.span.start)
    moved = [0, *accumulate(len(each.text) - (each.span.end - each.span.start) for each in ordered)]
    starts = [each.span.start + by for each, by in zip(ordered, moved, strict=False)]
    return lambda offset: offset - moved[bisect_left(starts, offset)]


def _errors(document: Document) -> int:
    _, syntax = parse(document.source)
    return sum(each.severity == "error" for each in (*syntax, *document.resolution.diagnostics))


def _elsewhere(symbol: Symbol, name: str) -> TltlError:
    title = f"`{symbol.name}` is declared in `{name}`, outside of this workspace"
    own = "a `let` of yours may give it another name"
    way_out = own if symbol.kind in ("predicate", "let") else "change it there, in an editor that shows its folder"
    return TltlError([Diagnostic("TLT0770", title, help=way_out)])


def _refused(title: str, way_out: str) -> TltlError:
    return TltlError([Diagnostic("TLT0771", title, help=way_out)])
