"""Whether a clause takes one of several readings of a sentence, which the grammar of sentences names."""

from __future__ import annotations

from tltlc.grammar.mistakes.sentences.words import Words


def takes_one_reading(clause: str, words: Words) -> bool:
    """Whether a clause that patterns make of a sentence may miss its meaning."""
    event, _, answer = clause.removeprefix("keep ").partition(" implies ")
    return _denies_its_own_event(event, answer) or (lasts_on(event) and answer.startswith("eventually within "))


def _denies_its_own_event(event: str, answer: str) -> bool:
    """Whether a rule is `a implies (not a weak_until b)`, which no step with a meets."""
    return answer.startswith(f"(not {event.removeprefix('begins ')} weak_until ")


def lasts_on(event: str) -> bool:
    """Whether an event is that a condition has held for a time, which each further step with it meets again."""
    is_held = "time_holding(" in event and " >" in event and " or " not in event
    return (is_held or event.startswith("historically for ")) and not event.startswith(("begins ", "ends "))
