"""The phrases that designers type compile to what is meant, or the first fix that is offered does."""

from __future__ import annotations

from collections import Counter

import pytest

from tests.grammar.phrases_as_typed import Phrase, is_equivalent, outcome, phrases, sentence, spec_text

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


@pytest.mark.parametrize("phrase", PHRASES, ids=lambda phrase: f"{phrase.source}: {phrase.typed}")
def test_a_phrase_has_its_outcome(phrase: Phrase) -> None:
    result = outcome(phrase)
    assert result.kind == phrase.outcome, result.message
    if not phrase.unsayable:
        is_right = result.kind in ("right", "helped") and not phrase.in_words
        assert sentence(result.text if is_right else spec_text(phrase, phrase.meant)) == phrase.explain


def test_no_phrase_is_wrong() -> None:
    assert not [phrase for phrase in PHRASES if phrase.outcome == "wrong"]


def test_most_phrases_are_right_or_the_first_fix_is() -> None:
    written = [phrase for phrase in PHRASES if phrase.source.removeprefix("fresh_") in TWO_WRITERS]
    number = Counter(phrase.outcome for phrase in written)
    assert len(written) == 300
    assert number["right"] + number["helped"] >= LEAST_RATE * len(written), number


def test_most_phrases_are_right_or_rightly_helped() -> None:
    number = Counter(phrase.outcome for phrase in PHRASES)
    assert number["right"] + number["helped"] + number["named"] >= LEAST_RATE * len(PHRASES), number
