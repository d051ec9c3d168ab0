"""The LALR(1) parser: it turns tokens into a syntax tree, using tables that lark has built."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tltlc.core.source import Span
from tltlc.grammar.lexer import BAD, END, Token
from tltlc.grammar.tables import ParserTables


class UnexpectedTokenError(Exception):
    """Raised when a token does not fit the grammar.

    ``index`` is the index of the token, and ``states`` the parser's stack of states before it.
    """

    def __init__(self, index: int, states: list[int]) -> None:
        super().__init__(index)
        self.index = index
        self.states = states


def run(tables: ParserTables, start: str, tokens: Sequence[Token], builder: object) -> Any:
    """Parse the tokens as the nonterminal ``start``, and return the value that the builder makes of them.

    The last token must be ``$END``. When the parser has read a rule with the action ``name``, it calls
    ``builder.make_name(span, *values)`` with the values that the rule keeps. If the builder has no
    such method, the value of the rule is the list of these values.

    Raises:
        UnexpectedTokenError: a token does not fit the grammar.
    """
    actions, gotos = tables.actions, tables.gotos
    rules = [
        (rule.origin, rule.size, rule.action, rule.keep, getattr(builder, f"make_{rule.action}", None))
        for rule in tables.rules
    ]
    accepting = tables.ends[start]
    states = [tables.starts[start]]
    values: list[Any] = []
    begins: list[int] = []
    end = 0
    for index, token in enumerate(tokens):
        kind = _terminal_of(tables, states, tokens, index)
        while True:
            action = actions[states[-1]].get(kind)
            if action is None:
                raise UnexpectedTokenError(index, states)
            if action >= 0:
                states.append(action)
                values.append(token)
                begins.append(token.start)
                end = token.end
                break
            origin, size, name, keep, make = rules[~action]
            if size == 1 and not name:
                states[-1] = gotos[states[-2]][origin]
            else:
                popped = values[len(values) - size :]
                begin = begins[-size] if size else token.start
                del values[len(values) - size :], begins[len(begins) - size :], states[len(states) - size :]
                kept = _kept_values(popped, keep)
                values.append(kept if make is None else make(Span(begin, max(begin, end)), *kept))
                begins.append(begin)
                states.append(gotos[states[-1]][origin])
            if kind == END and states[-1] == accepting:
                return values[-1]
    raise AssertionError("the tokens do not end with $END")


def stack_after(tables: ParserTables, start: str, tokens: Sequence[Token]) -> list[int]:
    """Return the stack of states of the parser after ``tokens``, the beginning of a text of ``start``.

    The parser may still reduce the stack when it sees the next token.
    """
    try:
        run(tables, start, [*tokens, Token(BAD, "", 0, 0)], None)
    except UnexpectedTokenError as stop:
        return stop.states
    raise AssertionError("no text has a token of type BAD")


def allowed_terminals(tables: ParserTables, states: Sequence[int]) -> set[str]:
    """Return the terminals that the parser accepts next; ``states`` is its stack of states."""
    return {terminal for terminal in tables.actions[states[-1]] if _accepts(tables, list(states), terminal)}


def _accepts(tables: ParserTables, states: list[int], terminal: str) -> bool:
    ends = tables.ends.values()
    while True:
        action = tables.actions[states[-1]].get(terminal)
        if action is None:
            return False
        if action >= 0:
            return True
        rule = tables.rules[~action]
        del states[len(states) - rule.size :]
        states.append(tables.gotos[states[-1]][rule.origin])
        if terminal == END and states[-1] in ends:
            return True


def _terminal_of(tables: ParserTables, states: Sequence[int], tokens: Sequence[Token], index: int) -> str:
    """Return the terminal of the token at ``index``, which the parser reads in the last of its ``states``.

    For most tokens, this is the token's type. An unreserved word, such as ``within``, can be a keyword
    or a name, and the grammar decides which. Where it allows both, the word is a keyword if a number
    follows (``F within 20 steps p``). The unit ``step`` is a unit where no step of a test can begin.
    """
    token = tokens[index]
    soft = tables.soft.get(token.text)
    if soft is None or token.type == "STRING" or soft not in (row := tables.actions[states[-1]]):
        return token.type
    if token.type == "UNIT" and token.type in row:
        return soft if _accepts(tables, list(states), soft) else token.type
    if token.type not in row or tokens[index + 1].type == "NUMBER":
        return soft
    return token.type


def _kept_values(values: list[Any], keep: tuple[int, ...]) -> list[Any]:
    """Return the values that a rule keeps, given the values of its parts.

    :class:`~tltlc.grammar.tables.GrammarRule` explains ``keep``. An absent part is None. The items of
    a list are returned one by one; if the list comes first, it is extended in place.
    """
    # Extend a growing list in place: copying it each time would take quadratic time.
    kept: list[Any] = []
    for place, position in enumerate(keep):
        if position >= 0:
            kept.append(values[position])
        elif position == -1:
            kept.append(None)
        elif place == 0:
            kept = values[-2 - position]
        else:
            kept += values[-2 - position]
    return kept
