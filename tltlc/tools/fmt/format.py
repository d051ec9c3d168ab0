"""Format a source text: it keeps its meaning and comments, and gets other spaces and spellings."""

from __future__ import annotations

from typing import Final

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar import tree
from tltlc.grammar.lexer import MAX_TOKENS
from tltlc.grammar.parser import is_too_large, parse
from tltlc.tools.fmt.allowed import NOTHING, Kept, keeping
from tltlc.tools.fmt.declarations import Declarations
from tltlc.tools.fmt.flat import Flat
from tltlc.tools.fmt.page import Page
from tltlc.tools.fmt.style import DEFAULT, STYLES, Style


def format_text(text: str, style: str = DEFAULT) -> str:
    r"""Return the text in its layout, with the operators of a style.

    The styles are ``words``, ``letters``, ``symbols`` and ``unicode``. The syntax tree of the
    result is the same as the tree of ``text``, except for spans and the form of bounds.

    Raises:
        TltlError: the text has syntax errors; or TLT0004, the result would be too large to be read.
        KeyError: there is no such style.

    >>> from tltlc.tools.fmt import format_text
    >>> format_text("signal seen:bool  spec hide=G !seen")
    'signal seen: bool\nspec hide = always not seen\n'
    """
    return format_source(SourceFile("<text>", text), style)


def format_source(source: SourceFile, style: str = DEFAULT) -> str:
    """Format a text like :func:`format_text`; errors call it by its name."""
    module, diagnostics = parse(source)
    if diagnostics:
        raise TltlError(diagnostics)
    try:
        return _written(module, STYLES[style])
    except RecursionError:
        from tltlc.automaton.finite.blowup import recursion_room

        # The grammar allows operators to nest 1000 levels deep.
        with recursion_room():
            return _written(module, STYLES[style])


_EVERYTHING: Final = 1 << 62


def _written(module: tree.Module, style: Style) -> str:
    """Return the layout in which comments allow the same as before.

    It leaves as much of the source unchanged as this requires.
    """
    kept = NOTHING
    while True:
        text = _laid_out(module, style, kept)
        _check_size(module.source.name, text)
        needed = keeping(module, text, kept)
        if needed == kept:
            return text
        kept = needed


def _check_size(name: str, text: str) -> None:
    """Raise TLT0004 if a layout is too large to be read again."""
    if is_too_large(SourceFile(name, text)):
        title = f"`{name}` would be larger than 1 MiB or {MAX_TOKENS:,} words and signs in its layout"
        help_ = "it stays as it is; to lay it out, split it: a file may `import` others"
        raise TltlError([Diagnostic("TLT0004", title, help=help_)])


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
