"""Parse a .tltl text into its syntax tree.

A text without errors is parsed in one run. If this fails, the text is parsed again, declaration by
declaration and clause by clause (:mod:`tltlc.grammar.mistakes.recovery`), so that each broken part is
reported once.
"""

from __future__ import annotations

from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar import lalr, nesting, tree_checks
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import MAX_TOKENS, Tokens, tokenize
from tltlc.grammar.module import Module
from tltlc.grammar.tables import load
from tltlc.grammar.tree import Declaration, Expr
from tltlc.io.limits import SOURCE

MAX_CHARACTERS: Final = 1 << 20
"""The greatest length of a text, in characters."""


def parse(source: SourceFile) -> tuple[Module, tuple[Diagnostic, ...]]:
    """Return a module with all declarations that can be read, and its syntax errors; never raises.

    After :data:`~tltlc.grammar.mistakes.recovery.MAX_ERRORS` errors, the rest of the text is not
    read.
    """
    lexed = _tokens(source)
    if lexed is None:
        return Module(source, (), ()), (_too_large_error(source),)
    declarations, diagnostics = _declarations(source, lexed)
    in_order = sorted(diagnostics, key=lambda diagnostic: diagnostic.labels[0].span.start)
    return Module(source, declarations, tuple(lexed.comments)), tuple(in_order)


def parse_formula(source: SourceFile) -> tuple[Expr | None, tuple[Diagnostic, ...]]:
    """Parse a text that is one formula; never raises.

    Return its tree, or None if the text cannot be parsed, and the syntax errors that were found.
    """
    lexed = _tokens(source)
    if lexed is None:
        return None, (_too_large_error(source),)
    depth_error = nesting.bracket_depth_error(source, lexed.tokens)
    if depth_error:
        return None, (depth_error,)
    builder = Builder(source, lexed.docs)
    try:
        formula: Expr = lalr.run(load(), "expression", lexed.tokens, builder)
    except lalr.UnexpectedTokenError as error:
        from tltlc.grammar.mistakes.messages import unexpected_token

        return None, (unexpected_token(source, lexed.tokens, error, "expression"),)
    depth_error = nesting.expression_depth_error(source, formula)
    if depth_error:
        return None, (depth_error,)
    return formula, (*builder.diagnostics, *tree_checks.check_formula(source, formula))


def is_too_large(source: SourceFile) -> bool:
    """Whether a text has more bytes than a source file may have, or more tokens than the parser accepts."""
    if len(source.text.encode(errors="replace")) > SOURCE.size:
        return True
    # Each token has at least one character, so most texts need not be tokenized.
    return len(source.text) > MAX_TOKENS and _tokens(source) is None


def _tokens(source: SourceFile) -> Tokens | None:
    """Return the tokens of a text, or None if it has too many characters or tokens."""
    if len(source.text) > MAX_CHARACTERS:
        return None
    lexed = tokenize(source.text)
    return lexed if len(lexed.tokens) <= MAX_TOKENS else None


def _declarations(source: SourceFile, lexed: Tokens) -> tuple[tuple[Declaration, ...], tuple[Diagnostic, ...]]:
    if nesting.bracket_depth_error(source, lexed.tokens) is None:
        builder = Builder(source, lexed.docs)
        try:
            declarations: tuple[Declaration, ...] = lalr.run(load(), "module", lexed.tokens, builder)
        except lalr.UnexpectedTokenError:
            pass
        else:
            shallow, errors = nesting.drop_deep_declarations(source, declarations)
            return shallow, (*builder.diagnostics, *errors, *tree_checks.check(source, shallow))
    from tltlc.grammar.mistakes.recovery import recover

    return recover(source, lexed)


def _too_large_error(source: SourceFile) -> Diagnostic:
    title = f"`{source.name}` is larger than 1 MiB or has more than {MAX_TOKENS:,} words and signs"
    return Diagnostic("TLT0004", title, (Label(source, Span(0, 0)),), "split it into several files, and use `import`")
