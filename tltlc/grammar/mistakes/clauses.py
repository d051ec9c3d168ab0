"""Explain mistakes in whole clauses: an unknown keyword, a keyword inside a formula, a limit in other words.

Each function of ``CLAUSE_RULES`` recognises one mistake. It returns the error, or None if parsing
failed for another reason.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import (
    CLAUSES,
    DECLARATIONS,
    JUDGE,
    OPERATORS,
    RULE_WORDS,
    SYNONYMS,
    TEST_ITEMS,
    UNITS_ELSEWHERE,
    closest_word,
)
from tltlc.grammar.lexer import BAD, END, Token
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english import condition_line
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, TEMPORAL, UNCLEAR, has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import (
    BEFORE_ONE,
    INFIX,
    KEYWORDS,
    NOUNS,
    OPENING,
    UNTILS,
    ParseFailure,
    quote_token,
)
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    operand_text,
    span_of,
    suggest_rewrite,
    text_of,
)
from tltlc.grammar.tables import load

_IN_BRACKETS: Final = (
    "begin with a keyword, and put brackets around what `{word}` applies to: `avoid (a until b)`, "
    "`require (not a) until b`"
)
_ONCE: Final = "write `require a` for the first step, `keep a` for every step, `reach a` for at least one step"
_BEHIND_THEN: Final = (
    "`then` joins the goals of `reach`; write what must hold or happen after `a` as a separate clause: "
    "`keep a implies always b`, `keep a implies always not b`, `keep a implies eventually b`"
)
_IN_TIME: Final = (
    "`{limit}` ends every episode at that time; to give a formula a time, write it after the operator: "
    "`require eventually within {time} a`, `require always for {time} a`"
)
_LIMITS: Final = frozenset(
    tuple(phrase.split())
    for phrase in (
        *(f"{word} {joint} N" for word in ("limit", "timeout") for joint in ("", "of", "is", "at")),
        *(f"limit {words} N" for words in ("to", "time", "time to", "max", "maximum", "at most", "to at most")),
        *("max time N", "maximum time N", "N limit", "N timeout"),
    )
)
"""Phrases that can only mean a limit of the episode, split into words.

``N`` stands for the number. Units are left out: ``limit of 400 steps`` is ``("limit", "of", "N")``.
"""
_MARKS: Final = frozenset("-–—*+•·.:)")
"""Bullets that people write before the lines of a list. `!` is not among them: it means `not`."""
_LONGEST_LIMIT: Final = 7
_FEW: Final = 4
"""A line that has a time and at most this many tokens probably says nothing but the time."""
_SETTING: Final = 2
"""The most tokens of a line that is rather a setting, such as `difficulty hard`, than a sentence."""
_TIMES: Final = frozenset(("step", "steps", "ms", "s", "min", "h"))
"""The units of a limit."""
_OF_OPERATOR: Final = {"EVENTUALLY": "reach", "ALWAYS": "keep", "NOT": "avoid"}
"""Maps an operator at the beginning of a line to the clause keyword that means the same."""


def unknown_keyword(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if the first word is no keyword that can begin such a piece of text, else None.

    An example is ``get a`` in place of the clause ``reach a``.
    """
    keywords, token = KEYWORDS.get(failure.start), failure.token
    if failure.stop.index or not keywords or failure.is_at_end or token.type in OPENING.values():
        return None
    title = f"a {NOUNS[failure.start]} cannot begin with {quote_token(token)}"
    if failure.start == "declaration" and token.text in {**CLAUSES, **TEST_ITEMS}:
        return _outside_error(failure)
    diagnostic = _line_without_keyword(failure, title) if failure.start == "clause" else None
    if diagnostic:
        return diagnostic
    keyword = SYNONYMS[failure.start].get(token.text.lower())
    if keyword and failure.start == "clause" and not _is_clear_keyword(failure, keyword):
        return failure.error("TLT0107", title, _ONCE if keyword == "require" else _IN_BRACKETS.format(word=token.text))
    if keyword is None and token.type == "NAME":
        keyword = closest_word(token.text, tuple(keywords))
    message = f"did you mean `{keyword}`?" if keyword else ""
    is_sentence = failure.start == "clause" and len(failure.tokens) - 1 > _SETTING
    help_ = RULE_WORDS if is_sentence else f"use one of {', '.join(f'`{word}`' for word in keywords)}"
    return failure.error("TLT0107", title, None if keyword else help_, message, write=keyword)


