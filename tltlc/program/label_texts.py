"""Write the labels of states once if they differ only in numbers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import accumulate
from typing import Final

from tltlc.core.record import record

_NUMBER: Final = re.compile(r"(?<![0-9])(0|[1-9][0-9]{0,8})(?![0-9])")
"""A number that any language prints as it stands here."""


@record
class LabelTexts:
    """The labels of states: their texts, and the numbers in them.

    ``texts`` has each text as its pieces, between which numbers are missing. ``state_texts`` has, for
    each state, the index of its label's text. ``numbers`` has the missing numbers of all labels, one
    state after the other.
    """

    texts: tuple[tuple[str, ...], ...]
    state_texts: tuple[int, ...]
    numbers: tuple[int, ...]

    @property
    def first_numbers(self) -> tuple[int, ...]:
        """The index in ``numbers`` of the first missing number of each state's label."""
        counts = (len(self.texts[text]) - 1 for text in self.state_texts)
        return tuple(accumulate(counts, initial=0))[:-1]


def split_labels(labels: Sequence[str]) -> LabelTexts:
    """Return the texts of labels, without the numbers in which labels with otherwise equal texts differ."""
    # The pieces at odd indices are the numbers.
    split = [tuple(_NUMBER.split(label)) for label in labels]
    alike: dict[tuple[str, ...], list[tuple[str, ...]]] = {}
    for pieces in split:
        alike.setdefault(pieces[::2], []).append(pieces)
    differing = {words: _differing(group) for words, group in alike.items()}
    text_of = {words: number for number, words in enumerate(alike)}
    return LabelTexts(
        texts=tuple(_joined(group[0], differing[words]) for words, group in alike.items()),
        state_texts=tuple(text_of[pieces[::2]] for pieces in split),
        numbers=tuple(int(pieces[place]) for pieces in split for place in differing[pieces[::2]]),
    )


def _differing(group: Sequence[Sequence[str]]) -> list[int]:
    """Return the places at which not all of the labels have the same piece."""
    return [place for place, pieces in enumerate(zip(*group, strict=True)) if len(set(pieces)) > 1]


def _joined(pieces: Sequence[str], left_out: Sequence[int]) -> tuple[str, ...]:
    """Join the pieces between those at the places ``left_out``."""
    starts, ends = [0, *(place + 1 for place in left_out)], [*left_out, len(pieces)]
    return tuple("".join(pieces[start:end]) for start, end in zip(starts, ends, strict=True))
