"""What a declaration in another form is meant to declare, and a cursor to read it with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.lexer import END, Token

MISSING_ENDS: Final = ("LOW", "HIGH")
"""Stand in a help for the ends of a range that the author did not write."""
MISSING_RANGE: Final = f"in [{', '.join(MISSING_ENDS)}]"


@record
class WholeText:
    """The tokens of a whole file, and the values of each enum that it declares by a name."""

    tokens: Sequence[Token]
    enums: Mapping[str, tuple[str, ...]]


@record
class MeantDeclaration:
    """What a piece of text that cannot be parsed is meant to declare.

    ``noun`` is what it declares: ``clock``, ``signal``, ``entity`` or ``spec``. ``lines`` are the declarations as they
    should be written. ``read_as`` are the declarations with which the rest of the file is checked. They have an
    assumed range where ``lines`` have a placeholder, and there are none if the author may have meant different
    things. ``is_complete`` says whether ``lines`` can replace the text: nothing is left to fill in or to choose.
    ``help`` replaces the usual "write …", and ``reason`` is added to it. ``enums`` are the names of the file's enums
    that stand for a list of values in it.
    """

    noun: str
    lines: tuple[str, ...]
    read_as: tuple[str, ...] = ()
    is_complete: bool = True
    help: str = ""
    reason: str = ""
    enums: tuple[str, ...] = ()


class Cursor:
    """Reads the tokens of a piece from left to right."""

    def __init__(self, tokens: Sequence[Token], at: int = 0) -> None:
        self.tokens = tokens
        self.at = at

    @property
    def token(self) -> Token:
        """The next token; of type ``$END`` after the last one."""
        return self.peek()

    def peek(self, distance: int = 0) -> Token:
        """Return the token at a distance from the next one; of type ``$END`` after the last one."""
        index = self.at + distance
        return self.tokens[index] if index < len(self.tokens) else Token(END, "", 0, 0)

    @property
    def is_done(self) -> bool:
        """Whether all tokens are read."""
        return self.at >= len(self.tokens)

    def accept(self, *texts: str) -> bool:
        """Read the next token if it is one of ``texts``, ignoring capitals; return whether it is."""
        is_next = not self.is_done and self.token.text.lower() in texts
        self.at += is_next
        return is_next

    def accept_words(self, *words: str) -> bool:
        """Read the next tokens if they are these words, ignoring capitals; return whether they are."""
        are_next = all(self.peek(distance).text.lower() == word for distance, word in enumerate(words))
        self.at += len(words) * are_next
        return are_next
