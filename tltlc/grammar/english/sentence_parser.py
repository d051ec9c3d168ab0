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
        self._rules = _Rules(self._predictions)

    def parse(self, terminals: Sequence[Term], start: str = "start") -> Tree[Any] | None:
        """Return all parses of terminals as one tree; None if they are no sentence, or no ``part`` of one."""
        from lark import Token, Tree
        from lark.exceptions import UnexpectedInput

        frontend = copy(self._frontend)
        frontend.parser = copy(frontend.parser)
        frontend.parser.predictions = self._usable(frozenset(term.kind for term in terminals))
        try:
            tree = frontend.parse([Token(term.kind, term) for term in terminals], start)
        except UnexpectedInput:
            return None
        assert isinstance(tree, Tree)
        return tree

    def _usable(self, kinds: frozenset[str]) -> dict[Any, list[Any]]:
        """Return the predictions of the rules that these kinds of terminals can end."""
        return self._rules.usable(kinds)


class _Rules:
    """The rules of a grammar by their numbers, because sets of lark's rules are slow."""

    def __init__(self, predictions: Mapping[Any, Sequence[Any]]) -> None:
        rules = list({rule: None for predicted in predictions.values() for rule in predicted})
        numbers = {rule: number for number, rule in enumerate(rules)}
        self._predictions = {
            symbol: [(numbers[rule], rule) for rule in predicted] for symbol, predicted in predictions.items()
        }
        self._needs = [
            (
                frozenset(part.name for part in rule.expansion if part.is_term),
                frozenset(part for part in rule.expansion if not part.is_term),
            )
            for rule in rules
        ]
        """The terminals and the nonterminals of each expansion."""
        self._origins = [rule.origin for rule in rules]
        self._with: dict[Any, list[int]] = {}
        """Maps each nonterminal to the rules whose expansions have it."""
        for number, (_, parts) in enumerate(self._needs):
            for part in parts:
                self._with.setdefault(part, []).append(number)

    def usable(self, kinds: frozenset[str]) -> dict[Any, list[Any]]:
        """Return the predictions of the rules that these kinds of terminals can end."""
        missing = [len(parts) if terminals <= kinds else -1 for terminals, parts in self._needs]
        """How many nonterminals of a rule are not known to end; -1 if a terminal is missing."""
        waiting = [number for number, count in enumerate(missing) if count == 0]
        ended: set[Any] = set()
        usable: set[int] = set()
        while waiting:
            number = waiting.pop()
            usable.add(number)
            origin = self._origins[number]
            if origin in ended:
                continue
            ended.add(origin)
            for other in self._with.get(origin, ()):
                missing[other] -= 1
                if missing[other] == 0:
                    waiting.append(other)
        return {
            symbol: [rule for number, rule in predicted if number in usable]
            for symbol, predicted in self._predictions.items()
        }


@lru_cache(maxsize=1)
def sentence_parser() -> SentenceParser | None:
    """Return the parser, which is built at the first mistake alone; None without lark."""
    return SentenceParser() if find_spec("lark") is not None else None
