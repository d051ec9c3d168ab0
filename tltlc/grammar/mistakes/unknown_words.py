"""Say which word of a clause the language does not know, where nothing better is known of the clause."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CLAUSES, CONDITIONS, PHRASE_LIST, UNITS_ELSEWHERE
from tltlc.grammar.lexer import Token, tokenize
from tltlc.grammar.mistakes.clauses import unknown_keyword
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english import plain_english
from tltlc.grammar.mistakes.english_forms import FORMS, TIMES
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK
from tltlc.grammar.mistakes.equalities import verb_is
from tltlc.grammar.mistakes.habits import NO_UNITS
from tltlc.grammar.mistakes.names_side_by_side import names_side_by_side
from tltlc.grammar.mistakes.parse_failure import ParseFailure
from tltlc.grammar.mistakes.punctuation import comma
from tltlc.grammar.mistakes.sentences.vocabulary import ENGLISH
from tltlc.grammar.past_words import FUNCTIONS
from tltlc.grammar.tables import load

Rule = Callable[[ParseFailure], Diagnostic | None]
"""Recognises one mistake."""
_GENERAL: Final[tuple[Rule, ...]] = (plain_english, comma, names_side_by_side, verb_is)
"""Rules whose helps have letters in place of the words of the clause, where the rules do not understand them."""
_EXPLAINED: Final = frozenset((*FORMS, *TIMES, *CONDITIONS, "a", "an", "the"))
"""The words of English of which an error says how to write them, and those that mean nothing."""


def with_unknown_word(failure: ParseFailure, error: Diagnostic, helped: Diagnostic, rule: Rule | None) -> Diagnostic:
    """Return the error for a clause, with a help that names a word which the language does not know.

    ``error`` is the error of ``rule``, or the error for mistakes that no rule knows. ``helped`` is the same error
    after the sentence has been read. It stays as it is if it has a fix, if its help says more than that of such a rule,
    if it has a name of the file, or if there is no such word.
    """
    is_general = rule is None or rule in _GENERAL or (rule is unknown_keyword and failure.tokens[0].text in CONDITIONS)
    names = declared_names(failure.source).names
    if failure.tokens[0].type in ("LIMIT", "JUDGE") or FIXED_CLOCK in (helped.help or ""):
        return helped
    if failure.start != "clause" or not is_general or helped.fixes or helped.help != error.help or not names:
        return helped
    quoted = [token.text for text in (helped.help or "").split("`")[1::2] for token in tokenize(text).tokens]
    if not names.keys().isdisjoint(quoted):
        return helped
    word, token = _unknown_word(failure), failure.token
    if word is not None:
        return replace(helped, help=_with_list(failure.misplaced(word), helped))
    if rule is None and token.type == "NAME" and token.text in load().soft and failure.wants_operator:
        return replace(helped, help=_with_list(failure.misplaced(token), helped))
    return helped


def _with_list(reason: str, error: Diagnostic) -> str:
    """Return a help that gives a reason, unless the title does so, and says where the list of phrases is."""
    return PHRASE_LIST if reason == error.title else f"{reason}; {PHRASE_LIST}"


def _unknown_word(failure: ParseFailure) -> Token | None:
    """Return the first word from where parsing failed on that the language does not know, else the last before it."""
    at = failure.stop.index
    indices = (*range(at, len(failure.tokens) - 1), *range(at - 1, -1, -1))
    at = next((index for index in indices if _is_unknown(failure, index)), -1)
    return None if at < 0 else failure.tokens[at]


def _is_unknown(failure: ParseFailure, index: int) -> bool:
    """Whether the token at an index is a word that neither the language nor the file knows.

    In a file with imports, other words than those of English may be names.
    """
    token, declared = failure.tokens[index], declared_names(failure.source)
    word, names = token.text, declared.names
    if token.type != "NAME" or word in names or word in load().soft or word in FUNCTIONS or word in CLAUSES:
        return False
    if any(word in (*name.values, *name.members, *name.parameters) for name in names.values()):
        return False
    if (
        word.lower() in _EXPLAINED
        or word.lower() in UNITS_ELSEWHERE
        or word in load().units
        or failure.tokens[index + 1].type == "LPAR"
    ):
        return False
    return not declared.has_imports or word.lower() in ENGLISH | NO_UNITS
