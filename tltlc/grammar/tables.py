"""The LALR(1) tables of the grammar: built with lark, shipped with the package, loaded without lark.

Importing lark takes as long as four bare Python starts. So the package ships the tables as
``tables.json``, in its own format, and parsing does not need lark. If a checksum shows that the grammar
has changed since, the tables are built in memory. ``python -m tltlc.grammar.tables`` rewrites
the file.
"""

from __future__ import annotations

import json
import os
import re
import zlib
from functools import lru_cache
from typing import Any

from tltlc.core.record import record

_FOLDER = os.path.dirname(__file__)  # noqa: PTH120 (pathlib costs the start of a command 5 ms)
GRAMMAR = f"{_FOLDER}/tltl.lark"
TABLES = f"{_FOLDER}/tables.json"
STARTS = ("module", "declaration", "clause", "test_item", "expression")


@record
class GrammarRule:
    """A rule of the grammar, which says how the parser makes one value for the nonterminal ``origin``.

    The parser pops ``size`` values from its stack. It passes those that ``keep`` selects to the
    builder's method ``make_ACTION``, where ACTION is the text in ``action``. An entry of ``keep`` is
    the position of a popped value, ``-1`` for an absent optional part (None), or ``-2 - i`` for a list
    at position i, whose items are passed one by one. There are two special actions: an empty text
    returns the only kept value, and ``*`` returns the list of kept values.
    """

    origin: str
    size: int
    action: str
    keep: tuple[int, ...]


@record
class ParserTables:
    """The tables of the parser and the lexer.

    ``actions[state]`` maps a terminal to the next state (shift) or to ``~rule`` (reduce), where
    ``rule`` is an index of ``rules``. ``gotos[state]`` maps a nonterminal to the next state.
    ``words`` and ``signs`` map each spelling of a reserved word or sign to its terminal. ``soft`` maps
    the words that can also be names, such as ``within``. ``units`` are the spellings of units, longest
    first. ``starts`` and ``ends`` map each nonterminal of ``STARTS`` to its first and its accepting
    state. ``patterns`` maps the other terminals, such as ``NAME``, to regular expressions.
    """

    rules: tuple[GrammarRule, ...]
    actions: tuple[dict[str, int], ...]
    gotos: tuple[dict[str, int], ...]
    starts: dict[str, int]
    ends: dict[str, int]
    words: dict[str, str]
    signs: dict[str, str]
    soft: dict[str, str]
    units: tuple[str, ...]
    patterns: dict[str, str]


@lru_cache(maxsize=1)
def load() -> ParserTables:
    """Return the tables of the current grammar: from the shipped file if its checksum matches, else built with lark."""
    grammar = _read(GRAMMAR)
    try:
        data = json.loads(_read(TABLES))
        fits = data["checksum"] == zlib.crc32(grammar)
    except (OSError, ValueError, KeyError, TypeError):
        fits = False
    return _from_json(data if fits else build(grammar))


def build(grammar: bytes) -> dict[str, Any]:
    """Build the tables of a grammar with lark, and return them as plain data for JSON.

    Raises lark's GrammarError if the grammar has a conflict.
    """
    from lark import Lark
    from lark.lexer import Lexer

    class NoLexer(Lexer):
        """Replaces lark's own lexer, which the tables do not need."""

        def __init__(self, _conf: object) -> None: ...

        def lex(self, *_args: object) -> Any: ...

    lark: Any = Lark(grammar.decode(), parser="lalr", lexer=NoLexer, start=list(STARTS), strict=True)
    table = lark.parser.parser._parse_table
    states = _breadth_first(table)
    rules: dict[Any, int] = {}
    actions: list[dict[str, int]] = []
    gotos: list[dict[str, int]] = []
    for state in states:
        actions.append({})
        gotos.append({})
        for symbol, (action, argument) in sorted(table.states[state].items()):
            if str(action) == "Reduce":
                actions[-1][symbol] = ~rules.setdefault(argument, len(rules))
            elif symbol.isupper():
                actions[-1][symbol] = states[argument]
            else:
                gotos[-1][symbol] = states[argument]
    return {
        "checksum": zlib.crc32(grammar),
        "rules": [[rule.origin.name, len(rule.expansion), *_action(rule)] for rule in rules],
        "rows": (rows := _distinct(actions)),
        "actions": [rows.index(row) for row in actions],
        "gotos": gotos,
        "starts": {start: states[table.start_states[start]] for start in STARTS},
        "ends": {start: states[table.end_states[start]] for start in STARTS},
        **_spellings(lark.terminals),
    }


