"""Read a sentence in which some words name a condition that the file does not declare: `gates up within 4 s`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.english.readings import Sentence, sentence_of
from tltlc.grammar.english.sentence_parser import sentence_parser
from tltlc.grammar.english.terminals import UNKNOWN, Term, known_terms
from tltlc.grammar.mistakes.sentences.words import Words

_LONGEST: Final = 4
"""The most words that may stand for one condition."""
_BESIDES: Final = ((0, 0), (0, 1), (1, 0), (0, 2), (1, 1))
"""How many known words before and after the unknown ones may belong to the condition, as in `gates up`."""
_LETTERS: Final = ("p", "q", "r", "u", "v")
_MOST_GAPS: Final = 2
_JOINING: Final = frozenset(
    "and or not no never unless except besides otherwise else if when whenever while until before after within for "
    "then since only always at least most more less than between again once twice thrice times time first second "
    "third last next previous each every any all both either neither keep reach avoid require implies "
    "during without upon per cannot can't nothing nobody none nowhere forbidden disabled impossible allowed fail fails "
    "failed stop stops stopped prevented blocked missing absent anymore".split()
)
"""Words that say how conditions go together, and so belong to none."""

_Place = tuple[int, int]


@record
class Gap:
    """Words that no name of the file has, and the letter that stands for them in clauses."""

    text: str
    letter: str


@record
class SentenceWithGaps:
    """What a sentence may mean, with letters for the conditions that the file does not declare."""

    gaps: tuple[Gap, ...]
    sentence: Sentence


def sentence_with_gaps(words: Words) -> SentenceWithGaps | None:
    """Return the readings of a sentence with letters for its unknown words; None if it has no reading then, either."""
    parser = sentence_parser()
    terminals = known_terms(words, parser.vocabulary) if parser else []
    letters = [letter for letter in _LETTERS if letter not in words.names.names]
    if parser is None or len(letters) < _MOST_GAPS:
        return None
    for places in product(*(tuple(_places(terminals, run)) for run in _runs(terminals))):
        gaps = [
            Gap(" ".join(term.text for term in terminals[start:stop]), letter)
            for (start, stop), letter in zip(places, letters, strict=False)
        ]
        filled: list[Term] = []
        end = 0
        for (start, stop), gap in zip(places, gaps, strict=True):
            filled += [*terminals[end:start], Term("BOOL", gap.letter)]
            end = stop
        filled_sentence = sentence_of(parser, [*filled, *terminals[end:]], words)
        if gaps and filled_sentence.readings:
            return SentenceWithGaps(tuple(gaps), filled_sentence)
    return None


def _runs(terminals: Sequence[Term]) -> list[_Place]:
    """Return where unknown words stand, with the known words between them; [] if they are too many conditions."""
    runs: list[_Place] = []
    for at, term in enumerate(terminals):
        if term.kind != UNKNOWN:
            continue
        if term.text in _JOINING:
            return []
        is_near = bool(runs) and at < runs[-1][0] + _LONGEST and all(map(_is_word, terminals[runs[-1][1] : at]))
        if is_near:
            runs[-1] = (runs[-1][0], at + 1)
        else:
            runs.append((at, at + 1))
    return runs if len(runs) <= _MOST_GAPS else []


def _places(terminals: Sequence[Term], run: _Place) -> Iterator[_Place]:
    """Yield where the words for a condition may begin and end, from the shortest on."""
    for before, after in _BESIDES:
        start, stop = run[0] - before, run[1] + after
        is_short = start >= 0 and stop <= len(terminals) and stop - start <= _LONGEST
        if is_short and all(map(_is_word, (*terminals[start : run[0]], *terminals[run[1] : stop]))):
            yield start, stop


def _is_word(term: Term) -> bool:
    """Whether a terminal is a word of English that may be a part of the name of a condition."""
    is_name = term.declared is not None or term.kind in ("BOOL", "NUMBER", "TIME_UNIT")
    return not is_name and term.text.isalpha() and term.text not in _JOINING
