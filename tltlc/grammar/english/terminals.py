"""Turn the words of a clause into the terminals of the grammar of English sentences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.english.changed_arguments import with_changes
from tltlc.grammar.english.phrases import DROPPED, PHRASES
from tltlc.grammar.keywords import UNITS_ELSEWHERE
from tltlc.grammar.mistakes.declared_names import DeclaredName
from tltlc.grammar.mistakes.sentences.kinds import call_end
from tltlc.grammar.mistakes.sentences.words import Words

_SIGNS: Final = {
    "LESS": "SIGN", "AT_MOST": "SIGN", "MORE": "SIGN", "AT_LEAST": "SIGN", "EQUALS": "_EQUALS", "UNEQUAL": "_UNEQUAL",
    "EQUAL": "_EQUALS", "PLUS": "PLUS", "MINUS": "MINUS", "TIMES_SIGN": "MUL", "DIVIDE": "DIV", "LPAR": "_LPAR",
    "RPAR": "_RPAR", "LBRACE": "_LBRACE", "RBRACE": "_RBRACE", "COMMA": "_COMMA", "COLON": "_COLON",
    "LSQB": "_LBRACKET", "RSQB": "_RBRACKET",
}  # fmt: skip
_TIME_UNITS: Final = ("s", "ms", "min", "h", "step", "steps")
_TOTALS: Final = ("total_time", "total_time_since", "total_time_within")
_VALUES: Final = ("value_at", "highest_since", "lowest_since", "highest_within", "lowest_within")
"""Functions whose value is one that their first argument had."""
_COUNTS: Final = ("times", "times_since", "times_within")
_ARITHMETIC: Final = ("+", "-", "*", "/", "^")
_NUMBERS: Final = ("previous", "initial", "highest", "lowest", "time_since", "time_holding", "abs", "min", "max")
_BEFORE_PERIODS: Final = ("in", "within", "during", "over", "from", "any", "for")
_WHOLE: Final = ("whole", "entire")
"""Words before a noun that stands for all of play, although it may be a value, too: `in the whole run`."""
_ORDINALS: Final = {"1": "first", "2": "second", "3": "third", "4": "fourth", "5": "fifth"}
_ENDINGS: Final = {"1": "st", "2": "nd", "3": "rd", "4": "th", "5": "th"}
_LETTERS: Final = {"Y": "previously", "O": "once", "H": "historically", "S": "since"}
"""Maps the letters of logic for the past to words."""
UNKNOWN: Final = "UNKNOWN"
"""The kind of a word that no sentence of the grammar has."""
_PREVIOUS: Final = ("previous", "prev")
_EQUALITIES: Final = ("EQUALS", "UNEQUAL", "EQUAL")
_BEFORE_VALUES: Final = frozenset(
    word
    for name in ("is", "is_not", "becomes", "leaves", "was")
    for phrase in PHRASES[name].split("|")
    for word in phrase.split()
)
"""Words between an enum and its value."""
CALLED: Final = frozenset(
    "within after on when if next finally count duration cooldown abs time_in hold_time total".split()
)
"""Words of the grammar that people write with brackets behind them, as functions."""


@record
class Term:
    """A terminal of the grammar: its kind, its text in the language, and the declaration of a name."""

    kind: str
    text: str
    declared: DeclaredName | None = None


def terms(words: Words, vocabulary: Mapping[str, str]) -> list[Term] | None:
    """Return the terminals of words; None if one has no meaning in a sentence.

    ``vocabulary`` maps the English words of the grammar to their terminals.
    """
    found = known_terms(words, vocabulary)
    return None if any(term.kind == UNKNOWN for term in found) else found


def known_terms(words: Words, vocabulary: Mapping[str, str]) -> list[Term]:
    """Return the terminals of words; those that have no meaning in a sentence are ``UNKNOWN``."""
    return list(_terms(words, vocabulary))


def _terms(words: Words, vocabulary: Mapping[str, str]) -> Iterator[Term]:
    at = 0
    while at < len(words):
        word, start = words[at], at
        at += 1
        if word.text in CALLED and word.text not in words.names.names and word.text in vocabulary:
            yield Term(vocabulary[word.text], word.text)
        elif (letter := _LETTERS.get(words[start:at].text)) and letter not in words.names.names:
            yield Term(vocabulary[letter], letter)
        elif word.is_name:
            if _is_value(words, start):
                yield Term("VALUE", word.text)
                continue
            at = call_end(words, start)
            following = words[at:] if words[start - 1 : start].text not in _ARITHMETIC else words[:0]
            yield _name(words[start:at], following) or Term(UNKNOWN, words[start:at].text)
            if at < len(words) and words[at].text == "'":
                at += 1
                yield Term("PRIME", "'")
        elif word.text == ";":
            yield Term("_SEMICOLON", ";")
        elif word.type == "IMPLIES" and words[start:at].text != "implies":
            yield Term("_ARROW", "->")
        elif word.type == "OR" and words[start:at].text == "|":
            yield Term("_BAR", "|")
        elif word.text == "@":
            yield Term("_AT_SIGN", "@")
        elif word.text == "[" and (bound := _bound(words, at)):
            at, number, unit = bound
            yield from (Term(vocabulary["for" if words.word(start - 1) == "always" else "within"], "within"),)
            yield from (Term("NUMBER", number), Term("TIME_UNIT", unit))
        elif word.text in ("a", "an") and _unit(words.word(at)) in _TIME_UNITS:
            yield Term("NUMBER", "1")
            yield Term("TIME_UNIT", _unit(words.word(at)))
            at += 1
        elif word.type in _SIGNS and word.text not in ("min", "max"):
            if word.type == "EQUAL" and at < len(words) and words[at].type == "MORE":
                at += 1
                yield Term("_ARROW", "=>")
            elif not (word.type in ("LESS", "AT_MOST") and _is_time_limit(words, start)):
                yield Term(_SIGNS[word.type], word.text)
        elif word.text == "just" and words.word(at) == "after":
            yield Term(vocabulary["right"], "right")
        elif word.text == "one" and (words.word(at) == "of" or _is_article(words, start)):
            yield Term(vocabulary["one"], "one")
        elif not word.is_name and _is_value(words, start):
            yield Term("VALUE", word.text)
        elif words.word(at) == _ENDINGS.get(word.text) and (text := _ORDINALS[word.text]) in vocabulary:
            yield Term(vocabulary[text], text)
            at += 1
        elif number := words.number(start):
            yield Term("NUMBER", number)
        elif words.word(start - 1) in _WHOLE and word.text in vocabulary:
            yield Term(vocabulary[word.text], word.text)
        elif any(words[start:at].text in known.values for known in words.names.names.values()):
            yield Term("VALUE", words[start:at].text)
        elif start and words.number(start - 1) and (unit := _unit(word.text)) and word.text not in words.names.names:
            yield Term("TIME_UNIT" if unit in _TIME_UNITS else "UNIT", unit)
        elif words[start - 1 : at].text == "every second" and at < len(words) and words[at].is_name:
            yield Term(vocabulary["second"], "second")
        elif words.word(start - 1) in ("per", "every", "each") and _unit(word.text) in ("s", "min", "h"):
            yield Term("NUMBER", "1")
            yield Term("TIME_UNIT", _unit(word.text))
        elif word.type == "UNIT" or (word.text == "%" and start):
            yield Term("UNIT", word.text)
        elif word.text in vocabulary:
            yield Term(vocabulary[word.text], word.text)
        elif word.text not in DROPPED:
            yield Term(UNKNOWN, word.text)


def _is_value(words: Words, at: int) -> bool:
    """Whether a name that is also a value of an enum stands as that value: behind the enum and words such as `is`."""
    before = at - 1
    while before >= 0 and (words[before].type in _EQUALITIES or words.word(before) in _BEFORE_VALUES):
        before -= 1
    declared = words.declared(before)
    return declared is not None and declared.type == "enum" and words[at].text in declared.values


def _is_article(words: Words, at: int) -> bool:
    """Whether `one` stands for `a`: in `in one fight`, and not in `at most one fight`."""
    return words.word(at - 1) in _BEFORE_PERIODS and at + 1 < len(words) and words[at + 1].is_name


def _is_time_limit(words: Words, at: int) -> bool:
    """Whether a sign stands between `in` and a time: `in < 90 s`."""
    is_unit = at + 2 < len(words) and _unit(words[at + 2].text) in _TIME_UNITS
    return words.word(at - 1) in ("in", "within") and bool(words.number(at + 1)) and is_unit


def _bound(words: Words, at: int) -> tuple[int, str, str] | None:
    """Return the index after `[<=5 s]` or `[0, 5 s]`, and the number and the unit of its time; else None.

    ``at`` is the index after the bracket.
    """
    first = words[at : at + 2].text.replace(" ", "")
    start = at + 2 if first == "0," else at + 1
    number, unit = words.number(start), _unit(words[start + 1].text) if start + 2 < len(words) else ""
    is_bound = first == "0," or words[at : at + 1].text in ("<=", "<")
    return (start + 3, number, unit) if is_bound and number and unit and words[start + 2].text == "]" else None


def _unit(word: str) -> str:
    unit = UNITS_ELSEWHERE.get(word.lower(), word)
    return unit if unit in (*_TIME_UNITS, "Hz") else ""


def _name(words: Words, following: Words) -> Term | None:
    """Return the terminal of a name, perhaps with arguments, and with what stands behind it."""
    name, text = words[0].text, with_changes(words, following)
    declared = words.names.names.get(name)
    if declared is None:
        inner = words[2:-1] if len(words) > 2 else words[:0]
        of = inner.declared(0) if len(inner) == 1 else None
        if name in _PREVIOUS and of is not None and of.type == "enum":
            return Term("PREVIOUS_ENUM", inner.text, of)
        if name.startswith(("previous(", "initial(", "lowest(", "highest(")):
            return _value_of(words.names.names.get(name.partition("(")[2].rstrip(")")), text)
        if name.startswith("times(") or name in _COUNTS:
            return Term("INT", text)
        if name in _TOTALS:
            return Term("REAL", text)
        if name in _VALUES or (name == "previous" and len(words) > 4):
            return _value_of(words.declared(2), text)
        return _value_of(of, text) if name in _NUMBERS else Term("BOOL", text)
    if any(declared_inside.members for at in range(len(words)) if (declared_inside := words.declared(at))):
        return None  # a group, which stands for several values
    is_called = len(words) > 1
    if bool(declared.parameters) != is_called:
        return None
    if declared.type == "enum":
        return Term("ENUM", text, declared)
    if declared.type == "int":
        return Term("INT", text, declared)
    if declared.type == "bool" or declared.keyword in ("predicate", "let"):
        return Term("BOOL", text, declared)
    return Term("REAL", text, declared) if declared.type else None


def _value_of(declared: DeclaredName | None, text: str) -> Term:
    return Term("INT" if declared is not None and declared.type == "int" else "REAL", text, declared)
