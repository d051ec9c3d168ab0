"""The parser of the grammar of English sentences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from functools import lru_cache
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Final

from tltlc.grammar.english.phrases import grammar_text
from tltlc.grammar.english.terminals import Term

if TYPE_CHECKING:
    from lark import Tree

_STARTS: Final = ("start", "part")
"""The rules for a whole sentence, and for a condition within one."""


class SentenceParser:
    """lark's Earley parser, which predicts only rules that the terminals of the sentence can end.

    The grammar has 12,000 predictions, because each phrase is a rule. With those that a sentence can
    use, a parse takes a hundredth of the time, and returns the same tree.
    """

    def __init__(self) -> None:
        from pathlib import Path

        from lark import Lark
        from lark.lexer import Lexer

        class Terms(Lexer):
            def __init__(self, conf: Any) -> None:
                pass

            def lex(self, data: Any, parser_state: Any = None) -> Iterator[Any]:
                return iter(data)

        structure = Path(__file__).with_name("sentences.lark").read_text(encoding="utf-8")
        text = f"{structure}\n{grammar_text()}\n"
        lark = Lark(text, parser="earley", lexer=Terms, ambiguity="explicit", start=[*_STARTS])
        self.vocabulary: Mapping[str, str] = {
            terminal.pattern.value: terminal.name for terminal in lark.terminals if terminal.pattern is not None
        }
        """Maps the English words of the grammar to their terminals."""
        self._frontend: Any = lark.parser
        self._predictions: Mapping[Any, list[Any]] = lark.parser.parser.predictions

    def parse(self, terminals: Sequence[Term], start: str = "start") -> Tree[Any] | None:
        """Return all parses of terminals as one tree; None if they are no sentence, or no ``part`` of one."""
        from lark import Token, Tree
        from lark.exceptions import UnexpectedInput

        frontend = copy(self._frontend)
        frontend.parser = copy(frontend.parser)
        frontend.parser.predictions = self._usable({term.kind for term in terminals})
        try:
            tree = frontend.parse([Token(term.kind, term) for term in terminals], start)
        except UnexpectedInput:
            return None
        assert isinstance(tree, Tree)
        return tree

    def _usable(self, kinds: set[str]) -> dict[Any, list[Any]]:
        """Return the predictions of the rules that these kinds of terminals can end."""
        every = {rule for rules in self._predictions.values() for rule in rules}
        left = [rule for rule in every if all(symbol.name in kinds for symbol in rule.expansion if symbol.is_term)]
        usable: set[Any] = set()
        ended: set[Any] = set()
        while found := {rule for rule in left if all(part.is_term or part in ended for part in rule.expansion)}:
            usable |= found
            ended |= {rule.origin for rule in found}
            left = [rule for rule in left if rule not in found]
        return {symbol: [rule for rule in rules if rule in usable] for symbol, rules in self._predictions.items()}


@lru_cache(maxsize=1)
def sentence_parser() -> SentenceParser | None:
    """Return the parser, which is built at the first mistake alone; None without lark."""
    return SentenceParser() if find_spec("lark") is not None else None
