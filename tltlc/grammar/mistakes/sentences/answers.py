"""Read what is asked for after a condition: ``hidden within 5 s``, ``invulnerable for 1 s``, ``never firing``."""

from __future__ import annotations

from typing import Final, Literal

from tltlc.core.record import record, replace
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, state_of
from tltlc.grammar.mistakes.sentences.vocabulary import (
    ALWAYS,
    COPULAS,
    FOR,
    MODALS,
    NOT,
    PROHIBITIONS,
    SUBJECTS,
    UNEQUAL,
    WITHIN,
)
from tltlc.grammar.mistakes.sentences.words import Phrase, Words, phrases

Kind = Literal["now", "within", "lasting", "delayed", "eventually", "always", "next"]

_BY_WORD: Final[tuple[tuple[tuple[Phrase, ...], Kind], ...]] = (
    (phrases("eventually", "at some point", "sooner or later", "later", "finally"), "eventually"),
    ((*ALWAYS, *phrases("forever", "for ever", "from then on", "for good", "stays true", "stay true")), "always"),
    (phrases("next"), "next"),
    (phrases("immediately", "instantly", "at once", "right away", "also", "then"), "now"),
)
"""Words before or after what is asked for, and the kind of answer that they make."""

_STOPS: Final = phrases("stops", "stop", "ends", "is over", "must stop", "must end", "is interrupted", "is cancelled")
_NEXT_STEP: Final = phrases("on the next step", "at the next step", "in the next step", "next step", "one step later")


@record
class Answer:
    """A condition that must hold: at the step of the event, within a time from it on, or in another way.

    ``time`` is the text of a time; "" for kinds without one. ``is_negative`` says that the condition is
    the opposite of what the sentence names, and ``is_open`` that it may have to hold at one step, or at all
    of them. ``keyword`` is `reach` or `keep` if it stands before the answer.
    """

    kind: Kind
    state: State
    time: str = ""
    is_negative: bool = False
    keyword: Literal["", "reach", "keep"] = ""
    is_open: bool = False


def answer_of(words: Words) -> Answer | None:
    """Return what words ask for, or None if it is unclear."""
    words = words.without([*SUBJECTS, (",",), ("then",)])
    special = _until(words) or _stopped(words)
    if special is not None:
        return special
    if words.word(0) == "reach":
        return _reached(words[1:])
    is_kept = words.word(0) == "keep"
    more = words.phrase(0, phrases("no more", "no further"))
    if more and not words.find(WITHIN):
        state = state_of(words[len(more) :])
        return None if state is None else Answer("now", State(f"always {state.negated().at(ATOM)}"))
    prohibition = words.phrase(0, PROHIBITIONS)
    if prohibition:
        answer = _affirmative(words[len(prohibition) :])
        return None if answer is None else _negated(answer, is_never="no" not in prohibition)
    if words.word(0) == "not":
        answer = _affirmative(words[1:])
        # `not b within 5 s` may ask for one step without b, or for no step with it.
        if answer is None or answer.kind not in ("now", "lasting", "within"):
            return None
        negated = _negated(answer)
        return negated and replace(negated, is_negative=False, is_open=answer.kind == "within")
    words = words.without([*MODALS, ("keep",)])
    modal = words.find(MODALS)
    if modal is not None and not words[modal[0] + len(modal[1]) :].phrase(0, NOT):
        words = words[: modal[0]].followed_by(words[modal[0] + len(modal[1]) :])
    answer = _affirmative(words)
    if answer is not None and answer.kind == "within" and _without_no_later(words).find([*NOT, *UNEQUAL]):
        return None
    return replace(answer, keyword="keep") if is_kept and answer is not None else answer


def clause_of(event: State, answer: Answer) -> str:
    """Return the clause that asks for an answer at each step with an event."""
    condition, state, time = event.at(OR), answer.state, answer.time
    if answer.kind == "now":
        return f"keep {condition} implies {state.at(OR)}"
    if answer.kind == "within" and answer.is_negative:
        return f"keep {condition} implies not eventually within {time} {state.negated().at(ATOM)}"
    if answer.kind == "within":
        return f"keep {condition} implies eventually within {time} {state.at(ATOM)}"
    operators = {
        "lasting": f"always for {time}",
        "delayed": f"next after {time}",
        "eventually": "eventually",
        "always": "always",
        "next": "next",
    }
    return f"keep {condition} implies {operators[answer.kind]} {state.at(ATOM)}"


