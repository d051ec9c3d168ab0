"""Format a source text: change its spaces and the spelling of operators, but not its meaning or comments."""

from __future__ import annotations

from typing import Final

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.lexer import MAX_TOKENS
from tltlc.grammar.module import Module
from tltlc.grammar.parser import is_too_large, parse
from tltlc.logic.text.one_line import OneLinePrinter
from tltlc.logic.text.style import DEFAULT, STYLES, Style
from tltlc.tools.fmt.declarations import DeclarationPrinter
from tltlc.tools.fmt.layout_constraints import NO_CONSTRAINTS, LayoutConstraints, required_constraints
from tltlc.tools.fmt.page import Page


def format_text(text: str, style: str = DEFAULT) -> str:
    r"""Return a source text in the standard layout, with the operators of a style.

    The styles are ``words``, ``letters``, ``symbols`` and ``unicode``. The syntax tree of the
    result is the same as the tree of ``text``, except for spans and the form of bounds.

    Raises:
        TltlError: the text has syntax errors; or TLT0004, the result would be too large to read.
        KeyError: there is no style with the name ``style``.

    >>> from tltlc.tools.fmt import format_text
    >>> format_text("signal seen:bool  spec hide=G !seen")
    'signal seen: bool\nspec hide = always not seen\n'
    """
    return format_source(SourceFile("<text>", text, "text"), style)


def format_source(source: SourceFile, style: str = DEFAULT) -> str:
    """Return the text of ``source`` in the standard layout, as :func:`format_text` does.

    Errors are the same, but their labels have the name of ``source``.
    """
    module, diagnostics = parse(source)
    if diagnostics:
        raise TltlError(diagnostics)
    try:
        return _format_module(module, STYLES[style])
    except RecursionError:
        from tltlc.automaton.finite.blowup import recursion_room

        # The grammar allows operators to nest 1000 levels deep.
        with recursion_room():
            return _format_module(module, STYLES[style])


_END: Final = 1 << 62


def _format_module(module: Module, style: Style) -> str:
    """Return the text of a module in the standard layout.

    Each ``allow`` comment must apply to the same statements as before. So the layout is repeated
    with more and more constraints, until this is true. At worst, declarations are copied from the
    source as they are.
    """
    constraints = NO_CONSTRAINTS
    while True:
        text = _lay_out(module, style, constraints)
        _check_size(module.source.with_text(text))
        needed = required_constraints(module, text, constraints)
        if needed == constraints:
            return text
        constraints = needed


def _check_size(layout: SourceFile) -> None:
    """Raise TltlError, TLT0004, if the formatted text is too large for the parser."""
    if is_too_large(layout):
        title = f"the layout of `{layout.name}` would have more than 1 MiB, or more than {MAX_TOKENS:,} words and signs"
        help_ = "the file is not changed; to format it, split it: a file may `import` others"
        raise TltlError([Diagnostic("TLT0004", title, help=help_)])


def _lay_out(module: Module, style: Style, constraints: LayoutConstraints) -> str:
    page = Page(module.source, module.comments)
    declarations = DeclarationPrinter(module.source, page, OneLinePrinter(module.source, style), constraints.joints)
    for declaration in module.declarations:
        start = declaration.span.start
        page.put_comments(start, 0, gaps=True)
        page.put_gap(start)
        page.begin(start in constraints.joints, 0)
        if start in constraints.declarations:
            page.put_source(declaration.span)
        else:
            declarations.put(declaration)
    page.put_comments(_END, 0, gaps=True)
    return page.text()
