"""The parser of sentences leaves out what a sentence cannot use, and finds the same parses."""

from __future__ import annotations

from typing import Any

import pytest

from tests.grammar.sentences import words_of_sentence
from tests.grammar.test_sentences_with_one_reading import ONE_READING
from tltlc.grammar.english.sentence_parser import SentenceParser
from tltlc.grammar.english.terminals import terms


class Whole(SentenceParser):
    """The parser with all predictions."""

    def _usable(self, kinds: frozenset[str]) -> dict[Any, list[Any]]:
        return dict(self._predictions)


@pytest.fixture(scope="module")
def parsers() -> tuple[SentenceParser, SentenceParser]:
    return SentenceParser(), Whole()


@pytest.mark.parametrize("typed", [*sorted(ONE_READING)[::6], "fire spray fire", "when"])
def test_a_sentence_has_the_same_parses(typed: str, parsers: tuple[SentenceParser, SentenceParser]) -> None:
    parser, whole = parsers
    terminals = terms(words_of_sentence(typed), parser.vocabulary)
    assert terminals
    assert parser.parse(terminals) == whole.parse(terminals)