def _until(words: Words) -> Answer | None:
    """Return the answer of `no b until c`, and of `b before c`: no c without b. In `b until c`, c may have to come."""
    found = words.find(phrases("until", "till", "before"))
    if found is None or not found[0] or words.time(found[0] + 1):
        return None
    left, right = words[: found[0]].without([*MODALS, *COPULAS]), state_of(words[found[0] + 1 :])
    forbidden = left.phrase(0, PROHIBITIONS)
    if forbidden in (("avoid",), ("forbid",), ("prevent",)) or left.word(0) in ("keep", "reach"):
        return None
    state = state_of(left[len(forbidden) :])
    if state is None or right is None:
        return None
    if found[1] == ("before",) and not forbidden and not state.text.startswith("not "):
        return Answer("now", State(f"({right.negated().at(ATOM)} weak_until {state.at(ATOM)})"))
    state = state.negated() if forbidden else state
    if not state.text.startswith("not "):
        return None
    return Answer("now", State(f"({state.at(ATOM)} weak_until {right.at(ATOM)})"))


def _stopped(words: Words) -> Answer | None:
    """Return the answer of `b stops` and `b on the next step`."""
    for known, is_end in ((_STOPS, True), (_NEXT_STEP, False)):
        found = words.find_last(known)
        if found is not None and found[0] and found[0] + len(found[1]) == len(words):
            state = state_of(words[: found[0]].without([*MODALS, *COPULAS]))
            return None if state is None else Answer("next", state.negated() if is_end else state)
    return None


def _without_no_later(words: Words) -> Words:
    """Return the words before `no later than`, whose `no` denies nothing that is asked for."""
    found = words.find([phrase for phrase in WITHIN if "no" in phrase])
    return words if found is None else words[: found[0]]


def _reached(words: Words) -> Answer | None:
    """Return the answer of `reach b` and `reach b within 5 s`, which is met at one step."""
    answer = _affirmative(words)
    if answer is None or answer.kind not in ("now", "within", "eventually"):
        return None
    return replace(answer, kind="eventually" if answer.kind == "now" else answer.kind, keyword="reach")


def _negated(answer: Answer, *, is_never: bool = False) -> Answer | None:
    """Return the answer that asks for the opposite; `never a` asks for it from then on."""
    if answer.kind not in ("now", "lasting", "within", "always") or answer.state.level > ATOM:
        return None  # `no a and b` may be about a alone
    kind: Kind = "always" if is_never and answer.kind == "now" else answer.kind
    return Answer(kind, answer.state.negated(), answer.time, True)


def _affirmative(words: Words) -> Answer | None:
    words = words.without([*SUBJECTS, *COPULAS])
    for known, kind in _BY_WORD:
        phrase = words.phrase(0, known)
        timed = _timed(words[len(phrase) :]) if phrase and kind == "eventually" else None
        if timed is not None and timed.kind == "within":
            return timed
        if phrase:
            state = state_of(words[len(phrase) :].without(COPULAS))
            return None if state is None else Answer(kind, state)
        found = words.find_last(known)
        if found is not None and found[0] and found[0] + len(found[1]) == len(words):
            state = state_of(words[: found[0]])
            return None if state is None else Answer(kind, state)
    timed = _timed(words)
    if timed is not None:
        return timed
    state = state_of(words)
    return None if state is None else Answer("now", state)


def _timed(words: Words) -> Answer | None:
    """Return an answer with a time, which stands first or last."""
    for known, kind in ((WITHIN, "within"), (FOR, "lasting"), (phrases("after"), "delayed")):
        phrase = words.phrase(0, known)
        time = words.time(len(phrase)) if phrase else None
        if time is not None:
            rest, length = words[time[1] :].without([(",",)]), time[0].text
        else:
            found = words.find_last(known)
            time = None if found is None else words.time(found[0] + len(found[1]))
            if found is None or time is None or time[1] != len(words):
                continue
            rest, length = words[: found[0]], time[0].text
        state = state_of(rest.without(COPULAS))
        return None if state is None else Answer(kind, state, length)  # type: ignore[arg-type]
    return None
