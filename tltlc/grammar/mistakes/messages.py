"""Build the error for a token that does not fit: what was expected, in plain words, and how to fix it.

Each function of ``_RULES`` recognises one mistake. It returns the error, or None if parsing failed for
another reason. The first error counts.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar import lalr, past_words
from tltlc.grammar.keywords import CASES, CLAUSES, DECLARATIONS, closest_word
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.answers_in_rules import answer_in_rule
from tltlc.grammar.mistakes.clauses import CLAUSE_RULES, synonym_inside_formula
from tltlc.grammar.mistakes.compared_tests import compared_test
from tltlc.grammar.mistakes.comparison_words import comparison_in_words
from tltlc.grammar.mistakes.counts_in_words import never_counted
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.durations import duration_in_words
from tltlc.grammar.mistakes.english import plain_english
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK
from tltlc.grammar.mistakes.english_times import never_for_time, until_time
from tltlc.grammar.mistakes.equalities import verb_is
from tltlc.grammar.mistakes.filler_words import filler_word
from tltlc.grammar.mistakes.habits import HABITS, dash_comment, foreign_unit, long_arrow, prefix_between_formulas
from tltlc.grammar.mistakes.membership import membership
from tltlc.grammar.mistakes.misused_operators import misread_index, stop_at
from tltlc.grammar.mistakes.names_side_by_side import is_before_operand, names_side_by_side
from tltlc.grammar.mistakes.negated_answers import negated_answer_in_rule
from tltlc.grammar.mistakes.one_reading import has_token
from tltlc.grammar.mistakes.parse_failure import (
    BEFORE_ONE,
    INFIX,
    OPENING,
    UNTILS,
    ParseFailure,
    quote_token,
)
from tltlc.grammar.mistakes.past import past_in_english
from tltlc.grammar.mistakes.prohibitions import never_states
from tltlc.grammar.mistakes.punctuation import PUNCTUATION, missing_comma
from tltlc.grammar.mistakes.quantifier_words import quantifier_in_words
from tltlc.grammar.mistakes.renaming import word_of_the_past
from tltlc.grammar.mistakes.rephrasing import formula_stop, span_of, text_of
from tltlc.grammar.mistakes.responses import colon_after_event, response_in_english
from tltlc.grammar.mistakes.rules_in_words import rule_in_words
from tltlc.grammar.mistakes.sentences.help import sentence_help
from tltlc.grammar.mistakes.sentences.reading import ReadAgain, is_mended
from tltlc.grammar.mistakes.unknown_signs import unknown_sign
from tltlc.grammar.mistakes.unknown_words import with_unknown_word
from tltlc.grammar.tables import load
from tltlc.grammar.whole_clauses import showing_clause

_NEXTS: Final = {"NEXT", "WEAK_NEXT"}
_BOUNDED: Final = BEFORE_ONE - {"NOT"}
_BOUNDED_UNTILS: Final = {
    "UNTIL": "(a U b) & F[0,20] b",
    "WEAK_UNTIL": "G[0,20] a | (a U b) & F[0,20] b",
    "RELEASE": "G[0,20] b | (b U (a & b)) & F[0,20] (a & b)",
    "STRONG_RELEASE": "(b U (a & b)) & F[0,20] (a & b)",
}
"""Maps the terminal of an operator such as `U`, which takes no bound, to a formula for ``a U[0,20] b``."""


def unexpected_token(
    source: SourceFile,
    tokens: Sequence[Token],
    error: lalr.UnexpectedTokenError,
    start: str,
    *,
    reads_sentences: bool = True,
) -> Diagnostic:
    """Return the diagnostic for a syntax error.

    ``tokens`` are one declaration, clause, line of a test or formula. The parser read them as the
    nonterminal ``start`` and raised ``error``. With ``reads_sentences``, a clause is also read as a
    sentence of English, which takes about 0.1 s.
    """
    return _at_fix(_diagnostic(source, tokens, error, start, _diagnostic, reads_sentences=reads_sentences))


def _diagnostic(
    source: SourceFile,
    tokens: Sequence[Token],
    error: lalr.UnexpectedTokenError,
    start: str,
    read_again: ReadAgain | None = None,
    *,
    reads_sentences: bool = True,
) -> Diagnostic:
    at = misread_index(source, tokens, error.index, start)
    failure = ParseFailure(source, tokens, error if at == error.index else stop_at(tokens, at, start), start)
    if failure.allowed_terminals == {"OF"}:
        # Only `within 5 s of a, b` begins with a time. Explain anything else as a time without an operator.
        failure = ParseFailure(source, tokens, stop_at(tokens, failure.stop.index - 2, start), start)
    diagnostic, rule = next(
        ((found, rule) for rule in _RULES if (found := rule(failure))),
        (failure.error("TLT0101", failure.expectation(), failure.form()), None),
    )
    is_explained = rule is not None and rule not in _OPEN_RULES
    helped = sentence_help(
        failure, diagnostic, is_explained=is_explained, read_again=read_again, reads_sentences=reads_sentences
    )
    known = with_unknown_word(failure, diagnostic, helped, rule)
    is_last = start == "clause" and read_again is not None and len(tokens) > 1
    if is_last and known.fixes and is_mended(failure, known.fixes[0]):
        return showing_clause(known, source, span_of(tokens[:-1]))
    return known


def _at_fix(diagnostic: Diagnostic) -> Diagnostic:
    """Return an error whose main label covers all that its first fix replaces, if they lie on one line.

    People write what a help says in place of what is underlined.
    """
    if not diagnostic.fixes:
        return diagnostic
    label, *others = diagnostic.labels
    replaced = [edit.span for edit in diagnostic.fixes[0].edits if edit.span.start < edit.span.end]
    span = Span(
        min([label.span.start, *(span.start for span in replaced)]),
        max([label.span.end, *(span.end for span in replaced)]),
    )
    if span == label.span or "\n" in label.source.slice(span):
        return diagnostic
    return replace(diagnostic, labels=(replace(label, span=span), *others))


def unclosed_bracket(source: SourceFile, opening: Token) -> Diagnostic:
    """Return the error for the bracket ``opening``, which is never closed."""
    closing = {"(": ")", "[": "]", "{": "}"}[opening.text]
    title = f"this `{opening.text}` is never closed"
    return Diagnostic("TLT0105", title, (Label(source, opening.span),), f"write the missing `{closing}`")


def _unmatched_bracket(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a bracket has no partner, else None."""
    token = failure.token
    if token.type in OPENING.values():
        opening = failure.open_brackets[-1] if failure.open_brackets else None
        if opening is None:
            partner = {")": "(", "]": "[", "}": "{"}[token.text]
            return failure.error("TLT0105", f"this `{token.text}` has no matching `{partner}`", "leave it out")
        if OPENING[opening.type] != token.type and OPENING[opening.type] in failure.allowed_terminals:
            return unclosed_bracket(failure.source, opening)
        return None
    if (
        failure.is_at_end
        and failure.open_brackets
        and OPENING[failure.open_brackets[-1].type] in failure.allowed_terminals
    ):
        return unclosed_bracket(failure.source, failure.open_brackets[-1])
    return None


