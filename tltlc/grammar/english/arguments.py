"""Conditions in English as arguments of functions: `times_since(hit, lap goes up)`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tltlc.grammar.english.changed_arguments import changed_name
from tltlc.grammar.mistakes.sentences.kinds import call_end
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.grammar.mistakes.sentences.words import Word, Words, phrases

_CONDITIONS: Final = {
    "times": (0,),
    "times_since": (0, 1),
    "times_within": (0,),
    "time_holding": (0,),
    "time_since": (0,),
    "total_time": (0,),
    "total_time_since": (0, 1),
    "highest_since": (1,),
    "lowest_since": (1,),
    "value_at": (1,),
}
"""Maps functions to the positions of those arguments that are conditions."""

_LAST: Final = phrases("last", "the last", "previous", "the previous")
"""Words before the event from which a function counts, which is always the last one."""

ReadCondition = Callable[[Words], str]
"""Returns the condition that English words say; "" if they say none, or may say several."""


def with_read_arguments(words: Words, read: ReadCondition) -> Words:
    """Return the words with a condition of the language for each argument in English that says one."""
    at = 0
    while at < len(words):
        stop = call_end(words, at)
        positions = _CONDITIONS.get(words[at].text, ()) if words[at].is_name and stop > at + 1 else ()
        start, position = at + 2, 0
        while positions and start < stop:
            end = _argument_end(words, start, stop - 1)
            if position == 1 and position in positions and words.phrase(start, _LAST):
                words = words[:start].followed_by(words[start + len(words.phrase(start, _LAST)) :])
                stop, end = call_end(words, at), _argument_end(words, start, call_end(words, at) - 1)
            is_read = position in positions and not changed_name(words, start)
            text = _condition(words[start:end], read) if is_read else ""
            if text:
                first = words[start]
                condition = words.of([Word(text, "NAME", False, first.start, words[end - 1].end, True)])
                words = words[:start].followed_by(condition).followed_by(words[end:])
                stop -= end - start - 1
                end = start + 1
            start, position = end + 1, position + 1
        at += 1
    return words


def _argument_end(words: Words, start: int, stop: int) -> int:
    """Return the index of the comma or bracket behind the argument at an index."""
    commas = (start + at for at in words[start:stop].outer() if words[start + at].text == ",")
    return next(commas, stop)


def _condition(argument: Words, read: ReadCondition) -> str:
    """Return the condition that an argument in English says; "" for one of the language."""
    return "" if len(argument) < 2 or is_valid((f"keep {argument.text}",)) else read(argument)
