"""The readings of an English sentence: the clauses that it may mean."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from importlib.util import find_spec
from itertools import islice, product
from typing import TYPE_CHECKING, Any, Final

from tltlc.core.record import record
from tltlc.grammar.english.events import Crossing
from tltlc.grammar.english.forms import Form, Part, forms
from tltlc.grammar.english.orders import Orders
from tltlc.grammar.english.periods import Periods
from tltlc.grammar.english.phrases import grammar_text
from tltlc.grammar.english.rules import Reading, Rules
from tltlc.grammar.english.terminals import UNKNOWN, Term, known_terms, terms
from tltlc.grammar.english.transitions import Transitions
from tltlc.grammar.mistakes.sentences.states import State
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.grammar.mistakes.sentences.words import Words

if TYPE_CHECKING:
    from lark import Lark

_MOST_READINGS: Final = 3
"""The most readings that a help names."""
_LONGEST_PART: Final = 12
"""The most terminals of a condition in a sentence that is not understood."""
_FIRST: Final = ("BOOL", "ENUM", "INT", "REAL", "PREVIOUS_ENUM", "_LPAR")
"""The terminals with which such a condition begins."""
_EMPTY: Final = frozenset("it he she they we you your my has have had to do does did see so just will would".split())
"""Words that say nothing by themselves."""
_CONTENT: Final = frozenset((*_FIRST, UNKNOWN, "VALUE", "SIGN", "UNIT", "TIME_UNIT"))
"""The terminals that a sentence which is understood has in conditions and times alone."""
_LASTING: Final = frozenset("stays stay remains remain must should never".split())
"""Words of a condition alone that make it a rule for every step."""
_MOST: Final = 64
"""The most ways in which the parts of one phrase are put together."""


class Meanings(Periods, Orders, Transitions):
    """The meanings of all rules of the grammar."""


@record
class Sentence:
    """The readings of a sentence; if there is none, ``limit`` may say why no clause can say it."""

    readings: tuple[Reading, ...] = ()
    limit: str = ""


def sentence(words: Words) -> Sentence:
    """Return the readings of a sentence; none if it is no sentence of the grammar.

    Several lines may be one sentence, or one for each line. Without lark, which the playground does not
    load, no sentence is read.
    """
    if find_spec("lark") is None:
        return Sentence()
    whole = _sentence(words)
    if not whole.readings and not whole.limit and words.word(0) == "keep":
        whole = _sentence(words[1:])
    lines = words.lines()
    if whole.readings or whole.limit or len(lines) < 2:
        return whole
    sentences = [_sentence(line) for line in lines]
    if any(len(line.readings) != 1 for line in sentences):
        return whole
    return Sentence((Reading(tuple(clause for line in sentences for clause in line.readings[0].clauses)),))


def sentence_forms(words: Words) -> tuple[Form, ...]:
    """Return the forms of clauses that a sentence without a reading may mean; none without lark."""
    if find_spec("lark") is None:
        return ()
    _, vocabulary = _parser()
    terminals = [term for term in known_terms(words, vocabulary) if term.text not in _EMPTY]
    rules = Meanings(words.names)
    if any(term.kind == UNKNOWN or (term.kind == "BOOL" and term.declared is None) for term in terminals):
        return ()
    parts: list[Part] = []
    at = 0
    while at < len(terminals):
        state, stop = _condition(terminals, at, rules)
        if state is not None:
            parts.append(state)
        elif [term.kind for term in terminals[at : at + 2]] == ["NUMBER", "TIME_UNIT"]:
            parts.append(rules.duration(*terminals[at : at + 2]))
            stop = at + 2
        else:
            parts.append(terminals[at])
        at = stop
    if any(isinstance(part, Term) and part.kind in _CONTENT for part in parts):
        return ()  # no form would say all of it
    return tuple(form for form in forms(parts) if is_valid((form.clause,)))


def _condition(terminals: Sequence[Term], start: int, rules: Rules) -> tuple[State | None, int]:
    """Return the longest condition that begins at an index, and where it ends; else None and the next index."""
    from lark import Token, Tree
    from lark.exceptions import UnexpectedInput

    parser, _ = _parser()
    if terminals[start].kind not in _FIRST:
        return None, start + 1
    for stop in range(min(len(terminals), start + _LONGEST_PART), start, -1):
        if terminals[stop - 1].kind in (UNKNOWN, "_COMMA"):
            continue
        try:
            tree = parser.parse([Token(term.kind, term) for term in terminals[start:stop]], start="part")
        except UnexpectedInput:
            continue
        assert isinstance(tree, Tree)
        for state in _values(tree.children[0], rules):
            if isinstance(state, State):
                return state, stop
    return None, start + 1


def _sentence(words: Words) -> Sentence:
    from lark import Token, Tree
    from lark.exceptions import UnexpectedInput

    parser, vocabulary = _parser()
    terminals = terms(words, vocabulary)
    if not terminals:
        return Sentence()
    try:
        tree = parser.parse([Token(term.kind, term) for term in terminals], start="start")
    except UnexpectedInput:
        return Sentence()
    assert isinstance(tree, Tree)
    unique: dict[tuple[str, ...], Reading] = {}
    rules = Meanings(words.names)
    rules.is_lasting = any(term.text in _LASTING for term in terminals)
    for reading in _values(tree.children[0], rules):
        unique.setdefault(reading.clauses, reading)
    if len(unique) > _MOST_READINGS:
        return Sentence()
    return Sentence(tuple(unique.values()), next(iter(rules.limits), ""))


@lru_cache(maxsize=1)
def _parser() -> tuple[Lark, Mapping[str, str]]:
    """Return the parser, and the terminals of the English words; it is built at the first mistake alone."""
    from pathlib import Path

    from lark import Lark
    from lark.lexer import Lexer

    class Terms(Lexer):
        def __init__(self, conf: Any) -> None:
            pass

        def lex(self, data: Any, parser_state: Any = None) -> Iterator[Any]:
            return iter(data)

    structure = Path(__file__).with_name("sentences.lark").read_text(encoding="utf-8")
    parser = Lark(
        f"{structure}\n{grammar_text()}\n", parser="earley", lexer=Terms, ambiguity="explicit", start=["start", "part"]
    )
    words = {terminal.pattern.value: terminal.name for terminal in parser.terminals if terminal.pattern is not None}
    return parser, words


def _values(node: Any, rules: Rules) -> list[Any]:
    """Return what a node of the tree may mean; equal meanings of an ambiguous node count once."""
    if isinstance(node, str):
        return [node.value]  # type: ignore[attr-defined]
    if node.data == "_ambig":
        return _unique([value for child in node.children for value in _values(child, rules)])
    function = getattr(rules, node.data)
    results: list[Any] = []
    for parts in islice(product(*(_values(child, rules) for child in node.children)), _MOST):
        value = function(*parts)
        if isinstance(value, list):
            results += value
        elif value is not None:
            results.append(value)
    return _unique(results)


def _unique(values: list[Any]) -> list[Any]:
    """Return the different values; the crossing of a limit is also read as the state behind it, which is left out."""
    crossed = [value.state for value in values if isinstance(value, Crossing)]
    different: list[Any] = []
    for value in values:
        if value not in different and value not in crossed:
            different.append(value)
    return different
