"""The stems of English words, and the states that verbs bring about: ``kill`` makes something ``dead``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

_IRREGULAR: Final[Mapping[str, str]] = {
    form: stem
    for stem, forms in {
        "die": "die died dies dying death deaths dead",
        "steal": "steal steals stole stolen stealing",
        "run": "run runs ran running",
        "hide": "hide hides hid hidden hiding",
        "sleep": "sleep sleeps slept asleep sleeping",
        "shoot": "shoot shoots shot shooting",
        "fall": "fall falls fell fallen falling",
        "win": "win wins won winning",
        "throw": "throw throws threw thrown throwing",
        "fight": "fight fights fought fighting",
        "break": "break breaks broke broken breaking",
        "wake": "wake wakes woke woken waking awake",
        "see": "see sees saw seen seeing",
        "find": "find finds found finding",
        "take": "take takes took taken taking",
        "get": "get gets got getting",
        "leave": "leave leaves left leaving",
        "swim": "swim swims swam swimming",
        "has": "has have had having",
        "do": "do does did done doing",
        "is": "is are was were be been being",
        "speak": "speak speaks spoke spoken speaking",
        "ring": "ring rings rang rung ringing",
        "go": "go goes went gone going",
        "make": "make makes made making",
        "lie": "lie lies lying",
        "hit": "hit hits hitting",
        "cast": "cast casts casting",
        "buy": "buy buys bought buying",
        "sell": "sell sells sold selling",
        "lose": "lose loses lost losing",
        "hold": "hold holds held holding",
        "meet": "meet meets met meeting",
        "bring": "bring brings brought bringing",
    }.items()
    for form in forms.split()
}
"""Maps the forms of irregular verbs, and of those whose forms are short, to their stems."""
_NOT_AN_ENDING: Final = re.compile(r"(ss|us|is|^[^aeiouy]*ing|^.{1,2}ing|eed)$")


def stem(word: str) -> str:
    """Return the stem of a word: ``dash`` of ``dashing``, ``paus`` of ``pause``, ``pauses`` and ``paused``."""
    word = word.lower()
    if word in _IRREGULAR:
        return _IRREGULAR[word]
    base = word
    if not _NOT_AN_ENDING.search(word):
        base = re.sub(r"(?<=..)(ing|ed|es|s)$", "", word)
    if base != word and re.search(r"([^aeiouylsz])\1$", base):
        base = base[:-1]  # `dropped`
    if re.search(r"[^aeiou]ies$|[^aeiou]ied$", word):
        base = re.sub(r"i(es|ed)$", "y", word)
    return base[:-1] if len(base) > 2 and base.endswith("e") else base


def parts_of(name: str) -> tuple[str, ...]:
    """Return the stems of the parts of a name: ``dragon``, ``die`` of ``dragon_dead`` and ``dragonDead``."""
    return tuple(stem(part) for part in re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).split("_") if part)


def _stems(*texts: str) -> frozenset[str]:
    return frozenset(stem(word) for text in texts for word in text.split())


PLACE: Final = _stems("in at on inside near")
"""Parts of a name that say that something is at a place."""
OWN: Final = _stems("has")
QUIET: Final = _stems("is to of used active")
"""Parts of a name that may be left out."""

_ARRIVE: Final = (
    PLACE | _stems("reached visited entered"),
    "reach enter visit go arrive come get return escape step bring carry",
)
_ACQUIRE: Final = (
    OWN | _stems("collected found taken"),
    "get find take grab steal obtain collect acquire pick have own bring carry",
)
_KILL: Final = (_stems("dead killed defeated destroyed beaten"), "kill slay defeat beat destroy eliminate murder")
_COMPLETE: Final = (_stems("done finished completed complete cleared"), "complete finish clear beat")
_OPEN: Final = (_stems("open unlocked"), "open unlock")
BRINGS: Final[Mapping[str, frozenset[str]]] = {
    stem(verb): frozenset().union(
        *(
            states
            for states, others in (_ARRIVE, _ACQUIRE, _KILL, _COMPLETE, _OPEN)
            if stem(verb) in map(stem, others.split())
        )
    )
    for _, verbs in (_ARRIVE, _ACQUIRE, _KILL, _COMPLETE, _OPEN)
    for verb in verbs.split()
}
"""Maps the stem of a verb to the parts of names that say what it brings about."""
EMPTY_VERBS: Final = _stems(
    "use do make take get trigger raise press pull push ring perform receive suffer commit cause set throw give hit put"
)
"""Stems of verbs that add nothing to what a name says: `take damage`, `raise the alarm`."""
OPPOSITES: Final[Mapping[str, frozenset[str]]] = {
    stem(word): _stems(others)
    for word, others in {
        "alive": "dead died",
        "dead": "alive",
        "closed": "open",
        "shut": "open",
        "close": "open",
        "awake": "sleeping asleep",
        "leave": "in at",
        "exit": "in",
        "on": "off",
        "off": "on",
        "out": "in",
        "unseen": "seen",
        "undetected": "detected",
        "air": "ground",
        "airborne": "ground",
        "undamaged": "damaged",
        "unharmed": "damaged",
    }.items()
}
"""Maps stems of words to the parts of names that say the opposite."""
LEAVE: Final = _stems("leave")
