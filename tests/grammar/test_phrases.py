"""The phrases that designers type compile to what is meant, or the first fix that is offered does."""

from __future__ import annotations

from collections import Counter

import pytest

from tests.grammar.phrases_as_typed import Outcome, Phrase, is_equivalent, outcome, phrases, sentence, spec_text

PHRASES = tuple(phrases())
SAYABLE = tuple(phrase for phrase in PHRASES if not phrase.unsayable)
TWO_WRITERS = ("achievement", "gherkin", "playtest", "quest", "speedrun")
"""The files of the first 300 phrases, and after `fresh_` those of their second writer."""
LEAST_RATE = 0.85
"""The least share of phrases that compile to what is meant, as they stand or after what the help names."""


def settings(clauses: str) -> str:
    """Return the clauses that set something, which no formula says."""
    return "\n".join(line for line in clauses.splitlines() if line.startswith("limit"))


@pytest.mark.parametrize("phrase", SAYABLE, ids=lambda phrase: f"{phrase.source}: {phrase.typed}")
def test_the_clauses_that_are_meant_are_the_formula(phrase: Phrase) -> None:
    formula = f"{settings(phrase.meant)}\nrequire {phrase.formula}"
    assert is_equivalent(spec_text(phrase, phrase.meant), spec_text(phrase, formula))


@pytest.mark.parametrize("phrase", SAYABLE, ids=lambda phrase: f"{phrase.source}: {phrase.typed}")
def test_explain_says_what_is_meant(phrase: Phrase) -> None:
    result = outcome(phrase)
    is_right = result.kind in ("right", "helped") and not phrase.in_words
    assert sentence(result.text if is_right else spec_text(phrase, phrase.meant)) == phrase.explain


@pytest.fixture(scope="module")
def outcomes() -> list[tuple[Phrase, Outcome]]:
    return [(phrase, outcome(phrase)) for phrase in PHRASES]


def test_no_phrase_is_wrong(outcomes: list[tuple[Phrase, Outcome]]) -> None:
    assert not [phrase for phrase, result in outcomes if result.kind == "wrong"], table(outcomes)


def test_most_phrases_are_right_or_the_first_fix_is(outcomes: list[tuple[Phrase, Outcome]]) -> None:
    written = [pair for pair in outcomes if pair[0].source.removeprefix("fresh_") in TWO_WRITERS]
    number = Counter(result.kind for _, result in written)
    assert len(written) == 300
    assert number["right"] + number["helped"] >= LEAST_RATE * len(written), table(written)


def test_most_phrases_are_right_or_rightly_helped(outcomes: list[tuple[Phrase, Outcome]]) -> None:
    number = Counter(result.kind for _, result in outcomes)
    assert number["right"] + number["helped"] + number["named"] >= LEAST_RATE * len(outcomes), table(outcomes)


def table(outcomes: list[tuple[Phrase, Outcome]]) -> str:
    """Return the phrases that are neither right nor helped, with what they end as, and the numbers of all outcomes."""
    rows = [
        f"{result.kind}: {phrase.typed!r}\n    meant: {phrase.meant!r}\n    {result.text.partition('spec s')[2]}"
        f"    {result.message}"
        for phrase, result in outcomes
        if result.kind not in ("right", "helped")
    ]
    return "\n".join((*rows, str(Counter(result.kind for _, result in outcomes))))
