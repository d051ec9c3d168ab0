"""Describe where parsing a piece of text failed, and what could stand there, in plain words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, replacement_fix
from tltlc.grammar import lalr
from tltlc.grammar.keywords import CLAUSES, DECLARATIONS, TEST_ITEMS
from tltlc.grammar.lexer import END, Token, tokenize
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.past_words import FUNCTIONS
from tltlc.grammar.tables import load

KEYWORDS: Final = {"declaration": DECLARATIONS, "clause": CLAUSES, "test_item": TEST_ITEMS}
NOUNS: Final = {"declaration": "declaration", "clause": "clause", "test_item": "line of a test"}
"""Maps a nonterminal to its name in messages. A nonterminal that is not listed is called a formula."""

OPENING: Final = {"LPAR": "RPAR", "LSQB": "RSQB", "LBRACE": "RBRACE"}
CLOSING: Final = frozenset(OPENING.values())
COMPARISONS: Final = {"LESS", "AT_MOST", "MORE", "AT_LEAST", "EQUALS", "UNEQUAL"}
ARITHMETIC: Final = {"PLUS", "MINUS", "TIMES_SIGN", "DIVIDE", "POWER", *COMPARISONS}
UNTILS: Final = {"UNTIL", "WEAK_UNTIL", "RELEASE", "STRONG_RELEASE"}
INFIX: Final = {"AND", "OR", "IMPLIES", "IFF", "THEN", *UNTILS}
BEFORE_ONE: Final = {"EVENTUALLY", "ALWAYS", "NEXT", "WEAK_NEXT", "NOT"}
OPERAND: Final = {"NAME", "NUMBER", "LPAR"}
_KINDS: Final = {"NAME": "a name", "NUMBER": "a number", "STRING": "a text in quotes", "UNIT": "a unit"}
_FEW: Final = 4
"""The most alternatives that a title lists."""


class ParseFailure:
    """A syntax error in one piece of text: the token that does not fit, and the tokens around it.

    ``tokens`` are the tokens of one piece: a declaration, a clause, a line of a test, or a formula.
    The parser read the piece as the nonterminal ``start``, and ended with the error ``stop``.
    """

    def __init__(
        self, source: SourceFile, tokens: Sequence[Token], stop: lalr.UnexpectedTokenError, start: str
    ) -> None:
        self.source = source
        self.tokens = tokens
        self.stop = stop
        self.start = start

    @property
    def token(self) -> Token:
        """The token that does not fit."""
        return self.tokens[self.stop.index]

    @property
    def previous_token(self) -> Token | None:
        """The token before :attr:`token`, or None if it is the first."""
        return self.tokens[self.stop.index - 1] if self.stop.index else None

    @property
    def is_at_end(self) -> bool:
        """Whether parsing failed because the piece of text ends too early."""
        return self.token.type == END

    @cached_property
    def allowed_terminals(self) -> set[str]:
        """The terminals that could stand in place of :attr:`token`."""
        tables = load()
        return lalr.allowed_terminals(tables, lalr.stack_after(tables, self.start, self.tokens[: self.stop.index]))

    @property
    def wants_operand(self) -> bool:
        """Whether a formula or a number could begin at :attr:`token`."""
        return self.allowed_terminals >= OPERAND

    @property
    def wants_operator(self) -> bool:
        """Whether a formula could end at :attr:`token`, or continue with an operator."""
        return "AND" in self.allowed_terminals

    @cached_property
    def open_brackets(self) -> list[Token]:
        """The brackets that are open at :attr:`token`, outermost first."""
        stack: list[Token] = []
        for token in self.tokens[: self.stop.index]:
            if token.type in OPENING:
                stack.append(token)
            elif stack and token.type == OPENING[stack[-1].type]:
                stack.pop()
        return stack

    def form(self) -> str | None:
        """Return a help text such as "the form is `keep a`"; None if the piece does not begin with a known keyword."""
        form = KEYWORDS.get(self.start, {}).get(self.tokens[0].text)
        return f"the form is {form}" if form else None

    def error(
        self,
        code: str,
        title: str,
        help_: str | None,
        message: str = "",
        span: Span | None = None,
        *,
        write: str | None = None,
    ) -> Diagnostic:
        """Return an error at ``span``, with ``message`` under its caret.

        Without ``span``, the error is at :attr:`token`, or at the last token if the piece ends too
        early. The error has a fix that replaces the span by ``write``, unless ``write`` is None or needs
        a fixed clock that the file does not have, or the span contains a comment.
        """
        if span is None:
            span = self.previous_token.span if self.is_at_end and self.previous_token else self.token.span
        is_fix = write is not None and not self._has_comment(span) and not self.lacks_fixed_clock(write)
        fixes = (replacement_fix(self.source, span, write),) if is_fix and write is not None else ()
        return Diagnostic(code, title, (Label(self.source, span, message),), help_, fixes=fixes)

    @property
    def clock_varies(self) -> bool:
        """Whether the file declares `clock varies`."""
        return declared_names(self.source).clock_varies

    def lacks_fixed_clock(self, text: str) -> bool:
        """Whether the clock varies, and a part of the piece, as in ``next after 2 s a``, needs a fixed clock."""
        if not self.clock_varies or self.start == "test_item":
            return False
        tokens = tokenize(text).tokens
        units = {unit.text for number, unit in pairwise(tokens) if number.type == "NUMBER" and unit.type != END}
        if "LIMIT" in (self.tokens[0].type, tokens[0].type):
            return bool(units & {"ms", "s", "min", "h"})
        delays = any(a.type in ("NEXT", "WEAK_NEXT") and b.text == "after" for a, b in pairwise(tokens))
        return delays or bool(units & {"step", "steps"})

    def _has_comment(self, span: Span) -> bool:
        """Whether a comment lies between the tokens of a span."""
        text = self.source.text
        inside = [token for token in self.tokens if span.start <= token.start and token.end <= span.end]
        return any("//" in text[left.end : right.start] for left, right in pairwise(inside))

    def misplaced(self, token: Token | None) -> str:
        """Return a title for a word that stands where an operator could: "the language has no word `unless`".

        Words of the language, names of the file and signs cannot stand there.
        """
        word = token.text if token else ""
        known = (load().words, load().soft, FUNCTIONS, declared_names(self.source).names)
        is_known = any(word in words for words in known)
        is_foreign = not is_known and word.isidentifier()
        return (
            f"the language has no word {quote_token(token)}"
            if is_foreign
            else f"{quote_token(token)} cannot stand here"
        )

    def expectation(self) -> str:
        """Return a title for the error: "expected a formula after `keep`, found `)`"."""
        before = f" after {quote_token(self.previous_token)}" if self.previous_token else ""
        actual = "" if self.is_at_end else f", found {quote_token(self.token)}"
        return f"expected {self.alternatives()}{before}{actual}"

    def alternatives(self) -> str:
        """Return what could stand in place of :attr:`token`, in plain words: "a name or a number"."""
        if self.wants_operand:
            if self.previous_token and self.previous_token.type in ARITHMETIC:
                return "a value"
            return "an expression" if self.tokens[0].type in ("PREDICATE", "PARAM", "SIGNAL") else "a formula"
        allowed = set(self.allowed_terminals)
        items = []
        if self.wants_operator:
            items.append("an operator")
            allowed -= INFIX | ARITHMETIC | {"UNIT", "LPAR", "IS", "SINCE"}
        items += [text for kind, text in _KINDS.items() if kind in allowed]
        signs = _spellings({**load().soft, **load().signs})
        items += [f"`{signs[kind]}`" for kind in sorted(allowed) if kind in signs]
        words = _spellings(load().words)
        keywords = [f"`{words[kind]}`" for kind in sorted(allowed) if kind in words]
        if len(keywords) <= _FEW:
            items += keywords
        if END in allowed and len(items) < 2:
            items.append(f"the end of the {NOUNS.get(self.start, 'formula')}")
        items = items[:_FEW] or [f"a {NOUNS.get(self.start, 'formula')}"]
        return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} or {items[-1]}"


def outer_indices(tokens: Sequence[Token], start: int, stop: int) -> Iterator[int]:
    """Yield the indices from ``start`` up to ``stop``, without those of tokens inside brackets.

    The outermost brackets themselves are included.
    """
    depth = 0
    for index in range(start, stop):
        depth -= tokens[index].type in CLOSING
        if depth <= 0:
            yield index
        depth += tokens[index].type in OPENING


def are_adjacent(left: Token, right: Token) -> bool:
    """Whether nothing stands between two tokens, not even a space."""
    return left.end == right.start


def quote_token(token: Token | None) -> str:
    """Return the text of a token in backticks, shortened for a title."""
    text = token.text if token else ""
    return f"`{text}`" if len(text) <= 30 else f"`{text[:29]}…`"


def _spellings(terminals: dict[str, str]) -> dict[str, str]:
    """Map each terminal to one of its spellings, in ASCII if there is one."""
    return {terminal: text for text, terminal in sorted(terminals.items(), key=lambda item: item[0].isascii())}
