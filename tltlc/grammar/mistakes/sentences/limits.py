"""Read limits of counts and of times: ``died at most 3 times``, ``avoid off_track for longer than 2 s``."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.mistakes.sentences.kinds import is_bool, is_event
from tltlc.grammar.mistakes.sentences.states import State, count_of, holding_of
from tltlc.grammar.mistakes.sentences.vocabulary import (
    COMPARISONS,
    COPULAS,
    MODALS,
    NEGATED_SIGN,
    NEVER,
    PROHIBITIONS,
    SUBJECTS,
)
from tltlc.grammar.mistakes.sentences.words import Words, phrases

_OFTEN: Final = ("once", "twice", "thrice")
_PERIODS: Final = phrases("per", "in each", "in every", "each", "every", "while", "during", "in one", "in a single")
"""Words before what a count is about: a stretch of play that comes again."""
_TOTALS: Final = phrases("total", "altogether", "overall")
_EVENTS: Final = ("when", "whenever", "if", "after")


def counts_in_periods(words: Words) -> bool:
    """Whether a sentence counts in each of several periods or up to an event, or adds times up."""
    if words.find(_TOTALS) is not None:
        return True
    return _counts(words) and (words.word(0) in _EVENTS or words.find(_PERIODS) is not None)


def _counts(words: Words) -> bool:
    for at, word in enumerate(words):
        following = words.word(at + 1)
        if word.text == "times" and following == "(":
            return True
        if at and word.text in _OFTEN:
            return True
        if words.number(at) and (following in ("times", "time") or (at + 1 < len(words) and is_bool(words, at + 1))):
            return True
    return False


def bounded_count(words: Words) -> tuple[str, ...] | None:
    """Return the rule of `died at most 3 times`, `avoid died more than 3 times`, `exactly 1 takedown`."""
    keyword = words.phrase(0, [*PROHIBITIONS, *MODALS, ("keep",), ("reach",)])
    is_forbidden = keyword in PROHIBITIONS
    rest = words[len(keyword) :]
    count = count_of(rest) or count_of(rest.without([*SUBJECTS, *COPULAS]))
    if count is None:
        middle = words.find([*NEVER, *MODALS])
        if middle is None or not middle[0] or not is_event(words[: middle[0]]):
            return None
        is_forbidden = middle[1] in NEVER
        after = words[middle[0] + len(middle[1]) :].without(COPULAS)
        phrase = after.phrase(0, COMPARISONS)
        number = after.number(len(phrase))
        if not phrase or not number or after.word(len(phrase) + 1) not in ("time", "times"):
            return None
        count = (State(words[: middle[0]].text), COMPARISONS[phrase], number)
    (event, sign, number) = count
    if is_forbidden:
        sign = NEGATED_SIGN.get(sign or ">=", "")
    if sign in ("<=", "<"):
        is_zero = (sign, number) in (("<=", "0"), ("<", "1"))
        return (f"avoid {event.text}",) if is_zero else (f"keep times({event.text}) {sign} {number}",)
    if sign in (">=", ">"):
        return (f"reach times({event.text}) {sign} {number}",)
    if number == "0" and sign in ("", "=="):
        return (f"avoid {event.text}",)
    if sign == "==":
        return f"reach times({event.text}) >= {number}", f"keep times({event.text}) <= {number}"
    return None


def bounded_time(words: Words) -> tuple[str, ...] | None:
    """Return the rule of `dashing for at most 0.5 s`, `avoid off_track for longer than 2 s`."""
    keyword = words.phrase(0, [*PROHIBITIONS, *MODALS, ("keep",)])
    is_forbidden = keyword in PROHIBITIONS
    holding = holding_of(words[len(keyword) :])
    if holding is None:
        return None
    state, sign, time = holding
    sign = NEGATED_SIGN.get(sign, "") if is_forbidden else sign
    return (f"keep time_holding({state.text}) {sign} {time}",) if sign in ("<", "<=") else None
