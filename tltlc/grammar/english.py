"""Plain English where the language has another form: `if`, `while`, `before`, a bound behind its formula."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import Token
from tltlc.grammar.place import INFIX, Place, outside, shown
from tltlc.grammar.rewording import formula_start, formula_stop, last_of, operand, reworded, span_of
from tltlc.grammar.words import CASES, CLAUSES, CONDITIONS, UNITS_ELSEWHERE

_FILLERS: Final = frozenset(("the", "an", "to", "be", "being", "either", "both", "first"))
_COMPARISONS: Final = {
    ("at", "least"): ">=",
    ("at", "most"): "<=",
    **dict.fromkeys((("more", "than"), ("greater", "than"), ("above",), ("over",), ("exceeds",)), ">"),
    **dict.fromkeys((("less", "than"), ("below",), ("under",)), "<"),
}

Forms = Mapping[str, str]
"""What stands for some English, by the clause it stands in, or anywhere else; with a keyword, for the whole clause."""

_CONDITION: Final = {"reach": "{a} and {b}", "avoid": "{a} and {b}", "": "{b} implies {a}"}
_SEQUENCE: Final = {"": "{a} then {b}"}
_FORMS: Final[dict[str, Forms]] = {
    **dict.fromkeys((*CONDITIONS, "during"), _CONDITION),
    "before": {"keep": "require {a} until {b}", "avoid": "require (not {a}) until {b}", **_SEQUENCE},
    "after": {
        "keep": "{b} implies always {a}",
        "avoid": "require always ({b} implies always not {a})",
        "": "{b} then {a}",
    },
    "followed": _SEQUENCE,
    "unless": {"reach": "{a} or {b}", "keep": "{a} or {b}", "avoid": "{a} and not {b}", "": "{a} weak_until {b}"},
    "without": {"": "{a} and not {b}"},
    "but": {"": "{a} and {b}"},
    "xor": {"": "not ({a} iff {b})"},
}
"""What `a WORD b` is."""

_IN_TIME: Final = {
    "reach": "require eventually within {b} {a}",
    "avoid": "require always for {b} not {a}",
    "then": "{c} and eventually within {b} {a}",
    "": "eventually within {b} {a}",
}
_FOR_TIME: Final = {
    # Past the end of a trace `always for` asks nothing: one step would meet it.
    "reach": "(always for {b} {a}) and next after {b} {a}",
    "keep": "require always for {b} {a}",
    "avoid": "require always for {b} not {a}",
    "then": "{c} then (always for {b} {a}) and next after {b} {a}",
    "": "always for {b} {a}",
}
_TIMES: Final[dict[str, Forms]] = {
    **dict.fromkeys(("within", "in", "before", "by"), _IN_TIME),
    "for": _FOR_TIME,
    "after": {
        "reach": "require next after {b} eventually {a}",
        "keep": "require next after {b} always {a}",
        "avoid": "require next after {b} always not {a}",
        "then": "{c} and next after {b} eventually {a}",
        "": "next after {b} {a}",
    },
}
"""What `a WORD TIME` and `WORD TIME a` are; under `then`, what `c then a WORD TIME` is, as a time is that of its goal.

