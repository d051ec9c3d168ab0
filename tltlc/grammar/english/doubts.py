"""Whether a clause takes one of several readings of a sentence, which the grammar of sentences names."""

from __future__ import annotations

import re
from typing import Final

from tltlc.grammar.english.changed_arguments import has_changed_argument
from tltlc.grammar.mistakes.sentences.vocabulary import CHANGING, LASTING
from tltlc.grammar.mistakes.sentences.words import Words, phrases

_COUNTED: Final = re.compile(r"times(?:_since|_within)?\([^()]*(?:\([^()]*\)[^()]*)*\) (?:>=|>|==) \d+")
"""A count that has come to a number."""
_AT_LEAST: Final = phrases("at least", "no less than", "more than")

_NUMBERS: Final = ("int", "number", "ratio", "speed", "length", "time")
_ENDS_OF_RANGE: Final = (("is", "full"), ("is", "empty"))
"""Words behind a number that stand for the ends of its range."""


def takes_one_reading(clause: str, words: Words) -> bool:
    """Whether a clause that patterns make of a sentence may miss its meaning."""
    event, _, answer = clause.removeprefix("keep ").partition(" implies ")
    if words.find([("between",)]) is not None and "times(" in clause:
        return True  # it counts from the first step on
    if words.find([("before",)]) and " weak_until " in answer:
        return True  # the event may come at the same step, may have to come, and may be asked for once
    is_lasting = words.find(LASTING) or words.word(0) == "in"
    if is_lasting and ("<= previous(" in answer or ">= previous(" in answer) and " and previously " not in event:
        return True  # the first step may be compared with the one before
    if denies_its_own_event(event, answer) or _counts_from_start(answer):
        return True
    return lasts_on(event) and answer.startswith(("eventually within ", "always for "))


def is_english_alone(words: Words) -> bool:
    """Whether words have a meaning in English that other helps do not know: `shift changes`, `reach a before b`."""
    pairs = [(words.declared(at), words.word(at + 1)) for at in range(len(words) - 1)]
    is_change = any(known and known.type == "enum" and word in CHANGING for known, word in pairs)
    is_end = any(
        known is not None and known.type in _NUMBERS and (words.word(at + 1), words.word(at + 2)) in _ENDS_OF_RANGE
        for at, (known, _) in enumerate(pairs)
    )
    is_count_in_time = words.find(_AT_LEAST) is not None and words.find(phrases("within", "in")) is not None
    is_goal = words.word(0) == "reach" and (words.find([("before",)]) is not None or is_count_in_time)
    is_goal = is_goal or (words.word(0) == "reach" and words.find(phrases("exactly")) is not None)
    is_own = words.word(0) in ("without", "once")
    return is_change or is_end or is_goal or is_own or has_changed_argument(words)


def denies_its_own_event(event: str, answer: str) -> bool:
    """Whether a rule forbids at once what its event asks for: `a implies (not a weak_until b)`.

    The event may have several parts: `a and c implies (not a weak_until b)`.
    """
    parts = [part.removeprefix("begins ") for word in (" and ", " or ") for part in event.split(word)]
    return answer.startswith(tuple(f"(not {part} {name} " for part in parts for name in ("weak_until", "until")))


def _counts_from_start(answer: str) -> bool:
    """Whether an answer within a time compares `times(p)`, which counts from the first step on."""
    return answer.startswith("eventually within ") and " times(" in answer


def lasts_on(event: str) -> bool:
    """Whether an event is met again at each further step: a condition that has held for a time, or a count."""
    parts = _conjuncts(event)
    if parts[1:]:
        return not any(part.startswith(("begins ", "ends ")) for part in parts) and any(map(lasts_on, parts))
    is_held = "time_holding(" in event and " >" in event and " or " not in event
    is_counted = _COUNTED.fullmatch(event) is not None
    return (is_held or is_counted or event.startswith("historically for ")) and not event.startswith(
        ("begins ", "ends ")
    )


def _conjuncts(text: str) -> list[str]:
    """Return the parts of a condition between each `and` outside of brackets."""
    parts = [""]
    for part in text.split(" and "):
        is_open = parts[-1].count("(") > parts[-1].count(")")
        parts = [*parts[:-1], f"{parts[-1]} and {part}"] if is_open else [*parts, part]
    return parts[1:]