def _breadth_first(table: Any) -> dict[int, int]:
    """Number lark's states breadth-first, and return the number of each.

    The successors of a state are visited in the order of their symbols, so that the same grammar
    always gives the same file.
    """
    order = {table.start_states[start]: number for number, start in enumerate(STARTS)}
    queue = list(order)
    for state in queue:
        for _, (action, target) in sorted(table.states[state].items(), key=lambda item: item[0]):
            if str(action) == "Shift" and target not in order:
                order[target] = len(order)
                queue.append(target)
    return order


def _action(rule: Any) -> tuple[str, list[int]]:
    """Return the fields ``action`` and ``keep`` of the :class:`GrammarRule` for a rule of lark."""
    absent = [len(run) for run in "".join(str(int(b)) for b in rule.options.empty_indices).split("0")]
    if not rule.options.empty_indices:
        absent = [0] * (len(rule.expansion) + 1)
    keep: list[int] = []
    for position, symbol in enumerate(rule.expansion):
        keep += [-1] * absent[position]
        if not (symbol.is_term and symbol.filter_out):
            spliced = not symbol.is_term and symbol.name.startswith("_")
            keep.append(-2 - position if spliced else position)
    keep += [-1] * absent[-1]
    if rule.origin.name.startswith("_"):
        return "*", keep
    if rule.options.expand1 and not rule.alias and len(keep) == 1 and keep[0] >= 0:
        return "", keep
    return str(rule.alias or rule.origin.name), keep


def _distinct(rows: list[dict[str, int]]) -> list[dict[str, int]]:
    """Return the rows without duplicates, in order of first appearance."""
    distinct: list[dict[str, int]] = []
    for row in rows:
        if row not in distinct:
            distinct.append(row)
    return distinct


def _spellings(terminals: Any) -> dict[str, Any]:
    """Return the fields of :class:`ParserTables` that the lexer uses, from ``words`` to ``patterns``.

    A terminal that is a list of fixed texts has spellings; any other terminal has a pattern.
    """
    words: dict[str, str] = {}
    signs: dict[str, str] = {}
    soft: dict[str, str] = {}
    units: list[str] = []
    patterns: dict[str, str] = {}
    for terminal in sorted(terminals, key=lambda terminal: terminal.name):
        texts = _texts(terminal.pattern)
        if texts is None:
            patterns[terminal.name] = terminal.pattern.value
        elif terminal.name == "UNIT":
            units = sorted(texts, key=lambda text: (-len(text), text))
        else:
            for text in texts:
                word = re.fullmatch("[A-Za-z_]+", text)
                kind = signs if not word else soft if terminal.priority < 0 else words
                kind[text] = terminal.name
    return {"words": words, "signs": signs, "soft": soft, "units": units, "patterns": patterns}


def _texts(pattern: Any) -> list[str] | None:
    """Return the texts that a terminal's pattern lists: ``["G", "always"]`` for ``(?:G|always)``.

    Return None if the pattern is no list of fixed texts.
    """
    if pattern.type == "str":
        return [pattern.value]
    listed = re.fullmatch(r"\(\?:(.*)\)", pattern.value, re.DOTALL)
    if not listed:
        return None
    parts = re.split(r"(?<!\\)\|", listed[1])
    texts = [re.sub(r"\\(.)", r"\1", part) for part in parts]
    return texts if [re.escape(text) for text in texts] == parts else None


def _read(path: str) -> bytes:
    with open(path, "rb") as file:  # noqa: PTH123
        return file.read()


def _from_json(data: dict[str, Any]) -> ParserTables:
    return ParserTables(
        rules=tuple(GrammarRule(origin, size, action, tuple(keep)) for origin, size, action, keep in data["rules"]),
        actions=tuple(data["rows"][row] for row in data["actions"]),
        gotos=tuple(data["gotos"]),
        starts=data["starts"],
        ends=data["ends"],
        words=data["words"],
        signs=data["signs"],
        soft=data["soft"],
        units=tuple(data["units"]),
        patterns=data["patterns"],
    )


def main() -> None:
    """Write the tables of the current grammar to the shipped file."""
    with open(TABLES, "w", encoding="utf-8") as file:  # noqa: PTH123
        file.write(as_text(build(_read(GRAMMAR))))


def as_text(data: dict[str, Any]) -> str:
    """Return the tables as the text of the shipped file."""
    return json.dumps(data, ensure_ascii=False, separators=(",", ":")) + "\n"


if __name__ == "__main__":
    main()