def _declaration_in_block(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a declaration stands in the braces of a spec or of a test, else None."""
    token, block = failure.token, {"clause": "spec", "test_item": "test"}.get(failure.start)
    if block is None or failure.stop.index or token.text not in DECLARATIONS or token.type == "NAME":
        return None
    help_ = f"put it outside the braces, at the top of the file: {DECLARATIONS[token.text]}"
    return failure.error("TLT0107", f"`{token.text}` cannot be used inside a {block}", help_)


def _wrong_bound(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if the bound of a temporal operator is wrong, else None.

    The bound may lack a unit, have a name in place of a number, or follow an operator that takes no
    bound.
    """
    before = failure.previous_token
    if failure.token.type == "NAME" and before and _is_bound(failure):
        example = "F[0, 20]" if before.text in ("[", ",") else f"{before.text} 20 steps"
        if failure.clock_varies:
            example = "eventually within 2 s p"
        title = f"a bound must be a number, but {quote_token(failure.token)} is a name"
        return failure.error("TLT0111", title, f"write the number, e.g. `{example}`")
    if before and before.text in ("[", ",") and "NUMBER" in failure.allowed_terminals and _is_bound(failure):
        return _bound_without_number(failure)
    if failure.allowed_terminals == {"UNIT"} and before:
        help_ = f"write `{before.text} steps` or, with a clock, `{before.text} s`"
        if failure.clock_varies:
            help_ = f"with `clock varies`, write a time: `{before.text} s`, `{before.text} ms`"
        title = f"expected a unit after {quote_token(before)}"
        write = None if declared_names(failure.source).has_clock else f"{before.text} steps"
        return failure.error("TLT0111", title, help_, span=before.span, write=write)
    if failure.token.type == "RSQB" and before and "COMMA" in failure.allowed_terminals and _is_bound(failure):
        return _bound_with_one_end(failure)
    if failure.token.type == "LSQB" and before and before.type in UNTILS:
        return failure.error(
            "TLT0111",
            f"`{before.text}` takes no bound",
            f"use `F` or `G` with a bound: `{_BOUNDED_UNTILS[before.type]}`",
        )
    return None


def _bound_without_number(failure: ParseFailure) -> Diagnostic:
    """Return the error for a bound in brackets without a number: ``F[-1,2] p``, ``X[!] p``."""
    operator = failure.tokens[_opening_index(failure) - 1]
    if operator.type in _NEXTS:
        return failure.error(
            "TLT0111",
            f"`{operator.text}` takes no bound in brackets",
            "leave out the brackets; at the last step, `X` is false and `N` is true",
        )
    return failure.error(
        "TLT0111", failure.expectation(), f"count the steps from now on, e.g. `{operator.text}[0,20] p`"
    )


def _bound_with_one_end(failure: ParseFailure) -> Diagnostic:
    """Return the error for a bound in brackets with one number: ``F[20] p``, ``next[20] p``."""
    opening = _opening_index(failure)
    operator, number = failure.tokens[opening - 1], text_of(failure, opening + 1, failure.stop.index)
    if failure.clock_varies:
        return failure.error("TLT0111", "a bound in brackets needs two ends", FIXED_CLOCK)
    if operator.type in _NEXTS:
        word = "next" if operator.type == "NEXT" else "weak_next"
        time = f"{number} steps" if number.isdecimal() else number
        return failure.error(
            "TLT0111", f"`{operator.text}` takes no bound in brackets", f"write `{word} after {time} p`"
        )
    return failure.error(
        "TLT0111",
        "a bound in brackets needs two ends",
        f"write `{operator.text}[0,{number}] p` for the time from now on",
    )


def _opening_index(failure: ParseFailure) -> int:
    """Return the index of the innermost bracket that is open where parsing failed."""
    opening = failure.open_brackets[-1]
    return next(index for index, token in enumerate(failure.tokens) if token is opening)


def _is_bound(failure: ParseFailure) -> bool:
    """Whether parsing failed in the bound of an operator, as after ``F[0,`` and ``F within``."""
    index = failure.stop.index - 1
    if failure.open_brackets and failure.open_brackets[-1].text == "[":
        index = _opening_index(failure)
    elif failure.tokens[index].text not in ("within", "for", "after"):
        return False
    return index > 0 and failure.tokens[index - 1].type in _BOUNDED


def _reserved_word(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a reserved word stands where a name is expected, else None."""
    token = failure.token
    if "NAME" not in failure.allowed_terminals or token.text not in load().words:
        return None
    is_keyword = token.text in DECLARATIONS or token.text in CLAUSES
    if (failure.wants_operand and not is_keyword) or (
        failure.previous_token and failure.previous_token.text == "expect"
    ):
        return None
    help_ = f"choose another name, for example `{token.text.lower()}_`"
    if failure.previous_token and failure.previous_token.type == "IMPORT":
        help_ = f'name the file: `import "{token.text}.tltl"`'
    elif token.text in past_words.OPERATORS:
        return word_of_the_past(failure)
    return failure.error("TLT0106", f"`{token.text}` is a reserved word, not a name", help_)


def _missing_type(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for ``signal a: in [0, 1]``, where `in` was read as the type, else None."""
    before = failure.previous_token
    if failure.token.type != "LSQB" or before is None or before.text != "in" or "LSQB" in failure.allowed_terminals:
        return None
    return failure.error("TLT0101", "expected a type after `:`", failure.form(), span=before.span)


def _quantifier_head(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a quantifier is wrong before its colon, else None.

    Examples are ``all x in a: p`` and ``all(p, q)``.
    """
    heads = [token for token in failure.tokens[: failure.stop.index] if token.type in ("ALL", "ANY", "COLON")]
    if not heads or heads[-1].type == "COLON":
        return None
    word, joined = heads[-1].text, "and" if heads[-1].type == "ALL" else "or"
    help_ = f"the form is `{word} x in (a, b): near(x)`; to join formulas, write `{joined}`"
    return failure.error("TLT0101", failure.expectation(), help_)


def _misspelt_operator(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a misspelt operator, as in ``a adn b``, ``alwyas a`` or ``FG a``, else None."""
    before, token = failure.previous_token, failure.token
    if before is None or not failure.wants_operator:
        return None
    if re.fullmatch("[FGXN]{2,}", before.text):
        letters = " ".join(before.text)
        title = f"`{before.text}` is read as one name"
        return failure.error("TLT0101", title, f"write `{letters}`", span=before.span, write=letters)
    if token.text.lower() == "else":
        help_ = f"write `a or b` to require at least one of the two; {CASES}"
        return failure.error("TLT0101", failure.misplaced(token), help_)
    words = tuple(word for word, terminal in load().words.items() if terminal in INFIX and len(word) > 1)
    suggestion = closest_word(token.text, words) if token.type == "NAME" else None
    if suggestion and is_before_operand(failure):
        return failure.error("TLT0101", failure.expectation(), None, f"did you mean `{suggestion}`?", write=suggestion)
    operator = before.text.lower()
    if operator not in load().words and operator != "no":
        prefixes = (word for word, terminal in load().words.items() if terminal in {*BEFORE_ONE, "WHEN"})
        known = tuple(word for word in prefixes if len(word) > 3) if token.type == "NAME" else ()
        operator = closest_word(before.text, known) or ""
        # `exit` resembles `next` as much as a typo of it does, but begins with another letter.
        operator = operator if before.text[:1].lower() == operator[:1] or before.text.lower() == operator[1:] else ""
    if not operator or before.type != "NAME":
        return None
    title = failure.misplaced(before)
    if operator == "no" and has_token(failure, failure.stop.index, formula_stop(failure), INFIX):
        return failure.error(
            "TLT0101", title, "write `(not a) or b` to negate `a` alone, `not (a or b)` to negate both"
        )
    if operator == "no" and failure.tokens[0].text == "reach" and failure.start == "clause":
        help_ = "write `not a` if it is about that step, a clause `avoid a` if it must never hold"
        return failure.error("TLT0101", title, help_, span=before.span)
    operator = "not" if operator == "no" else operator
    return failure.error("TLT0101", title, None, f"did you mean `{operator}`?", before.span, write=operator)


def _foreign_otherwise(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if `else` stands in place of `otherwise`, as in ``when a: 1 else: 0``, else None."""
    if failure.token.text not in ("else", "default") or "OTHERWISE" not in failure.allowed_terminals:
        return None
    return failure.error(
        "TLT0101", f"a case cannot begin with {quote_token(failure.token)}", "write `otherwise`", write="otherwise"
    )


def _case_form(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a case distinction is broken, else None.

    Examples are ``when a then 1``, and ``when a: 1`` without `otherwise`.
    """
    if not any(token.type == "WHEN" for token in failure.tokens[: failure.stop.index]):
        return None
    return failure.error("TLT0101", failure.expectation(), CASES)


def _operator_for_name(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if an operator stands where a formula is expected, as in ``keep next``, else None."""
    if not failure.wants_operand:
        return None
    for word, kinds, where in (
        (failure.token, INFIX, "between two formulas"),
        (failure.previous_token, BEFORE_ONE, "before a formula"),
    ):
        if word and word.type in kinds and word.text.isalpha():
            help_ = f"{quote_token(word)} is an operator and belongs {where}; it cannot be a name"
            return failure.error("TLT0101", failure.expectation(), help_)
    return None


_RULES: Final = (
    long_arrow,
    dash_comment,
    unknown_sign,
    membership,
    until_time,
    quantifier_in_words,
    colon_after_event,
    answer_in_rule,
    response_in_english,
    negated_answer_in_rule,
    duration_in_words,
    never_counted,
    never_for_time,
    never_states,
    past_in_english,
    rule_in_words,
    plain_english,
    comparison_in_words,
    filler_word,
    compared_test,
    _foreign_otherwise,
    *HABITS,
    *PUNCTUATION,
    _declaration_in_block,
    *CLAUSE_RULES,
    _unmatched_bracket,
    _wrong_bound,
    _reserved_word,
    _missing_type,
    _quantifier_head,
    verb_is,
    _misspelt_operator,
    missing_comma,
    names_side_by_side,
    _operator_for_name,
    _case_form,
)

_OPEN_RULES: Final = (
    past_in_english,
    names_side_by_side,
    _quantifier_head,
    _misspelt_operator,
    foreign_unit,
    prefix_between_formulas,
    synonym_inside_formula,
    missing_comma,
    verb_is,
)
"""Rules that say little about the meaning of a clause: reading it as a sentence may say more."""
