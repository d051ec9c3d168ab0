"""What is wrong with a clause as a whole: an unknown keyword, one inside a formula, a limit in other words."""

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
"""The words beside the number ``N``, without its unit, that mean a limit of the episode and nothing else."""
_MARKS: Final = frozenset("-–—*+•·.:)")
"""Signs with which the lines of lists begin; others, as `!`, may say something of the clause behind them."""
_LONGEST_LIMIT: Final = 7
_FEW: Final = 4
"""Of how many words and signs a line with a time is most likely nothing but a time."""
_TIMES: Final = frozenset(("step", "steps", "ms", "s", "min", "h"))
"""The units that a limit can have."""
_OF_OPERATOR: Final = {"EVENTUALLY": "reach", "ALWAYS": "keep", "NOT": "avoid"}
"""The clauses that operators at the beginning of a line stand for."""


def unknown_keyword(place: Place) -> Diagnostic | None:
    """A piece that begins with no keyword of its kind."""
    keywords, token = KEYWORDS.get(place.start), place.found
    if place.stop.index or not keywords or place.at_end or token.type in OPENING.values():
        return None
    title = f"no {NOUNS[place.start]} begins with {shown(token)}"
    if place.start == "declaration" and token.text in {**CLAUSES, **TEST_ITEMS}:
        return _outside(place)
    found = _no_clause(place, title) if place.start == "clause" else None
    if found:
        return found
    near = SYNONYMS[place.start].get(token.text.lower())
    if near and place.start == "clause" and not _is_clear_keyword(place, near):
        return place.error("TLT0107", title, _ONCE if near == "require" else _IN_BRACKETS.format(word=token.text))
    if near is None and token.type == "NAME":
        near = closest(token.text, tuple(keywords))
    message = f"did you mean `{near}`?" if near else ""
    listed = ", ".join(f"`{word}`" for word in keywords)
    return place.error("TLT0107", title, None if near else f"one of {listed}", message, write=near)


def _is_clear_keyword(place: Place, near: str) -> bool:
    """Whether a word can be replaced by this keyword alone, by what follows it."""
    stop = len(place.tokens) - 1
    if near == "require":
        return not is_of_one_step(place, 1, stop)
    if place.found.text.lower() == "never":
        return not has(place, 1, stop, INFIX)
    allowed = {"keep": {"IMPLIES", "IFF"}, "reach": {"THEN"}}.get(near, set())
    return not has(place, 1, stop, UNCLEAR - allowed)


def clause_outside(place: Place) -> Diagnostic | None:
    """A clause behind a whole declaration."""
    whole = place.start == "declaration" and END in place.allowed
    return _outside(place) if whole and place.found.text in CLAUSES and not place.open_brackets else None


def clause_inside(place: Place) -> Diagnostic | None:
    """``keep p implies reach q``, ``reach a then avoid b``, ``spec s = keep p``."""
    word, before, at = place.found.text, place.before, place.stop.index
    if word not in OPERATORS or before is None or not place.wants_operand or place.found.type == "NAME":
        return None
    title = f"{shown(place.found)} begins a clause, and stands in no formula"
    start, stop, clause = formula_start(place), formula_stop(place), _clause(place)
    # It would take all that follows, where it may belong to what stands right behind it.
    found, is_alone = None, not has(place, at + 1, stop, INFIX - {"THEN"} if word == "reach" else INFIX)
    if before.type == "THEN" and not _is_next_goal(place, word):
        return place.error("TLT0107", title, _BEHIND_THEN)
    if before.type == "EQUAL" and place.tokens[0].type == "SPEC":
        text = f"{{ {written(place, at, stop)} }}"
        found = reworded(place, at - 1, stop, text, title, ": clauses stand in braces", "TLT0107")
    elif before.type == "THEN":
        found = reworded(place, at - 1, at + 1, before.text, title, ", which says it already", "TLT0107")
    elif before.type == "OR" and clause in OPERATORS and not place.open_brackets:
        # Of clauses that are joined by `or`, each one is a formula of its own.
        either, other = operand(place, start - 1, at - 1), operand(place, at, stop)
        text = f"require ({either}) {before.text} ({other})"
        if is_alone and not has(place, start, at, UNCLEAR | TEMPORAL):
            found = reworded(place, 0, stop, text, title, code="TLT0107")
    elif is_alone and _is_clear_operator(place, start, at, word):
        found = reworded(place, at, stop, operand(place, at, stop), title, code="TLT0107")
    return found or place.error("TLT0107", title, _inside(word, word))


