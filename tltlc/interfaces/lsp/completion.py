"""Complete keywords, visible names, units, verdicts and libraries at the cursor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Final

from lsprotocol import types

from tltlc.core.source import Span
from tltlc.grammar import past_words
from tltlc.grammar.keywords import CLAUSES, DECLARATIONS, JUDGE, SEMANTICS, TEST_ITEMS, VERDICTS
from tltlc.grammar.lexer import END, Token
from tltlc.grammar.tables import load
from tltlc.grammar.tree import Clause, LetDecl, NameExpr, PredicateDecl, SignalDecl, SpecDecl
from tltlc.interfaces.lsp.cursor import Cursor, cursor, quoted_text
from tltlc.interfaces.lsp.declaration_text import declaration_text
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.paths import location_of
from tltlc.interfaces.lsp.positions import range_of
from tltlc.io.files import is_file, unsaved_texts
from tltlc.resolve import units
from tltlc.resolve.imports import standard_library
from tltlc.resolve.registers import following_atoms
from tltlc.resolve.scope import FUNCTIONS, Binding

_ItemKind = types.CompletionItemKind
_KINDS: Final = {
    "signal": _ItemKind.Field,
    "param": _ItemKind.Constant,
    "predicate": _ItemKind.Function,
    "let": _ItemKind.Function,
    "entity": _ItemKind.EnumMember,
    "group": _ItemKind.Enum,
}
_FORMS: Final = {**DECLARATIONS, **CLAUSES, **TEST_ITEMS}
_HEADS: Final = ("signal", "param", "predicate", "let")
_STEP_UNITS: Final = ("step", "steps")
_NAMES: Final = {"NAME"}


def completions(document: Document, offset: int, encoding: str) -> list[types.CompletionItem]:
    """Return the words that may be written at a character offset, the likeliest first.

    Each word comes with the edit that inserts it. The columns of edits are counted in units of
    ``encoding``, such as ``utf-16``.
    """
    quotation = quoted_text(document.source, offset)
    if quotation is not None:
        before, span = quotation
        return _edits(_paths(document), document, span, encoding) if before == "import" else []
    place = cursor(document.source, offset)
    if place is None:
        return []
    by_label = {item.label: item for item in reversed([*_items(document, place)])}
    return _edits(reversed(by_label.values()), document, place.word, encoding)


def _edits(
    items: Iterable[types.CompletionItem], document: Document, span: Span, encoding: str
) -> list[types.CompletionItem]:
    """Add to each completion an edit that replaces ``span``, the part of the word already written.

    Also number the completions, so that the editor keeps their order. Return them as a list.
    """
    at = range_of(document.source, span, encoding)
    ordered = list(items)
    for rank, item in enumerate(ordered):
        item.text_edit = types.TextEdit(at, item.label)
        item.sort_text = f"{rank:05}"
    return ordered


def _items(document: Document, place: Cursor) -> Iterator[types.CompletionItem]:
    allowed = place.allowed if place.allowed is not None else _NAMES
    if "UNIT" in allowed and place.last == "NUMBER":
        yield from _units(place)
    if "NAME" in allowed:
        yield from _names(document, place)
    yield from _keywords(allowed, place)


# --- keywords and units -------------------------------------------------------------------------


def _keywords(allowed: Iterable[str], place: Cursor) -> Iterator[types.CompletionItem]:
    spellings: dict[str, str] = {}
    for word, terminal in (*load().words.items(), *load().soft.items()):
        if len(word) > len(spellings.get(terminal, "")):
            spellings[terminal] = word
    for terminal in sorted(set(allowed) - {END}):
        if terminal in spellings and terminal != "TIMES":
            word = spellings[terminal]
            # After a colon, `entity` is a type, and does not begin a declaration.
            form = _FORMS.get(word) if place.last != "COLON" else None
            past = past_words.OPERATORS.get(word)
            detail = form.replace("`", "") if form else " or ".join(past.forms) if past else None
            documentation = past.meaning if past else None
            yield types.CompletionItem(word, kind=_ItemKind.Keyword, detail=detail, documentation=documentation)


def _units(place: Cursor) -> Iterator[types.CompletionItem]:
    is_count = place.first == "limit" or any(token.text in ("within", "for", "after") for token in place.piece[-2:])
    is_count = is_count or (any(token.type == "LSQB" for token in place.piece[-4:]) and place.start != "declaration")
    unit_names = (
        [*_STEP_UNITS, *units.time_units()] if is_count else [unit for unit in load().units if unit not in _STEP_UNITS]
    )
    if place.first == "clock":
        unit_names = ["Hz", *units.time_units()]
    for unit in unit_names:
        conversion = units.in_si(1.0, unit)
        detail = units.dimension_text(conversion[1]) if conversion else "samples"
        yield types.CompletionItem(unit, kind=_ItemKind.Unit, detail=detail)


# --- names --------------------------------------------------------------------------------------


def _names(document: Document, place: Cursor) -> Iterator[types.CompletionItem]:
    """Yield completions for the names that may stand at the cursor."""
    first, before = place.first, place.piece[-1].text if place.piece else ""
    enum = _enum_before_is(document, place.piece)
    if enum is not None:
        for number, name in enumerate(value.name for value in enum.values):
            yield types.CompletionItem(name, kind=_ItemKind.EnumMember, detail=f"{number} of {enum.name}")
        return
    if place.start == "clause" and first in ("level", "judge", "semantics", "tag"):
        yield from _settings(document, first)
    elif place.start == "test_item" and before == "expect":
        yield from (types.CompletionItem(word, kind=_ItemKind.EnumMember) for word in (*VERDICTS, "progress", "state"))
    elif place.start == "declaration" and first == "import":
        yield from _imports(document, place)
    elif place.start == "declaration" and first == "test":
        yield from (
            _spec_item(declaration, document)
            for declaration in document.module.declarations
            if isinstance(declaration, SpecDecl)
        )
    elif place.start == "declaration" and (len(place.piece) == 1 or first in ("entity", "clock")):
        if first == "exclusive":
            yield from _expression_names(document, place)
        elif any(token.type == "EQUAL" for token in place.piece):
            # The members of a group.
            yield from _visible_names(document, ("entity", "group"))
    elif place.start == "declaration" and first in _HEADS and not _is_in_body(place.piece):
        if place.last == "COLON":
            yield from _types(first)
        elif place.last in ("EQUAL", "LSQB", "COMMA") and _depth(place.piece, "LSQB"):
            yield from _visible_names(document, ("param",))
    elif place.last in ("ALL", "ANY"):
        return
    else:
        yield from _expression_names(document, place)


def _enum_before_is(document: Document, piece: tuple[Token, ...]) -> SignalDecl | None:
    """Return the enum of which a value follows, if the tokens end with ``mode is`` or ``mode(g1) is not``."""
    at = len(piece) - 1
    at -= at > 0 and piece[at].type == "NOT"
    if at < 1 or piece[at].text != "is":
        return None
    at -= 1
    if piece[at].type == "RPAR":
        while at > 0 and piece[at].type != "LPAR":
            at -= 1
        at -= 1
    binding = document.scope.names.get(piece[max(at, 0)].text)
    declaration = binding.declaration if binding else None
    return declaration if isinstance(declaration, SignalDecl) and declaration.values else None


def _settings(document: Document, clause: str) -> Iterator[types.CompletionItem]:
    words: Iterable[str] = {"judge": JUDGE, "semantics": SEMANTICS}.get(clause, ())
    if clause == "tag":
        tags = {name.name for item in _clauses(document) if isinstance(item.value, tuple) for name in item.value}
        words = sorted(tags)
    if clause == "level":
        words = sorted({item.value.name for item in _clauses(document, "level") if isinstance(item.value, NameExpr)})
    yield from (types.CompletionItem(word, kind=_ItemKind.EnumMember) for word in words)


def _clauses(document: Document, kind: str = "tag") -> Iterator[Clause]:
    for declaration in document.module.declarations:
        if isinstance(declaration, SpecDecl):
            yield from (clause for clause in declaration.clauses if clause.kind == kind)


def _types(head: str) -> Iterator[types.CompletionItem]:
    extra_types = {"predicate": ("entity",), "let": ("entity", "formula"), "signal": ("entity",)}.get(head, ())
    for name in (*units.TYPES, *extra_types):
        dimension = units.TYPES.get(name)
        detail = f"in {units.si_unit(dimension)}" if dimension and units.si_unit(dimension) else None
        yield types.CompletionItem(name, kind=_ItemKind.TypeParameter, detail=detail)


def _expression_names(document: Document, place: Cursor) -> Iterator[types.CompletionItem]:
    call = _open_call(place.piece)
    binding = document.scope.names.get(call[0]) if call else None
    if call and call[0] == "in":
        yield from _visible_names(document, ("entity", "group"))
        return
    if call and binding and isinstance(binding.declaration, (SignalDecl, PredicateDecl, LetDecl)):
        position, parameters = call[1], binding.declaration.parameters
        if binding.kind == "signal" or (position < len(parameters) and parameters[position].type == "entity"):
            yield from _local_names(place.piece)
            yield from _visible_names(document, ("entity",))
            return
        for parameter in parameters[position:]:
            if place.last in ("LPAR", "COMMA"):
                detail = f"of {binding.name}" + (f", a {parameter.type}" if parameter.type else "")
                yield types.CompletionItem(f"{parameter.name} = ", kind=_ItemKind.Property, detail=detail)
    yield from _local_names(place.piece)
    if place.start == "test_item":
        yield from _atoms(document, place.around)
    yield from _visible_names(document, ("predicate", "let", "signal", "param"))
    yield from (types.CompletionItem(name, kind=_ItemKind.Operator, detail="function") for name in FUNCTIONS)
    for name, word in past_words.FUNCTIONS.items():
        if name not in document.scope.names:
            detail = " or ".join(word.forms)
            yield types.CompletionItem(name, kind=_ItemKind.Operator, detail=detail, documentation=word.meaning)
    if call:
        yield from _visible_names(document, ("entity",))


def _visible_names(document: Document, kinds: tuple[str, ...]) -> Iterator[types.CompletionItem]:
    """Yield completions for the visible names of some kinds, such as ``("predicate", "let")``.

    They come in the order of ``kinds``; within a kind, imported names come last.
    """
    scope = document.scope
    bindings = [(name, binding) for name, binding in scope.names.items() if binding.kind in kinds]
    for name, binding in sorted(bindings, key=lambda item: (kinds.index(item[1].kind), item[1].via is not None)):
        yield _name_item(name, binding)


def _name_item(name: str, binding: Binding) -> types.CompletionItem:
    declaration = binding.declaration
    doc = "" if isinstance(declaration, NameExpr) else declaration.doc
    head = declaration_text(declaration, binding.scope.source, head=True)
    detail = f"{head} (from {binding.via})" if binding.via else head
    return types.CompletionItem(name, kind=_KINDS[binding.kind], detail=detail, documentation=doc or None)


def _spec_item(declaration: SpecDecl, document: Document) -> types.CompletionItem:
    doc = declaration.doc or None
    return types.CompletionItem(declaration.name, kind=_ItemKind.Class, detail="spec", documentation=doc)


def _atoms(document: Document, block: tuple[Token, ...]) -> Iterator[types.CompletionItem]:
    """Yield completions for the atoms and numbers that a step of the ``test`` block around the cursor can name.

    ``block`` contains the tokens from the start of the block up to the cursor.
    """
    name = next((block[at + 1].text for at, token in enumerate(block[:-1]) if token.text == "for"), "")
    for spec in document.resolution.program.specs:
        if spec.name == name:
            following = following_atoms(spec.atoms, spec.registers)
            for atom in (atom for atom in spec.atoms if atom.name not in following):
                yield types.CompletionItem(
                    atom.name, kind=_ItemKind.Event, detail=f"atom of {name}", documentation=atom.doc or None
                )
            for signal in (signal for signal in spec.signals if signal.type != "bool"):
                yield types.CompletionItem(
                    f"{signal.name} = ",
                    kind=_ItemKind.Variable,
                    detail=f"number of {name}",
                    documentation=signal.doc or None,
                )


def _local_names(piece: tuple[Token, ...]) -> Iterator[types.CompletionItem]:
    """Yield completions for the parameters of the declaration at the cursor, and for its quantifiers' variables.

    ``piece`` contains the tokens from the start of the declaration up to the cursor.
    """
    names: dict[str, None] = {}
    if piece and piece[0].text in ("predicate", "let"):
        depth = 0
        for before, token in pairwise(piece):
            depth += (before.type == "LPAR") - (before.type == "RPAR")
            if before.type == "EQUAL" and depth == 0:
                break
            if depth == 1 and before.type in ("LPAR", "COMMA") and token.type == "NAME":
                names[token.text] = None
    names.update((token.text, None) for before, token in pairwise(piece) if before.type in ("ALL", "ANY"))
    yield from (types.CompletionItem(name, kind=_ItemKind.Variable, detail="parameter") for name in names)


def _open_call(piece: tuple[Token, ...]) -> tuple[str, int] | None:
    """Return the word before the innermost open bracket, and how many commas follow directly inside this bracket.

    The word is a name, or ``in``. After the text ``near(s1,`` the result is ``("near", 1)``. Return
    None if no bracket is open, or if no such word precedes the bracket.
    """
    open_: list[tuple[str, int]] = []
    for index, token in enumerate(piece):
        if token.type == "LPAR":
            before = piece[index - 1] if index else None
            open_.append((before.text if before and before.type in ("NAME", "IN") else "", 0))
        elif token.type == "RPAR" and open_:
            open_.pop()
        elif token.type == "COMMA" and open_:
            open_[-1] = (open_[-1][0], open_[-1][1] + 1)
    return open_[-1] if open_ and open_[-1][0] else None


def _is_in_body(piece: tuple[Token, ...]) -> bool:
    """Whether the tokens of a declaration up to the cursor include its ``=``, so that the cursor is in the body."""
    depth = 0
    for token in piece:
        depth += (token.type in ("LPAR", "LSQB")) - (token.type in ("RPAR", "RSQB"))
        if token.type == "EQUAL" and depth == 0:
            return True
    return False


def _depth(piece: tuple[Token, ...], opening: str) -> int:
    closing = {"LSQB": "RSQB"}[opening]
    return sum((token.type == opening) - (token.type == closing) for token in piece)


# --- imports ------------------------------------------------------------------------------------


def _imports(document: Document, place: Cursor) -> Iterator[types.CompletionItem]:
    if len(place.piece) == 1:
        yield from _libraries(document)
    elif place.last in ("LPAR", "COMMA"):
        # The incomplete import cannot be parsed, so resolve an import of the whole file instead.
        alone = document.source.with_text(f"import {place.piece[1].text}")
        yield from _visible_names(Document(alone, document.project, document.texts), tuple(_KINDS))


def _libraries(document: Document) -> Iterator[types.CompletionItem]:
    """Yield completions for the libraries that can be imported by name.

    The libraries in the folder of the document come first, then those of the project, then the
    standard library.
    """
    folders: dict[str, Path] = {}
    for folder in (_folder(document), *document.project.libraries, standard_library()):
        for path in _sources(folder, document):
            if path.stem.isidentifier() and path.stem not in load().words and str(path) != document.source.name:
                folders.setdefault(path.stem, folder)
    for name, folder in folders.items():
        detail = "standard library" if folder == standard_library() else str(folder)
        yield types.CompletionItem(name, kind=_ItemKind.Module, detail=detail)


def _paths(document: Document) -> Iterator[types.CompletionItem]:
    """Yield completions for the paths of the other source files in the document's folder and its parent folder.

    The paths are relative, such as ``doors.tltl`` and ``../doors.tltl``.
    """
    here = _folder(document)
    for folder, prefix in ((here, ""), (here.parent, "../")):
        for path in _sources(folder, document):
            if str(path) != document.source.name:
                yield types.CompletionItem(f"{prefix}{path.name}", kind=_ItemKind.File)


def _sources(folder: Path, document: Document) -> list[Path]:
    with unsaved_texts(document.texts):
        try:
            paths = set(folder.glob("*.tltl"))
        except OSError:
            paths = set()
        open_files = (Path(location) for location in document.texts if is_file(location))
        paths |= {path for path in open_files if path.parent == folder and path.suffix == ".tltl"}
    return sorted(path for path in paths if not path.stem.endswith("_tests"))


def _folder(document: Document) -> Path:
    return Path() if document.source.kind == "text" else Path(location_of(document.source)).parent