def _is_clear_keyword(failure: ParseFailure, keyword: str) -> bool:
    """Whether a clause has only one possible meaning if ``keyword`` replaces its first word."""
    stop = len(failure.tokens) - 1
    if keyword == "require":
        return not is_of_one_step(failure, 1, stop)
    if failure.token.text.lower() == "never":
        return not has_token(failure, 1, stop, INFIX)
    allowed = {"keep": {"IMPLIES", "IFF"}, "reach": {"THEN"}}.get(keyword, set())
    return not has_token(failure, 1, stop, UNCLEAR - allowed)


def clause_outside_spec(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a clause follows a complete declaration, outside any spec, else None."""
    whole = failure.start == "declaration" and END in failure.allowed_terminals
    return _outside_error(failure) if whole and failure.token.text in CLAUSES and not failure.open_brackets else None


def clause_inside_formula(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a clause stands inside a formula, else None.

    Examples are ``keep p implies reach q`` and ``spec s = keep p``.
    """
    word, before, at = failure.token.text, failure.previous_token, failure.stop.index
    if word not in OPERATORS or before is None or not failure.wants_operand or failure.token.type == "NAME":
        return None
    title = f"{quote_token(failure.token)} begins a clause; it cannot be used inside a formula"
    start, stop, clause = formula_start(failure), formula_stop(failure), _clause_keyword(failure)
    # An operator in place of the keyword would apply to all that follows; the author may mean one operand only.
    diagnostic, is_alone = None, not has_token(failure, at + 1, stop, INFIX - {"THEN"} if word == "reach" else INFIX)
    if before.type == "THEN" and not _is_next_goal(failure, word):
        return failure.error("TLT0107", title, _BEHIND_THEN)
    if before.type == "EQUAL" and failure.tokens[0].type == "SPEC":
        text = f"{{ {text_of(failure, at, stop)} }}"
        diagnostic = suggest_rewrite(failure, at - 1, stop, text, title, ": clauses go in braces", "TLT0107")
    elif before.type == "THEN":
        diagnostic = suggest_rewrite(
            failure, at - 1, at + 1, before.text, title, " alone: the next goal needs no `reach`", "TLT0107"
        )
    elif before.type == "OR" and clause in OPERATORS and not failure.open_brackets:
        # Clauses that are joined by `or` each become a formula of their own.
        left, right = operand_text(failure, start - 1, at - 1), operand_text(failure, at, stop)
        text = f"require ({left}) {before.text} ({right})"
        if is_alone and not has_token(failure, start, at, UNCLEAR | TEMPORAL):
            diagnostic = suggest_rewrite(failure, 0, stop, text, title, code="TLT0107")
    elif is_alone and _is_clear_operator(failure, start, at, word):
        diagnostic = suggest_rewrite(failure, at, stop, operand_text(failure, at, stop), title, code="TLT0107")
    return diagnostic or failure.error("TLT0107", title, _operator_help(word, word))


def synonym_inside_formula(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a synonym of a clause keyword stands inside a formula, else None.

    An example is ``keep a implies never b``: ``never`` is a synonym of ``avoid``.
    """
    before, at = failure.previous_token, failure.stop.index - 1
    keyword = (
        SYNONYMS["clause"].get(before.text) if before and before.type == "NAME" and failure.wants_operator else None
    )
    if before is None or keyword is None or at < 1:
        return None
    start, stop, title = formula_start(failure), formula_stop(failure), failure.misplaced(before)
    if failure.tokens[at - 1].type == "THEN" and not _is_next_goal(failure, keyword):
        return failure.error("TLT0101", title, _BEHIND_THEN, span=before.span)
    diagnostic = None
    if not has_token(failure, at + 1, stop, INFIX) and (
        failure.tokens[at - 1].type == "THEN" or _is_clear_operator(failure, start, at, keyword)
    ):
        operator = "" if failure.tokens[at - 1].type == "THEN" else OPERATORS[keyword]
        text = f"{operator} {operand_text(failure, at + 1, stop)}".strip()
        diagnostic = suggest_rewrite(failure, at, stop, text, title)
    return diagnostic or failure.error("TLT0101", title, _operator_help(before.text, keyword), span=before.span)


def _clause_keyword(failure: ParseFailure) -> str:
    """Return the keyword of the clause in which parsing failed, or "" if it failed outside a clause."""
    return failure.tokens[0].text if failure.start == "clause" else ""


def _is_next_goal(failure: ParseFailure, word: str) -> bool:
    """Whether the keyword ``word`` after `then` is `reach` and can be left out, as in ``a then reach b``."""
    return word == "reach" and _clause_keyword(failure) not in ("keep", "avoid")


def _is_clear_operator(failure: ParseFailure, start: int, at: int, word: str) -> bool:
    """Whether a clause keyword inside a formula can only mean an operator, such as `always` for `keep`.

    ``word`` is the keyword, ``at`` its index, and ``start`` the index where the formula begins.
    """
    before, clause = failure.tokens[at - 1].type, _clause_keyword(failure)
    if before in ("IMPLIES", "IFF", "NOT") and word != "reach":
        # `keep a` after a condition may ask for `a` only while the condition holds.
        return False
    if clause in ("reach", "avoid") or before in UNTILS or has_token(failure, start, at, TEMPORAL):
        return False
    return clause != "keep" or before != "OR"


def _operator_help(word: str, keyword: str) -> str:
    help_ = f"inside a formula, write `{f'{OPERATORS[keyword]} a'.strip()}` for `{word} a`"
    if keyword in ("keep", "avoid"):
        help_ += f": it applies from there to the end; for one step, write `{'a' if keyword == 'keep' else 'not a'}`"
    return help_


def joined_clauses(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if an operator joins clauses, as in ``keep a and keep b``, else None."""
    word, before = failure.token.text, failure.previous_token
    if (
        failure.start != "clause"
        or word not in CLAUSES
        or before is None
        or before.type != "AND"
        or failure.open_brackets
    ):
        return None
    title, span = f"clauses cannot be joined by {quote_token(before)}", span_of([before, failure.token])
    # `always a and reach b` may mean `always (a and eventually b)`, and a quantifier extends over the `and`.
    if has_token(failure, 1, failure.stop.index, UNCLEAR | BEFORE_ONE | QUANTIFIERS | {"OR"}):
        help_ = f"leave out {quote_token(before)}, and begin a new line with `{word}`: all clauses count"
        return failure.error("TLT0101", title, help_, span=span)
    return failure.error("TLT0101", title, f"write `{word}` alone: all clauses count", span=span, write=word)


def limit_in_other_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a ``limit`` clause has a wrong form, else None.

    Examples are ``limit of 400 steps`` and ``limit: 20 seconds``.
    """
    return (
        _limit_error(failure, "a limit is a number of steps or a time") if failure.tokens[0].type == "LIMIT" else None
    )


def judge_without_at(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if `at` is missing, as in ``judge goal``, else None."""
    if failure.previous_token is None or failure.previous_token.type != "JUDGE" or failure.token.text not in JUDGE:
        return None
    text = f"at {failure.token.text}"
    return failure.error("TLT0101", failure.expectation(), f"write `{text}`", write=text)


def clauses_without_braces(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if the braces of a spec are missing or wrong, else None.

    Examples are ``spec s: keep a`` and ``spec s = { keep a }``.
    """
    before, token = failure.previous_token, failure.token
    if before is None or failure.tokens[0].type != "SPEC":
        return None
    title = "the clauses of a spec must be in braces"
    if before.type == "EQUAL" and token.type == "LBRACE":
        span = span_of([before, token])
        return failure.error("TLT0101", f"{title}, without `=`", "write `{` alone", span=span, write="{")
    if "LBRACE" not in failure.allowed_terminals or not (token.text in CLAUSES or token.text in (":", "(", "[")):
        return None
    return failure.error("TLT0101", title, "put `{` before the first clause and `}` after the last one")


def sign_behind_keyword(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a sign follows the keyword of a clause, as in ``reach: a``, else None."""
    if failure.start != "clause" or failure.stop.index != 1 or failure.token.text not in (":", "="):
        return None
    word = failure.tokens[0].text
    title = f"{quote_token(failure.token)} cannot follow `{word}`"
    return failure.error("TLT0104", title, f"write `{word}` alone", span=span_of(failure.tokens[:2]), write=word)


def _outside_error(failure: ParseFailure) -> Diagnostic:
    word = failure.token.text
    if word in CLAUSES:
        help_ = f"put it in a spec: `spec NAME {{ {word} … }}`"
        return failure.error("TLT0107", f"`{word}` can be used only inside a spec", help_)
    return failure.error(
        "TLT0107", f"`{word}` can be used only inside a test", f"put it in a test: {DECLARATIONS['test']}"
    )


def _line_without_keyword(failure: ParseFailure, title: str) -> Diagnostic | None:
    """Return the error for a line of a spec without a keyword, such as ``always a``, or None.

    The help of the error guesses what the line means. None means that this function cannot explain
    the line.
    """
    tokens, token = failure.tokens, failure.token
    diagnostic = _limit_error(failure, title)
    if diagnostic:
        return diagnostic
    at = next((index for index in (1, 2) if tokens[index:] and tokens[index].text in CLAUSES), None)
    if at and all(item.type == "NUMBER" or item.text in _MARKS for item in tokens[:at]):
        word, signs, span = tokens[at].text, text_of(failure, 0, at), span_of(tokens[: at + 1])
        title = f"a clause cannot begin with `{signs}`"
        return failure.error("TLT0107", title, f"write `{word}` alone", span=span, write=word)
    if not any(_is_word(item) for item in tokens[:-1]):
        return failure.error("TLT0107", title, "leave it out: a clause begins with its keyword")
    diagnostic = condition_line(failure)
    if diagnostic:
        return diagnostic
    if token.type in _OF_OPERATOR and tokens[1].text in CLAUSES:
        return failure.error("TLT0107", title, f"leave it out, and say what you mean with `{tokens[1].text}` alone")
    if token.type in _OF_OPERATOR:
        # A keyword applies to its whole line, an operator only to the next operand; and a clause takes no bound.
        bound = len(tokens) > 2 and tokens[1].text in ("within", "for", "[")
        stop = len(tokens) - 1
        if has_token(failure, 1, stop, INFIX):
            return failure.error("TLT0107", title, _IN_BRACKETS.format(word=token.text))
        if bound:
            text = f"require {text_of(failure, 0, stop)}"
            diagnostic = suggest_rewrite(
                failure, 0, stop, text, title, ": `require` takes the formula as it is written", "TLT0107"
            )
            return diagnostic or failure.error("TLT0107", title, _IN_BRACKETS.format(word=token.text))
        keyword = _OF_OPERATOR[token.type]
        return failure.error("TLT0107", title, None, f"did you mean `{keyword}`?", write=keyword)
    if token.type in INFIX:
        return failure.error(
            "TLT0107", title, f"`{token.text}` belongs between two formulas, but there is none before it"
        )
    if token.text.lower() in ("allow", "permit", "may", "can"):
        return failure.error("TLT0107", title, "leave it out: everything that no clause forbids is allowed")
    next_words = failure.source.text[tokens[-1].end :].partition("\n")[0].split()
    if len(tokens) == 2 and next_words and next_words[0] in CLAUSES:
        return failure.error("TLT0107", title, f"leave it out: `{next_words[0]}` counts without it")
    if token.text.lower() in SYNONYMS["clause"]:
        return None
    text = text_of(failure, 0, len(tokens) - 1)
    if not suggest_rewrite(failure, 0, len(tokens) - 1, f"reach {text}", title):
        return None
    return failure.error("TLT0107", title, f"write `reach {text}`, or `keep {text}` for every step")


def _limit_error(failure: ParseFailure, title: str) -> Diagnostic | None:
    """Return an error if a line has only a number, its unit and a few words, such as ``20 s limit``, else None.

    The error has a fix if the line can only mean a limit.
    """
    tokens = [token for token in failure.tokens[:-1] if token.text not in (":", "=", ",")]
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
    phrase = tuple("N" if token in numbers else token.text.lower() for token in tokens if token not in units)
    text, code = f"limit {numbers[0].text} {unit}", "TLT0101" if failure.stop.index else "TLT0107"
    is_clear = bool(units) or not (any("time" in word for word in phrase) or declared_names(failure.source).has_clock)
    if is_clear and phrase in _LIMITS and (failure.tokens[0].type == "LIMIT" or is_own_line(failure)):
        diagnostic = suggest_rewrite(failure, 0, len(failure.tokens) - 1, text, title, code=code)
        if diagnostic:
            return diagnostic
    first = tokens[0]
    if len(tokens) > _FEW or (first.type == "NAME" and closest_word(first.text, tuple(CLAUSES))):
        return None
    time = f"{numbers[0].text} {unit}"
    if failure.clock_varies:
        is_steps = unit in ("step", "steps")
        text, time = (text, "2 s") if is_steps else ("limit 400 steps", time)
    return failure.error(code, title, _IN_TIME.format(limit=text, time=time))


def is_own_line(failure: ParseFailure) -> bool:
    """Whether nothing but braces and comments stands beside the broken text on its lines."""
    text, tokens = failure.source.text, failure.tokens
    before = text[: tokens[0].start].rpartition("\n")[2].rpartition("{")[2]
    after = text[tokens[-1].end :].partition("\n")[0].partition("//")[0].partition("}")[0]
    return not before.strip() and not after.strip()


def _is_word(token: Token) -> bool:
    return token.text[:1].isalpha() and token.type != BAD


CLAUSE_RULES: Final[tuple[Callable[[ParseFailure], Diagnostic | None], ...]] = (
    unknown_keyword,
    clauses_without_braces,
    clause_outside_spec,
    joined_clauses,
    clause_inside_formula,
    synonym_inside_formula,
    limit_in_other_words,
    sign_behind_keyword,
    judge_without_at,
)