def synonym_inside(place: Place) -> Diagnostic | None:
    """``keep a implies never b``."""
    before, at = place.before, place.stop.index - 1
    meant = SYNONYMS["clause"].get(before.text) if before and before.type == "NAME" and place.wants_operator else None
    if before is None or meant is None or at < 1:
        return None
    start, stop, title = formula_start(place), formula_stop(place), f"{shown(before)} is no operator"
    if place.tokens[at - 1].type == "THEN" and not _is_next_goal(place, meant):
        return place.error("TLT0101", title, _BEHIND_THEN, span=before.span)
    found = None
    if not has(place, at + 1, stop, INFIX) and (
        place.tokens[at - 1].type == "THEN" or _is_clear_operator(place, start, at, meant)
    ):
        operator = "" if place.tokens[at - 1].type == "THEN" else OPERATORS[meant]
        text = f"{operator} {operand(place, at + 1, stop)}".strip()
        found = reworded(place, at, stop, text, title)
    return found or place.error("TLT0101", title, _inside(before.text, meant), span=before.span)


def _clause(place: Place) -> str:
    """The keyword of the clause, in brackets too."""
    return place.tokens[0].text if place.start == "clause" else ""


def _is_next_goal(place: Place, word: str) -> bool:
    """Whether a keyword behind `then` only says once more that a goal follows."""
    return word == "reach" and _clause(place) not in ("keep", "avoid")


def _is_clear_operator(place: Place, start: int, at: int, word: str) -> bool:
    """Whether a keyword at this place of a formula can be nothing but its operator."""
    before, clause = place.tokens[at - 1].type, _clause(place)
    if before in ("IMPLIES", "IFF", "NOT") and word != "reach":
        # What is to be kept may be so where the condition holds, and no longer.
        return False
    if clause in ("reach", "avoid") or before in UNTILS or has(place, start, at, TEMPORAL):
        return False
    return clause != "keep" or before != "OR"


def _inside(word: str, meant: str) -> str:
    help_ = f"inside a formula, `{word} a` is `{f'{OPERATORS[meant]} a'.strip()}`"
    if meant in ("keep", "avoid"):
        help_ += f", from there to the end; of one step, write `{'a' if meant == 'keep' else 'not a'}`"
    return help_


def joined_clauses(place: Place) -> Diagnostic | None:
    """``keep a and keep b``."""
    word, before = place.found.text, place.before
    if place.start != "clause" or word not in CLAUSES or before is None or before.type != "AND" or place.open_brackets:
        return None
    title, span = f"clauses are not joined by {shown(before)}", span_of([before, place.found])
    # `always a and reach b` may mean `always (a and eventually b)`, and a quantifier reaches over the `and`.
    if has(place, 1, place.stop.index, UNCLEAR | BEFORE_ONE | QUANTIFIERS | {"OR"}):
        return place.error("TLT0101", title, f"let `{word}` begin a line of its own: all clauses count", span=span)
    return place.error("TLT0101", title, f"write `{word}` alone: all clauses count", span=span, write=word)


def limit_in_other_words(place: Place) -> Diagnostic | None:
    """``limit of 400 steps``, ``limit: 20 seconds``."""
    return _limit(place, "a limit is a number of steps or a time") if place.tokens[0].type == "LIMIT" else None


def judge(place: Place) -> Diagnostic | None:
    """``judge goal``."""
    if place.before is None or place.before.type != "JUDGE" or place.found.text not in JUDGE:
        return None
    text = f"at {place.found.text}"
    return place.error("TLT0101", place.expectation(), f"write `{text}`", write=text)


def without_braces(place: Place) -> Diagnostic | None:
    """``spec s: keep a``, ``spec s ( keep a )`` and ``spec s = { keep a }``."""
    before, found = place.before, place.found
    if before is None or place.tokens[0].type != "SPEC":
        return None
    title = "the clauses of a spec stand in braces"
    if before.type == "EQUAL" and found.type == "LBRACE":
        span = span_of([before, found])
        return place.error("TLT0101", f"{title}, without `=`", "write `{` alone", span=span, write="{")
    if "LBRACE" not in place.allowed or not (found.text in CLAUSES or found.text in (":", "(", "[")):
        return None
    return place.error("TLT0101", title, "put `{` before the first one and `}` behind the last")


