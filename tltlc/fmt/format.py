"""A source text in its one layout: same meaning, same comments, other spaces and spellings."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.fmt.allowed import NOTHING, Kept, keeping
from tltlc.fmt.declarations import Declarations
from tltlc.fmt.flat import Flat
from tltlc.fmt.page import Page
from tltlc.fmt.style import DEFAULT, STYLES, Style
from tltlc.grammar import tree
from tltlc.grammar.parser import parse
from tltlc.source import SourceFile


def format_text(text: str, style: str = DEFAULT) -> str:
    r"""The text in its layout, with the operators of a style: ``words``, ``letters``, ``symbols`` or ``unicode``.

    Its syntax tree is that of ``text``, spans and the form of bounds apart.  Errors: :class:`TltlError` with every
    error of syntax; KeyError for a style that there is not.

    >>> from tltlc.fmt import format_text
    >>> format_text("signal seen:bool  spec hide=G !seen")
    'signal seen: bool\nspec hide = always not seen\n'
    """
    return format_source(SourceFile("<text>", text), style)


def format_source(source: SourceFile, style: str = DEFAULT) -> str:
    """As :func:`format_text`, for a text with a name, by which errors call it."""
    module, found = parse(source)
    if found:
        raise TltlError(found)
    try:
        return _written(module, STYLES[style])
    except RecursionError:
        from tltlc.automaton.blowup import recursion_room

        # The grammar lets operators nest 1000 deep.
        with recursion_room():
            return _written(module, STYLES[style])


_EVERYTHING: Final = 1 << 62


def _written(module: tree.Module, style: Style) -> str:
    """The layout, with as much as it takes kept as it is for comments to allow the same as before."""
    kept = NOTHING
    while True:
        text = _laid_out(module, style, kept)
        more = keeping(module, text, kept)
        if more == kept:
            return text
        kept = more


def _laid_out(module: tree.Module, style: Style, kept: Kept) -> str:
    page = Page(module.source, module.comments)
    declarations = Declarations(module.source, page, Flat(module.source, style), kept.joints)
    for declaration in module.declarations:
        start = declaration.span.start
        page.comments(start, 0, gaps=True)
        page.gap(start)
        page.begin(start in kept.joints, 0)
        if start in kept.declarations:
            page.put_as_written(declaration.span)
        else:
            declarations.put(declaration)
    page.comments(_EVERYTHING, 0, gaps=True)
    return page.text()
