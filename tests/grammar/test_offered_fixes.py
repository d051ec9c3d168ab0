"""Every fix that is offered for a phrase, or for a valid clause with a mistake, leads to a text that can be parsed.

Where a clause has several mistakes, the fixes of the others are applied, too.
"""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from tests.grammar.phrases_as_typed import (
    Phrase,
    automaton,
    errors,
    is_equivalent,
    phrases,
    spec_text,
)
from tests.grammar.phrases_as_typed import (
    fix as fix_all,
)
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Fix
from tltlc.grammar.parser import parse
from tltlc.tools.lint.scopes import apply_edits

PHRASES = tuple(phrases())
MUTATIONS = 2
"""How many mistakes are made in each clause."""


def syntax_errors(text: str) -> list[Diagnostic]:
    return [error for error in parse(SourceFile("a.tltl", text))[1] if error.severity == "error"]


def offered(text: str) -> Iterator[tuple[Diagnostic, Fix]]:
    for diagnostic in errors(SourceFile("a.tltl", text)):
        yield from ((diagnostic, fix) for fix in diagnostic.fixes)


def fixed(text: str, fix: Fix) -> str:
    return apply_edits(SourceFile("a.tltl", text), fix.edits).text


def mutations(clauses: str, seed: int) -> Iterator[str]:
    """Yield clauses with one mistake: a word left out, two words swapped, a letter left out or swapped."""
    random_ = random.Random(f"{clauses} {seed}")
    for _ in range(MUTATIONS):
        words = clauses.split(" ")
        at = random_.randrange(len(words))
        kind = random_.choice(("drop", "swap", "typo", "typo", "double"))
        if kind == "drop" and len(words) > 1:
            del words[at]
        elif kind == "swap" and at + 1 < len(words):
            words[at : at + 2] = words[at + 1], words[at]
        elif kind == "typo" and len(words[at]) > 3:
            letter = random_.randrange(len(words[at]) - 1)
            text = words[at]
            words[at] = text[:letter] + text[letter + 1] + text[letter] + text[letter + 2 :]
        else:
            words.insert(at, words[at])
        yield " ".join(words)


@pytest.mark.parametrize("phrase", PHRASES, ids=lambda phrase: f"{phrase.source}: {phrase.typed}")
def test_a_fix_of_a_phrase_leads_to_a_text_that_can_be_parsed(phrase: Phrase) -> None:
    text = spec_text(phrase, phrase.typed)
    for diagnostic, fix in offered(text):
        left = syntax_errors(fix_all(fixed(text, fix))[0])
        assert len(left) < len(syntax_errors(text)) or not left, (diagnostic.title, fix.title)


@pytest.mark.parametrize("phrase", PHRASES, ids=lambda phrase: f"{phrase.source}: {phrase.typed}")
def test_a_safe_fix_of_a_clause_with_a_mistake_keeps_its_meaning(phrase: Phrase) -> None:
    meant = spec_text(phrase, phrase.meant)
    for mutation in mutations(phrase.meant, 1):
        text = spec_text(phrase, mutation)
        before = syntax_errors(text)
        for diagnostic, fix in offered(text):
            after = fixed(text, fix)
            left = syntax_errors(fix_all(after)[0])
            most = len(before) + (diagnostic not in before)
            assert len(left) < max(1, most), (mutation, diagnostic.title, fix.title)
            is_whole = fix.applicability == "safe" and not errors(SourceFile("a.tltl", after))
            if is_whole and _is_resolved(text):
                assert is_equivalent(after, meant) or is_equivalent(after, text), (mutation, fix.title)


def _is_resolved(text: str) -> bool:
    """Whether a text compiles, so that it has a meaning that a safe fix must keep."""
    if errors(SourceFile("a.tltl", text)):
        return False
    automaton(text)
    return True