def sign_behind_keyword(place: Place) -> Diagnostic | None:
    """``reach: a``."""
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
    """What was meant by a line of a spec that begins with no keyword."""
    tokens, token = place.tokens, place.found
    found = _limit(place, title)
    if found:
        return found
    mark = next((index for index in (1, 2) if tokens[index:] and tokens[index].text in CLAUSES), None)
    if mark and all(each.type == "NUMBER" or each.text in _MARKS for each in tokens[:mark]):
        word, signs, span = tokens[mark].text, written(place, 0, mark), span_of(tokens[: mark + 1])
        title = f"no clause begins with `{signs}`"
        return place.error("TLT0107", title, f"write `{word}` alone", span=span, write=word)
    if not any(_is_word(each) for each in tokens[:-1]):
        return place.error("TLT0107", title, "leave it out: a clause begins with its keyword")
    found = conditional(place)
    if found:
        return found
    if token.type in _OF_OPERATOR and tokens[1].text in CLAUSES:
        return place.error("TLT0107", title, f"leave it out, and say with `{tokens[1].text}` alone what is meant")
    if token.type in _OF_OPERATOR:
        # A keyword belongs to all of its line, an operator to what stands right behind it; and no clause has a bound.
        bound = len(tokens) > 2 and tokens[1].text in ("within", "for", "[")
        stop = len(tokens) - 1
        if has(place, 1, stop, INFIX):
            return place.error("TLT0107", title, _IN_BRACKETS.format(word=token.text))
        if bound:
            text = f"require {written(place, 0, stop)}"
            found = reworded(place, 0, stop, text, title, ": the formula as it is written", "TLT0107")
            return found or place.error("TLT0107", title, _IN_BRACKETS.format(word=token.text))
        meant = _OF_OPERATOR[token.type]
        return place.error("TLT0107", title, None, f"did you mean `{meant}`?", write=meant)
    if token.type in INFIX:
        return place.error("TLT0107", title, f"it stands between two formulas, and there is none before `{token.text}`")
    if token.text.lower() in ("allow", "permit", "may", "can"):
        return place.error("TLT0107", title, "leave it out: whatever no clause forbids is allowed")
    follows = place.source.text[tokens[-1].end :].partition("\n")[0].split()
    if len(tokens) == 2 and follows and follows[0] in CLAUSES:
        return place.error("TLT0107", title, f"leave it out: `{follows[0]}` says by itself that it counts")
    if token.text.lower() in SYNONYMS["clause"]:
        return None
    text = written(place, 0, len(tokens) - 1)
    if not reworded(place, 0, len(tokens) - 1, f"reach {text}", title):
        return None
    return place.error("TLT0107", title, f"write `reach {text}`, or `keep {text}` for every step")


def _limit(place: Place, title: str) -> Diagnostic | None:
    """A piece that is a number, its unit and a few words: as a limit where it can be nothing else, else with a help."""
    tokens = [token for token in place.tokens[:-1] if token.text not in (":", "=", ",")]
    if len(tokens) > _LONGEST_LIMIT:
        return None
    numbers = [token for token in tokens if token.type == "NUMBER"]
    units = [token for token in tokens if token.type == "UNIT" or token.text in load().units]
    units = units or [token for token in tokens if token.text.lower() in UNITS_ELSEWHERE]
    others = [token for token in tokens if token not in (*numbers, *units)]
    if len(numbers) != 1 or len(units) > 1 or not all(map(_is_word, others)):
        return None
    named = [token.type == "LIMIT" for token in others if token.text in CLAUSES]
    if not all(named) or not (named or units):
        return None
    unit = UNITS_ELSEWHERE.get(units[0].text.lower(), units[0].text) if units else "steps"
    if unit not in _TIMES:
        return None
    words = " ".join(token.text.lower() for token in tokens if token not in units)
    text, code = f"limit {numbers[0].text} {unit}", "TLT0101" if place.stop.index else "TLT0107"
    is_clear = bool(units) or not ("time" in words or declares_clock(place.source))
    if (
        is_clear
        and words.replace(numbers[0].text, "N") in _LIMITS
        and (place.tokens[0].type == "LIMIT" or _is_own_line(place))
    ):
        found = reworded(place, 0, len(place.tokens) - 1, text, title, code=code)
        if found:
            return found
    first = tokens[0]
    if len(tokens) > _FEW or (first.type == "NAME" and closest(first.text, tuple(CLAUSES))):
        return None
    return place.error(code, title, _IN_TIME.format(limit=text, time=f"{numbers[0].text} {unit}"))


def _is_own_line(place: Place) -> bool:
    """Whether nothing but a brace or a comment stands beside the piece on its lines."""
    text, tokens = place.source.text, place.tokens
    before = text[: tokens[0].start].rpartition("\n")[2].rpartition("{")[2]
    behind = text[tokens[-1].end :].partition("\n")[0].partition("//")[0].partition("}")[0]
    return not before.strip() and not behind.strip()


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
