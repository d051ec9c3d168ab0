"""Errors about whole clauses: an unknown keyword, a keyword inside a formula, a limit in other words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import (
    CLAUSES,
    DECLARATIONS,
    JUDGE,
    OPERATORS,
    SYNONYMS,
    TEST_ITEMS,
    UNITS_ELSEWHERE,
    closest,
)
from tltlc.grammar.lexer import BAD, END, Token
from tltlc.grammar.mistakes.english import conditional
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, TEMPORAL, UNCLEAR, has, is_of_one_step
from tltlc.grammar.mistakes.place import (
    BEFORE_ONE,
    INFIX,
    KEYWORDS,
    NOUNS,
    OPENING,
    UNTILS,
    Place,
    declares_clock,
    shown,
)
from tltlc.grammar.mistakes.rephrasing import formula_start, formula_stop, operand, reworded, span_of, written
from tltlc.grammar.tables import load

_IN_BRACKETS: Final = (
    "put in brackets what `{word}` belongs to, behind a keyword: `avoid (a until b)`, `require (not a) until b`"
)
_ONCE: Final = "`require a` is about the first step, `keep a` about every one, `reach a` about some one"
_BEHIND_THEN: Final = (
    "`then` joins the goals of `reach`; what holds, or comes, after `a` is a clause of its own: "
    "`keep a implies always b`, `keep a implies always not b`, `keep a implies eventually b`"
)
_IN_TIME: Final = (
    "`{limit}` ends every episode then; a time of what is asked for stands behind its operator: "
    "`require eventually within {time} a`, `require always for {time} a`, `require next after {time} a`"
)
_LIMITS: Final = frozenset(
    (
        *(f"{word}{joint} N" for word in ("limit", "timeout") for joint in ("", " of", " is", " at")),
        *(f"limit {words} N" for words in ("to", "time", "time to", "max", "maximum", "at most", "to at most")),
        *("max time N", "maximum time N", "N limit", "N timeout"),
    )
)
"""The phrases around the number ``N``, without its unit, that can only mean a limit of the episode."""
_MARKS: Final = frozenset("-–—*+•·.:)")
"""Characters that begin the lines of lists; others, such as `!`, may change the meaning of the clause after them."""
_LONGEST_LIMIT: Final = 7
_FEW: Final = 4
"""A line with a time and at most this many tokens is most likely only a time."""
_TIMES: Final = frozenset(("step", "steps", "ms", "s", "min", "h"))
"""The units of a limit."""
_OF_OPERATOR: Final = {"EVENTUALLY": "reach", "ALWAYS": "keep", "NOT": "avoid"}
"""The keyword of the clause that an operator at the beginning of a line stands for."""


def unknown_keyword(place: Place) -> Diagnostic | None:
    """Report a piece that does not begin with a keyword of its kind."""
    keywords, token = KEYWORDS.get(place.start), place.found
    if place.stop.index or not keywords or place.at_end or token.type in OPENING.values():
        return None
    title = f"no {NOUNS[place.start]} begins with {shown(token)}"
    if place.start == "declaration" and token.text in {**CLAUSES, **TEST_ITEMS}:
        return _outside(place)
    diagnostic = _no_clause(place, title) if place.start == "clause" else None
    if diagnostic:
        return diagnostic
    near = SYNONYMS[place.start].get(token.text.lower())
    if near and place.start == "clause" and not _is_clear_keyword(place, near):
        return place.error("TLT0107", title, _ONCE if near == "require" else _IN_BRACKETS.format(word=token.text))
    if near is None and token.type == "NAME":
        near = closest(token.text, tuple(keywords))
    message = f"did you mean `{near}`?" if near else ""
    listed = ", ".join(f"`{word}`" for word in keywords)
    return place.error("TLT0107", title, None if near else f"one of {listed}", message, write=near)


def _is_clear_keyword(place: Place, near: str) -> bool:
    """Whether the keyword alone can replace the word, judged by what follows."""
    stop = len(place.tokens) - 1
    if near == "require":
        return not is_of_one_step(place, 1, stop)
    if place.found.text.lower() == "never":
        return not has(place, 1, stop, INFIX)
    allowed = {"keep": {"IMPLIES", "IFF"}, "reach": {"THEN"}}.get(near, set())
    return not has(place, 1, stop, UNCLEAR - allowed)


def clause_outside(place: Place) -> Diagnostic | None:
    """Report a clause after a complete declaration."""
    whole = place.start == "declaration" and END in place.allowed
    return _outside(place) if whole and place.found.text in CLAUSES and not place.open_brackets else None


def clause_inside(place: Place) -> Diagnostic | None:
    """Report ``keep p implies reach q``, ``reach a then avoid b``, ``spec s = keep p``."""
    word, before, at = place.found.text, place.before, place.stop.index
    if word not in OPERATORS or before is None or not place.wants_operand or place.found.type == "NAME":
        return None
    title = f"{shown(place.found)} begins a clause, and stands in no formula"
    start, stop, clause = formula_start(place), formula_stop(place), _clause(place)
    # The operator would apply to all that follows, although the keyword may be meant for the next operand only.
    diagnostic, is_alone = None, not has(place, at + 1, stop, INFIX - {"THEN"} if word == "reach" else INFIX)
    if before.type == "THEN" and not _is_next_goal(place, word):
        return place.error("TLT0107", title, _BEHIND_THEN)
    if before.type == "EQUAL" and place.tokens[0].type == "SPEC":
        text = f"{{ {written(place, at, stop)} }}"
        diagnostic = reworded(place, at - 1, stop, text, title, ": clauses stand in braces", "TLT0107")
    elif before.type == "THEN":
        diagnostic = reworded(place, at - 1, at + 1, before.text, title, ", which says it already", "TLT0107")
    elif before.type == "OR" and clause in OPERATORS and not place.open_brackets:
        # Clauses that are joined by `or` each become a formula of their own.
        left, right = operand(place, start - 1, at - 1), operand(place, at, stop)
        text = f"require ({left}) {before.text} ({right})"
        if is_alone and not has(place, start, at, UNCLEAR | TEMPORAL):
            diagnostic = reworded(place, 0, stop, text, title, code="TLT0107")
    elif is_alone and _is_clear_operator(place, start, at, word):
        diagnostic = reworded(place, at, stop, operand(place, at, stop), title, code="TLT0107")
    return diagnostic or place.error("TLT0107", title, _inside(word, word))


def synonym_inside(place: Place) -> Diagnostic | None:
    """Report ``keep a implies never b``."""
    before, at = place.before, place.stop.index - 1
    keyword = SYNONYMS["clause"].get(before.text) if before and before.type == "NAME" and place.wants_operator else None
    if before is None or keyword is None or at < 1:
        return None
    start, stop, title = formula_start(place), formula_stop(place), f"{shown(before)} is no operator"
    if place.tokens[at - 1].type == "THEN" and not _is_next_goal(place, keyword):
        return place.error("TLT0101", title, _BEHIND_THEN, span=before.span)
    diagnostic = None
    if not has(place, at + 1, stop, INFIX) and (
        place.tokens[at - 1].type == "THEN" or _is_clear_operator(place, start, at, keyword)
    ):
        operator = "" if place.tokens[at - 1].type == "THEN" else OPERATORS[keyword]
        text = f"{operator} {operand(place, at + 1, stop)}".strip()
        diagnostic = reworded(place, at, stop, text, title)
    return diagnostic or place.error("TLT0101", title, _inside(before.text, keyword), span=before.span)


def _clause(place: Place) -> str:
    """Return the keyword of the clause, also inside brackets; empty outside clauses."""
    return place.tokens[0].text if place.start == "clause" else ""


def _is_next_goal(place: Place, word: str) -> bool:
    """Whether a keyword after `then` only repeats that a goal follows."""
    return word == "reach" and _clause(place) not in ("keep", "avoid")


def _is_clear_operator(place: Place, start: int, at: int, word: str) -> bool:
    """Whether a keyword at this place in a formula can only mean its operator."""
    before, clause = place.tokens[at - 1].type, _clause(place)
    if before in ("IMPLIES", "IFF", "NOT") and word != "reach":
        # `keep` after a condition may mean only as long as the condition holds.
        return False
    if clause in ("reach", "avoid") or before in UNTILS or has(place, start, at, TEMPORAL):
        return False
    return clause != "keep" or before != "OR"


def _inside(word: str, keyword: str) -> str:
    help_ = f"inside a formula, `{word} a` is `{f'{OPERATORS[keyword]} a'.strip()}`"
    if keyword in ("keep", "avoid"):
        help_ += f", from there to the end; of one step, write `{'a' if keyword == 'keep' else 'not a'}`"
    return help_


def joined_clauses(place: Place) -> Diagnostic | None:
    """Report ``keep a and keep b``."""
    word, before = place.found.text, place.before
    if place.start != "clause" or word not in CLAUSES or before is None or before.type != "AND" or place.open_brackets:
        return None
    title, span = f"clauses are not joined by {shown(before)}", span_of([before, place.found])
    # `always a and reach b` may mean `always (a and eventually b)`, and a quantifier extends over the `and`.
    if has(place, 1, place.stop.index, UNCLEAR | BEFORE_ONE | QUANTIFIERS | {"OR"}):
        return place.error("TLT0101", title, f"let `{word}` begin a line of its own: all clauses count", span=span)
    return place.error("TLT0101", title, f"write `{word}` alone: all clauses count", span=span, write=word)


def limit_in_other_words(place: Place) -> Diagnostic | None:
    """Report ``limit of 400 steps``, ``limit: 20 seconds``."""
    return _limit(place, "a limit is a number of steps or a time") if place.tokens[0].type == "LIMIT" else None


def judge(place: Place) -> Diagnostic | None:
    """Report ``judge goal``."""
    if place.before is None or place.before.type != "JUDGE" or place.found.text not in JUDGE:
        return None
    text = f"at {place.found.text}"
    return place.error("TLT0101", place.expectation(), f"write `{text}`", write=text)


def without_braces(place: Place) -> Diagnostic | None:
    """Report ``spec s: keep a``, ``spec s ( keep a )`` and ``spec s = { keep a }``."""
    before, token = place.before, place.found
    if before is None or place.tokens[0].type != "SPEC":
        return None
    title = "the clauses of a spec stand in braces"
    if before.type == "EQUAL" and token.type == "LBRACE":
        span = span_of([before, token])
        return place.error("TLT0101", f"{title}, without `=`", "write `{` alone", span=span, write="{")
    if "LBRACE" not in place.allowed or not (token.text in CLAUSES or token.text in (":", "(", "[")):
        return None
    return place.error("TLT0101", title, "put `{` before the first one and `}` behind the last")


def sign_behind_keyword(place: Place) -> Diagnostic | None:
    """Report ``reach: a``."""
    if place.start != "clause" or place.stop.index != 1 or place.found.text not in (":", "="):
        return None
    word = place.tokens[0].text
    title = f"no {shown(place.found)} stands behind `{word}`"
    return place.error("TLT0104", title, f"write `{word}` alone", span=span_of(place.tokens[:2]), write=word)


def _outside(place: Place) -> Diagnostic:
    word = place.found.text
    if word in CLAUSES:
        help_ = f"put it into one: `spec NAME {{ {word} … }}`"
        return place.error("TLT0107", f"`{word}` stands only inside a spec", help_)
    return place.error("TLT0107", f"`{word}` stands only inside a test", f"put it into one: {DECLARATIONS['test']}")


def _no_clause(place: Place, title: str) -> Diagnostic | None:
    """Report a line of a spec that begins with no keyword, with a guess at its meaning."""
    tokens, token = place.tokens, place.found
    diagnostic = _limit(place, title)
    if diagnostic:
        return diagnostic
    at = next((index for index in (1, 2) if tokens[index:] and tokens[index].text in CLAUSES), None)
    if at and all(item.type == "NUMBER" or item.text in _MARKS for item in tokens[:at]):
        word, signs, span = tokens[at].text, written(place, 0, at), span_of(tokens[: at + 1])
        title = f"no clause begins with `{signs}`"
        return place.error("TLT0107", title, f"write `{word}` alone", span=span, write=word)
    if not any(_is_word(item) for item in tokens[:-1]):
        return place.error("TLT0107", title, "leave it out: a clause begins with its keyword")
    diagnostic = conditional(place)
    if diagnostic:
        return diagnostic
    if token.type in _OF_OPERATOR and tokens[1].text in CLAUSES:
        return place.error("TLT0107", title, f"leave it out, and say with `{tokens[1].text}` alone what is meant")
    if token.type in _OF_OPERATOR:
        # A keyword applies to its whole line, an operator only to the next operand; and a clause takes no bound.
        bound = len(tokens) > 2 and tokens[1].text in ("within", "for", "[")
        stop = len(tokens) - 1
        if has(place, 1, stop, INFIX):
            return place.error("TLT0107", title, _IN_BRACKETS.format(word=token.text))
        if bound:
            text = f"require {written(place, 0, stop)}"
            diagnostic = reworded(place, 0, stop, text, title, ": the formula as it is written", "TLT0107")
            return diagnostic or place.error("TLT0107", title, _IN_BRACKETS.format(word=token.text))
        keyword = _OF_OPERATOR[token.type]
        return place.error("TLT0107", title, None, f"did you mean `{keyword}`?", write=keyword)
    if token.type in INFIX:
        return place.error("TLT0107", title, f"it stands between two formulas, and there is none before `{token.text}`")
    if token.text.lower() in ("allow", "permit", "may", "can"):
        return place.error("TLT0107", title, "leave it out: whatever no clause forbids is allowed")
    next_words = place.source.text[tokens[-1].end :].partition("\n")[0].split()
    if len(tokens) == 2 and next_words and next_words[0] in CLAUSES:
        return place.error("TLT0107", title, f"leave it out: `{next_words[0]}` says by itself that it counts")
    if token.text.lower() in SYNONYMS["clause"]:
        return None
    text = written(place, 0, len(tokens) - 1)
    if not reworded(place, 0, len(tokens) - 1, f"reach {text}", title):
        return None
    return place.error("TLT0107", title, f"write `reach {text}`, or `keep {text}` for every step")


def _limit(place: Place, title: str) -> Diagnostic | None:
    """Report a piece of a number, its unit and a few words: with a fix if it can only be a limit, else with a help."""
    tokens = [token for token in place.tokens[:-1] if token.text not in (":", "=", ",")]
    if len(tokens) > _LONGEST_LIMIT:
        return None
    numbers = [token for token in tokens if token.type == "NUMBER"]
    units = [token for token in tokens if token.type == "UNIT" or token.text in load().units]
    units = units or [token for token in tokens if token.text.lower() in UNITS_ELSEWHERE]
    words = [token for token in tokens if token not in (*numbers, *units)]
    if len(numbers) != 1 or len(units) > 1 or not all(map(_is_word, words)):
        return None
    named = [token.type == "LIMIT" for token in words if token.text in CLAUSES]
    if not all(named) or not (named or units):
        return None
    unit = UNITS_ELSEWHERE.get(units[0].text.lower(), units[0].text) if units else "steps"
    if unit not in _TIMES:
        return None
    phrase = " ".join(token.text.lower() for token in tokens if token not in units)
    text, code = f"limit {numbers[0].text} {unit}", "TLT0101" if place.stop.index else "TLT0107"
    is_clear = bool(units) or not ("time" in phrase or declares_clock(place.source))
    if (
        is_clear
        and phrase.replace(numbers[0].text, "N") in _LIMITS
        and (place.tokens[0].type == "LIMIT" or _is_own_line(place))
    ):
        diagnostic = reworded(place, 0, len(place.tokens) - 1, text, title, code=code)
        if diagnostic:
            return diagnostic
    first = tokens[0]
    if len(tokens) > _FEW or (first.type == "NAME" and closest(first.text, tuple(CLAUSES))):
        return None
    return place.error(code, title, _IN_TIME.format(limit=text, time=f"{numbers[0].text} {unit}"))


def _is_own_line(place: Place) -> bool:
    """Whether the piece stands alone on its lines, apart from braces and comments."""
    text, tokens = place.source.text, place.tokens
    before = text[: tokens[0].start].rpartition("\n")[2].rpartition("{")[2]
    after = text[tokens[-1].end :].partition("\n")[0].partition("//")[0].partition("}")[0]
    return not before.strip() and not after.strip()


def _is_word(token: Token) -> bool:
    return token.text[:1].isalpha() and token.type != BAD


CLAUSE_RULES: Final[tuple[Callable[[Place], Diagnostic | None], ...]] = (
    unknown_keyword,
    without_braces,
    clause_outside,
    joined_clauses,
    clause_inside,
    synonym_inside,
    limit_in_other_words,
    sign_behind_keyword,
    judge,
)
