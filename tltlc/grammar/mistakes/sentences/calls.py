"""Rewrite functions of other languages: ``prev(gold)``, ``rising(planted)``, ``start(gold)``, and bodies in braces."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.mistakes.sentences.kinds import call_end, is_event, is_value
from tltlc.grammar.mistakes.sentences.words import Word, Words

_BEFORE: Final = ("prev", "pre", "old", "previous", "last")
_FIRST: Final = ("start", "first", "at_start")
_EDGES: Final = {
    **dict.fromkeys(("rise", "rising", "rises", "rose", "rising_edge"), "begins"),
    **dict.fromkeys(("fall", "falling", "falls", "fell", "falling_edge"), "ends"),
}
"""Maps functions for a change of a bool to the operator that says the same."""
_EXTREMES: Final = {
    **dict.fromkeys(("min", "minimum", "lowest", "smallest"), "lowest"),
    **dict.fromkeys(("max", "maximum", "highest", "largest", "biggest"), "highest"),
}
FOREIGN: Final = frozenset((*_BEFORE, *_FIRST, *_EDGES, "count"))
"""The functions of other languages that are rewritten."""


def with_own_calls(words: Words) -> Words:
    """Return the words with the operators and functions of the language in place of those of other languages."""
    found: list[Word] = []
    at = 0
    while at < len(words):
        stop, own = _own(words, at)
        found += own
        at = stop
    if len(found) > 1 and found[0].text == "on" and found[1].text in ("begins", "ends"):
        found[0] = _word("when", found[0])
    return words.of(found)


def without_braces(words: Words) -> Words:
    """Return the words of `if (a) { avoid b }` as `while (a), avoid b`: a body counts at each step."""
    braces = [at for at, word in enumerate(words) if word.text in ("{", "}")]
    is_body = len(braces) == 2 and words[braces[0]].text == "{" and braces[1] == len(words) - 1
    if not is_body or words.word(0) not in ("if", "while"):
        return words
    condition, body = words[: braces[0]], words[braces[0] + 1 : -1]
    each = [_word("while", condition[0])]
    return words.of((*each, *condition[1:], _word(",", words[braces[0]], "COMMA"), *body))


def _own(words: Words, at: int) -> tuple[int, list[Word]]:
    """Return the index after a word and its arguments, and the words that say the same in the language."""
    text = words[at].text
    if text in ("count", "times") and text not in words.names.names and (counted := _counted(words, at)):
        return counted
    if declared_so_far := _so_far(words, at):
        return declared_so_far
    before = at - 1 - (words.word(at - 1) == "the")
    is_since = text in ("last", "previous") and words.word(before) == "since"
    if is_since or (text == "last" and _is_of_event(words, at)):
        return at + 1, [words[at]]
    is_call = at + 1 < len(words) and words[at + 1].text == "("
    stop = call_end(words, at)
    inner = words[at + 2 : stop - 1] if is_call else words[at + 1 : at + 2]
    declared = inner.declared(0) if len(inner) else None
    if text in words.names.names or not (text in _BEFORE or (is_call and (text in _FIRST or text in _EDGES))):
        return at + 1, [words[at]]
    stop = stop if is_call else at + 2
    if text in _EDGES and is_event(inner):
        return stop, [_word(_EDGES[text], words[at]), *inner]
    if text in _BEFORE and is_event(inner) and (is_call or text != "last"):
        return stop, [_word("previously", words[at]), *inner]
    if declared is not None and declared.type != "enum" and is_value(inner) and text not in _EDGES:
        name = "initial" if text in _FIRST else "previous"
        return stop, [_word(f"{name}({inner.text})", words[at], is_name=True)]
    return at + 1, [words[at]]


def _is_of_event(words: Words, at: int) -> bool:
    """Whether `last` is about an event: in `since the last alarm` and `gold at the last save`."""
    before = at - 1 - (words.word(at - 1) in ("the", "my", "your"))
    return words.word(before) in ("since", "at", "when", "from", "on")


def _so_far(words: Words, at: int) -> tuple[int, list[Word]] | None:
    """Return `lowest(x)` for `min(x so far)`."""
    stop, function = call_end(words, at), _EXTREMES.get(words[at].text.lower(), "")
    inner = words[at + 2 : stop - 1]
    if not function or len(inner) < 3 or [inner.word(-2 % len(inner)), inner.word(len(inner) - 1)] != ["so", "far"]:
        return None
    name = inner[:-2]
    return (stop, [_word(f"{function}({name.text})", words[at], is_name=True)]) if is_value(name) else None


def _counted(words: Words, at: int) -> tuple[int, list[Word]] | None:
    """Return `times(p)` for `count(rising p)`: how often p has begun to hold."""
    stop = call_end(words, at)
    inner = words[at + 2 : stop - 1]
    if stop <= at + 1 or not inner or inner[0].text not in _EDGES:
        return None
    event = inner[1:]
    if event and event[0].text == "(" and event[-1].text == ")":
        event = event[1:-1]
    is_begun = _EDGES[inner[0].text] == "begins" and is_event(event)
    return (stop, [_word(f"times({event.text})", words[at], is_name=True)]) if is_begun else None


def _word(text: str, word: Word, type_: str = "NAME", *, is_name: bool = False) -> Word:
    return Word(text, type_, is_name, word.start, word.end, True)