With `and`, it begins where `c` is reached.
"""
_TIMED: Final = {form for forms in _TIMES.values() for form in forms.values()}

_PREFIX: Final = {"reach": "{b} and {a}", "avoid": "{b} and {a}", "": "{b} implies {a}"}
_PREFIXES: Final[dict[str, Forms]] = dict.fromkeys(CONDITIONS, _PREFIX)
"""What `WORD b, a` and `WORD b then a` are."""

_REASONS: Final = {
    ("if", "reach"): " for both at one step, `{b} then {a}` for one after the other",
    ("when", "reach"): " for both at one step, `{b} then {a}` for one after the other",
    ("while", "reach"): " for both at one step; a clause `keep {b}` asks for it at every step",
    ("for", "reach"): "; past the end of play `always for` asks nothing, so the last step is asked for, too",
    ("before", "reach"): "; where only the order counts, `require (not {b}) until {a}`",
}
_WHERE: Final = ": where `{b}` holds, `{a}` must, too"


def plain_english(place: Place) -> Diagnostic | None:
    """``reach if b then a``, ``keep a while b``, ``reach a within 20 steps``."""
    if not place.wants_operator or place.before is None:
        return None
    for at, elsewhere in ((place.stop.index - 1, _PREFIXES), (place.stop.index, _FORMS)):
        word, timed = place.tokens[at], place.tokens[at + 1 :] and place.tokens[at + 1].type == "NUMBER"
        forms = _TIMES.get(word.text) if timed else elsewhere.get(word.text)
        if forms is None or word.type not in ("NAME", "WHEN"):
            continue
        if place.tokens[0].type == "PREDICATE":
            return place.error("TLT0101", f"{shown(word)} is no operator", CASES, span=word.span)
        if word.text == "without" and _kind(place) in ("reach", "keep"):
            help_ = "write `avoid`, which begins a clause of its own and speaks of every step"
            return place.error("TLT0101", "`without` is no operator", help_)
        return _prefixed(place, at, forms) if at < place.stop.index else _infix(place, forms)
    return None


def compared(place: Place) -> Diagnostic | None:
    """``coins is more than 3``, ``health above 50%``."""
    at = place.stop.index
    if not place.wants_operator or place.found.type != "NAME":
        return None
    words = [token.text for token in place.tokens[at : at + 3]]
    start = words[0] in ("is", "are")
    for phrase, sign in _COMPARISONS.items():
        length = start + len(phrase)
        if tuple(words[start:length]) != phrase:
            continue
        value = place.tokens[at + length].type
        if value == "NUMBER" or (value == "NAME" and phrase[0] != "at"):
            title, span = f"{shown(place.found)} is no operator", span_of(place.tokens[at : at + length])
            return place.error("TLT0101", title, f"write `{sign}`", span=span)
    return None


def filler(place: Place) -> Diagnostic | None:
    """``reach the exit``, ``avoid being seen``."""
    at = place.stop.index
    for index in (at - 1, at):
        word = place.tokens[index]
        if place.wants_operator and index > 0 and word.type == "NAME" and word.text in _FILLERS:
            title, next_ = f"{shown(word)} says nothing here", place.tokens[index + 1]
            if next_.type == "NAME":
                return reworded(place, index, index + 2, next_.text, title, " alone") or place.error(
                    "TLT0101", title, "leave it out", span=word.span
                )
    return None


def conditional(place: Place) -> Diagnostic | None:
    """A line of a spec that begins with ``if`` or ``when``."""
    return _prefixed(place, 0, {"": "keep {b} implies {a}"}) if place.tokens[0].text in _PREFIXES else None


def _infix(place: Place, forms: Forms) -> Diagnostic:
    at, kind = place.stop.index, _kind(place)
    start, stop = formula_start(place), formula_stop(place)
    form, before = forms.get(kind, forms[""]), ""
    goals = [start]
    if kind == "reach":
        goals += [index + 1 for index in outside(place.tokens, start, at) if place.tokens[index].type == "THEN"]
    begin = goals[-1]
    if forms in _TIMES.values():
        b, behind = _time(place, at + 1)
        if len(goals) > 1:
            form, start = forms["then"], goals[-2]
            before = operand(place, start, begin - 1)
        elif form == forms[""]:
            # It is that of the last operand alone.
            last = last_of(place, INFIX, start)
            start = begin = start if last is None else last + 1
        return _told(place, at, (start, stop), form, operand(place, begin, at), b if behind == stop else "", before)
    behind = at + 1 + (place.tokens[at + 1].text == "by")
    thens = (index for index in outside(place.tokens, behind, stop) if place.tokens[index].type == "THEN")
    stop = next(thens, stop)
    return _told(place, at, (begin, stop), form, operand(place, begin, at), operand(place, behind, stop))


def _prefixed(place: Place, at: int, forms: Forms) -> Diagnostic:
    stop = formula_stop(place)
    if forms in _TIMES.values():
        b, behind = _time(place, at + 1)
    else:
        split = _split(place, at + 1, stop)
        b, behind = operand(place, at + 1, split), split + (place.tokens[split].text in _SEPARATORS)
    return _told(place, at, (at, stop), forms.get(_kind(place), forms[""]), operand(place, behind, stop), b)


def _told(place: Place, at: int, part: tuple[int, int], form: str, a: str, b: str, c: str = "") -> Diagnostic:
    """The error at the word ``at``, with what to write in place of a part of the tokens, where that can be read."""
    word, kind = place.tokens[at], _kind(place)
    title = f"{shown(word)} is no operator" if at else f"no clause begins with {shown(word)}"
    code = "TLT0101" if at else "TLT0107"
    start, stop = part
    timed = form in _TIMED
    if form.split()[0] in CLAUSES:
        start = 0
    found = None
    if a and b:
        reason = ((word.text == "for" or not timed) and _REASONS.get((word.text, kind))) or (
            _WHERE if form == _CONDITION[""] else ""
        )
        reason = reason.format(a=a, b=b)
        found = reworded(place, start, stop, form.format(a=a, b=b, c=c), title, reason, code)
    if found:
        return found
    prefixed = at == 0 or at < place.stop.index
    a, b = ("a", "20 steps") if timed else ("b", "a") if prefixed else ("a", "b")
    said = f"{word.text} {b}, {a}" if prefixed else f"{'c then ' if c else ''}{a} {word.text} {b}"
    return place.error(code, title, f"`{said}` is written `{form.format(a=a, b=b, c='c')}`", span=word.span)


def _kind(place: Place) -> str:
    """The keyword of the clause whose formula cannot be read; none inside brackets."""
    return place.tokens[0].text if place.start == "clause" and not place.open_brackets else ""


def _time(place: Place, at: int) -> tuple[str, int]:
    """A number with its unit, as it is written here, and where it ends."""
    unit = place.tokens[at + 1]
    known = UNITS_ELSEWHERE.get(unit.text.lower(), unit.text if unit.type == "UNIT" else "")
    return f"{place.tokens[at].text} {known or 'steps'}", at + 1 + bool(known)


_SEPARATORS: Final = ("then", ",", ":")


def _split(place: Place, start: int, stop: int) -> int:
    """Where a condition ends: at `then`, a comma or a colon; else behind a name with its arguments."""
    for index in outside(place.tokens, start, stop):
        if place.tokens[index].text in _SEPARATORS:
            return index
    name = start + (place.tokens[start].type == "NOT")
    behind: Token | None = place.tokens[name + 1] if name + 1 < stop else None
    if behind is None or behind.type != "LPAR":
        return min(name + 1, stop)
    return next((index + 1 for index in outside(place.tokens, name + 1, stop) if index > name + 1), stop)
