"""Find declared names that a sentence spells in English: ``kill the dragon`` for ``dragon_dead``.

A name is found only if all words are accounted for, and no other name fits.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.mistakes.declared_names import DeclaredName
from tltlc.grammar.mistakes.sentences.changes import VERBS_OF_CHANGE
from tltlc.grammar.mistakes.sentences.stems import (
    BRINGS,
    EMPTY_VERBS,
    LEAVE,
    OPPOSITES,
    OWN,
    PLACE,
    QUIET,
    parts_of,
    stem,
)
from tltlc.grammar.mistakes.sentences.vocabulary import COPULAS, ENGLISH, PROHIBITIONS, SUBJECTS, VERBS
from tltlc.grammar.mistakes.sentences.words import Word, Words, phrases

_LONGEST: Final = 7
_INSIDE: Final = frozenset(
    word
    for phrase in (
        *VERBS,
        *COPULAS,
        *SUBJECTS,
        *phrases("in at on to by through via into of off up out back from your my his her"),
    )
    for word in phrase
) - {"until", "must", "should", "have"}
"""English words that may stand inside the words for a name."""
_SILENT: Final = frozenset("the a an to by through via into of up from your my his her their it back be".split())
"""Words that say nothing inside the words for a name."""
_EMPTY: Final = frozenset("again still anything anyone anybody your my his her their successfully safely just".split())
"""Words that say nothing in a sentence."""
_TELLING: Final = frozenset((("again", "before"), ("again", "until"), ("again", "till"), ("just", "after")))
"""Words of these that say something, with the word behind them."""
_OPENINGS: Final = phrases(
    "check that", "verify that", "ensure that", "make sure that", "make sure", "assert that", "expect that", "test that"
)
_MOVE: Final = stem("moving")
_SESSION: Final = frozenset(("run", "playthrough", "attempt", "game"))


@record
class _Found:
    """A name that words spell; ``sign`` is `not` or `no` if they say the opposite."""

    name: str
    sign: str = ""


def with_names(words: Words) -> Words:
    """Return the words with a declared name in place of each group of words that spells one."""
    words = words.without(_OPENINGS)
    words = _with_never(words)
    words = words.of([word for at, word in enumerate(words) if not _is_empty(words, at)])
    found: list[Word] = []
    at = 0
    while at < len(words):
        verb = _verb_of(words, at)
        if verb:
            at += verb
            continue
        stop, replaced = _replaced(words, at, found)
        if replaced or stop > at:
            found += replaced
            at = stop
            continue
        found.append(words[at])
        at += 1
        if (
            _is_event_name(words, at - 1)
            and stem(words.word(at)) in EMPTY_VERBS
            and words.word(at).endswith(("s", "ed"))
        ):
            at += 1  # `bell rings`, `undo used`
    return words.of(found)


def _is_empty(words: Words, at: int) -> bool:
    """Whether a word says nothing: not `again` in `again before b`, and `just` in `just after b`."""
    return words.word(at) in _EMPTY and (words.word(at), words.word(at + 1)) not in _TELLING


def _with_never(words: Words) -> Words:
    """Return the words with `no damage` in place of `take no damage`, and `never spend gold` of `spend no gold`."""
    changed: list[Word] = []
    for at, word in enumerate(words):
        verb = words.word(at)
        if words.word(at + 1) == "no" and verb in VERBS_OF_CHANGE:
            changed.append(Word("never", "NAME", False, word.start, word.start, True))
        if words.word(at + 1) == "no" and stem(verb) in EMPTY_VERBS:
            continue
        if not (verb == "no" and words.word(at - 1) in VERBS_OF_CHANGE):
            changed.append(word)
    return words.of(changed)


def _verb_of(words: Words, at: int) -> int:
    """Return how many words of a verb before a declared event say nothing more: `raising the` before `alarm`."""
    verb = words.word(at)
    stop = at + 1
    while words.word(stop) in ("the", "a", "an"):
        stop += 1
    if not verb or verb in ("reach", "do", "does", "did", "has", "have") or not _is_event_name(words, stop):
        return 0
    brought = BRINGS.get(stem(verb), frozenset()) & set(parts_of(words[stop].text))
    return stop - at if stem(verb) in EMPTY_VERBS or brought else 0


def _is_event_name(words: Words, at: int) -> bool:
    declared = words.declared(at)
    return declared is not None and declared.type == "bool" and not declared.parameters


def is_imperative(words: Words) -> bool:
    """Whether a sentence begins with a verb that asks for what it names: `drift for 10 s`, `talk to the elder`."""
    words = words.without(SUBJECTS)
    first = "" if words.phrase(0, PROHIBITIONS) else words.word(0)
    is_action = _is_verb_of_name(words, first) and not words.find(
        phrases("while", "during", "when", "as", "in", "at", "on")
    )
    return bool(first) and (is_goal_verb(first) or is_action)


def is_goal_verb(word: str) -> bool:
    """Whether a word is a verb that brings about what stands behind it: `kill`, `raise`."""
    return stem(word) not in OWN and (stem(word) in BRINGS or stem(word) in EMPTY_VERBS)


def _is_verb_of_name(words: Words, first: str) -> bool:
    """Whether a word is the verb that a declared name has in another form: `drift` of `drifting`."""
    forms = (part for name in words.names.names for part in name.lower().split("_"))
    return any(form != first and stem(form) == stem(first) and not form.endswith("s") for form in forms) and not (
        first.endswith(("ed", "ing", "s"))
    )


def _replaced(words: Words, at: int, before: list[Word]) -> tuple[int, list[Word]]:
    """Return the index after the longest group of words at an index that spells a name, and what replaces it."""
    for stop in range(min(len(words), at + _LONGEST), at, -1):
        group = words[at:stop]
        if not all(_may_belong(group, index) for index in range(len(group))):
            continue
        found = _name_of(group, before[-1].text if before else "", words.number(stop) or words.number(at - 1))
        if found is None:
            continue
        start, end = group[0].start, group[-1].end
        texts = [*([found.sign] if found.sign else []), found.name]
        replaced = [Word(text, "NAME", text == found.name, start, end, True) for text in texts]
        if words.names.names[found.name].type == "speed" and stem(group[-1].text) == _MOVE:
            unit = words.names.names[found.name].ends[0].split(maxsplit=1)[1].replace(" ", "")
            replaced += [
                Word(text, kind, False, start, end, True)
                for text, kind in ((">", "MORE"), ("0", "NUMBER"), (unit, "UNIT"))
            ]
        declared = words.names.names[found.name]
        if declared.type == "enum":
            value = next(value for value in declared.values if stem(value) == stem(group[-1].text))
            named = [word.text for word in before[-3:] if word.is_name]
            is_said = named[-1:] == [found.name] and not {"and", "or", ","} & {word.text for word in before[-2:]}
            replaced = [] if is_said else [*replaced, Word("is", "NAME", False, start, end, True)]
            replaced.append(Word(value, "NAME", False, start, end, True))
        is_place = group.word(0) in ("in", "at", "on") or (parts_of(found.name)[0] in PLACE and not _brings(group))
        if declared.type == "int" and before and before[-1].text in ("reach", "hit", "get") and words.number(stop):
            replaced.append(Word(">=", "AT_LEAST", False, end, end, True))
        if is_place and before and (before[-1].is_name or before[-1].is_renamed):
            replaced.insert(0, Word("during", "NAME", False, start, start, True))
        return stop, replaced
    return at, []


def _brings(group: Words) -> bool:
    return stem(group[0].text) in BRINGS


def _may_belong(group: Words, at: int) -> bool:
    if group[at].is_name or group[at].type == "UNIT" or group.number(at) or not group[at].text.isalpha():
        return False
    return group[at].text in _INSIDE or group[at].text not in (*ENGLISH, "up", "down", "goes", "go")


def _name_of(group: Words, before: str, number: str) -> _Found | None:
    """Return the only name that a group of words spells, else None."""
    texts = [word.text for word in group if word.text not in _SILENT and not _is_copula(word.text)]
    if (
        not texts
        or group[-1].text in _SILENT - {"up"}
        or _is_copula(group[0].text)
        or _is_copula(group[-1].text)
        or group[0].text in ("the", "a", "an")
    ):
        return None
    if group[-1].text in ("in", "at", "back") or group[0].text in ("of", "from", "by"):
        return None
    if texts[0] in ("reach", "keep", "avoid", "require", "then"):
        return None
    names = group.names.names
    if texts[0].endswith("less") and len(texts[0]) > 6 and set(texts[1:]) <= _SESSION:
        bare = _only([name for name in _bools(names) if parts_of(name) == (stem(texts[0][:-4]),)])
        return None if bare is None else _Found(bare, "no")
    stems = [stem(text) for text in texts]
    if set(stems) & LEAVE and {"by", "through", "via"} & {word.text for word in group}:
        stems = ["reach" if word in LEAVE else word for word in stems]
    bools = _bools(names)
    whole = [name for name in bools if _fits(stems, name, before) and not _left_out(stems, name, before) - QUIET]
    if len(whole) > 1:
        return None
    if whole:
        return _Found(whole[0])
    opposite = _only([name for name in bools if _is_opposite(stems, name)])
    if opposite is not None:
        return _Found(opposite, "not")
    loose = _only([name for name in bools if _fits(stems, name, before)])
    if loose is not None and len(_sharing(stems, loose, names)) == 1:
        return _Found(loose)
    return _number_of(stems, names, number) or _value_of(stems, names, group, before)


def _bools(names: Mapping[str, DeclaredName]) -> list[str]:
    return [name for name, declared in names.items() if _is_plain(declared) and declared.type == "bool"]


def _is_plain(declared: DeclaredName) -> bool:
    return declared.keyword == "signal" and not declared.parameters


def _is_copula(text: str) -> bool:
    return (text,) in COPULAS and text not in ("have", "has", "having", "get", "gets", "getting")


def _fits(stems: list[str], name: str, before: str) -> bool:
    """Whether each word stands for a part of a name, or is a verb that brings about what the name says."""
    parts = set(parts_of(name))
    nouns = parts - PLACE - OWN - QUIET
    if not nouns & set(stems):
        return False
    for word in stems:
        is_known = word in parts or word in EMPTY_VERBS or (word in PLACE and not parts & _stems_of_places(word))
        if not is_known and not BRINGS.get(word, frozenset()) & parts and not (word in LEAVE and "off" in parts):
            return False
    return not _left_out(stems, name, before) - PLACE - OWN - QUIET


def _stems_of_places(word: str) -> frozenset[str]:
    """Return the parts of a name that a word for another place contradicts: `in` and `off`."""
    return frozenset(("off",)) if word != "off" else PLACE


def _left_out(stems: list[str], name: str, before: str) -> set[str]:
    """Return the parts of a name for which no word stands."""
    brought = {part for word in (*stems, before) for part in BRINGS.get(stem(word), ())}
    if set(stems) & LEAVE:
        brought.add("off")
    return set(parts_of(name)) - set(stems) - brought


def _is_opposite(stems: list[str], name: str) -> bool:
    """Whether one of the words says the opposite of a part of a name, and the others are its other parts."""
    parts = set(parts_of(name))
    for word in stems:
        denied = OPPOSITES.get(word, frozenset()) & parts
        others = {other for other in stems if other != word and other not in EMPTY_VERBS | PLACE}
        if denied and others == parts - denied - QUIET - (PLACE - denied):
            return True
    return False


def _sharing(stems: list[str], name: str, names: Mapping[str, DeclaredName]) -> list[str]:
    """Return the names that share with a name the words that stand for its parts."""
    nouns = (set(parts_of(name)) - PLACE - OWN - QUIET) & set(stems)
    return [
        other for other, declared in names.items() if declared.keyword == "signal" and nouns <= set(parts_of(other))
    ]


def _number_of(stems: list[str], names: Mapping[str, DeclaredName], number: str) -> _Found | None:
    """Return the number that words name, perhaps only by a part of its name beside a number: `level 5`."""
    kinds = ("int", "number", "ratio", "speed", "length", "time")
    numbers = [name for name, declared in names.items() if _is_plain(declared) and declared.type in kinds]
    speeds = [name for name in numbers if names[name].type == "speed" and len(names[name].ends[:1]) == 1]
    if stems == [_MOVE]:
        is_known = len(speeds) == 1 and len(names[speeds[0]].ends[0].split()) > 1
        return _Found(speeds[0]) if is_known else None
    name = _only([name for name in numbers if list(parts_of(name)) == stems])
    if name is None and number:
        sharing = [name for name, declared in names.items() if set(stems) <= set(parts_of(name))]
        name = _only(sharing) if sharing and sharing[0] in numbers else None
    return None if name is None else _Found(name)


def _value_of(stems: list[str], names: Mapping[str, DeclaredName], group: Words, before: str) -> _Found | None:
    """Return the enum of a value that stands alone: `pistol` for `weapon is pistol`."""
    stems = stems if stems[0] not in EMPTY_VERBS else stems[1:]
    # A value is spelt otherwise as a verb alone: `blu` may be a slip of the pen.
    is_value = not group[-1].text.endswith(("ing", "s")) or any(
        group[-1].text in declared.values for declared in names.values()
    )
    if len(stems) != 1 or (is_value and before in ("is", "==", "=", "!=", "not", "never", "in", "to")):
        return None
    enums = [
        name
        for name, declared in names.items()
        if _is_plain(declared) and stems[0] in map(stem, declared.values) and (before != name or not is_value)
    ]
    listed = [name for name in enums if [stem(value) for value in names[name].values].count(stems[0]) == 1]
    name = _only(listed) if len(listed) == len(enums) else None
    return None if name is None or stem(group[-1].text) != stems[0] else _Found(name)


def _only(found: list[str]) -> str | None:
    return found[0] if len(found) == 1 else None
