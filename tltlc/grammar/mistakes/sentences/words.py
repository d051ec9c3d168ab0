"""The words of a sentence, with the names that the file declares told apart from English words."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from itertools import pairwise
from typing import Final, Union, overload

from tltlc.core.record import record
from tltlc.core.source import SourceFile
from tltlc.grammar.keywords import UNITS_ELSEWHERE
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.declared_names import DeclaredName, DeclaredNames
from tltlc.grammar.mistakes.english_rewrite import REAL_TIME, Time

_OPERATORS: Final = {
    "AND": "and",
    "OR": "or",
    "NOT": "not",
    "IMPLIES": "implies",
    "IFF": "iff",
    "THEN": "then",
    "ALWAYS": "always",
    "EVENTUALLY": "eventually",
    "NEXT": "next",
    "UNTIL": "until",
}
"""Maps the terminals of operators to the words for them."""
NUMBER_WORDS: Final = {
    word: str(number)
    for number, word in enumerate("zero one two three four five six seven eight nine ten eleven twelve".split())
}
"""Maps the words for numbers up to twelve to their digits."""
_APOSTROPHES: Final = ("'", "’")

Phrase = tuple[str, ...]


@record
class Word:
    """A word, name, number or sign. English words are in lower case; ``type`` is the terminal of the first token.

    ``start`` and ``end`` are a range of characters of the text. A word that ``is_renamed`` is spelt otherwise there.
    """

    text: str
    type: str
    is_name: bool
    start: int
    end: int
    is_renamed: bool = False


class Words(Sequence[Word]):
    """A range of the words of a sentence, and the names that its file declares."""

    def __init__(self, source: SourceFile, names: DeclaredNames, words: tuple[Word, ...]) -> None:
        self._source = source
        self.names = names
        self._words = words

    @overload
    def __getitem__(self, index: int) -> Word: ...

    @overload
    def __getitem__(self, index: slice) -> Words: ...

    def __getitem__(self, index: Union[int, slice]) -> Union[Word, Words]:
        if isinstance(index, slice):
            return Words(self._source, self.names, self._words[index])
        return self._words[index]

    def __len__(self) -> int:
        return len(self._words)

    @property
    def text(self) -> str:
        """The text of the words on one line, as it stands in the source."""
        if not self._words:
            return ""
        pieces = [self._spelling(self._words[0])]
        for word, following in pairwise(self._words):
            is_renamed = word.is_renamed or following.is_renamed
            is_close = word.end == following.start and (
                not is_renamed or word.text == "(" or following.text in (")", ",")
            )
            pieces.append("" if is_close else " ")
            pieces.append(self._spelling(following))
        return " ".join("".join(pieces).split())

    def of(self, words: Sequence[Word]) -> Words:
        """Return other words of the same text."""
        return Words(self._source, self.names, tuple(words))

    def lines(self) -> list[Words]:
        """Return the words of each line of the text."""
        starts = [
            at for at, word in enumerate(self) if at == 0 or "\n" in self._source.text[self[at - 1].end : word.start]
        ]
        return [self[start:stop] for start, stop in pairwise([*starts, len(self)])]

    def _spelling(self, word: Word) -> str:
        return word.text if word.is_renamed else self._source.text[word.start : word.end]

    @property
    def has_signs(self) -> bool:
        """Whether `and` and `or` are written as signs, as in `a && b`."""
        return any(word.type in ("AND", "OR") and not self._spelling(word)[0].isalpha() for word in self._words)

    def word(self, at: int) -> str:
        """Return the English word at an index; "" for a name, and outside the sentence."""
        return "" if not 0 <= at < len(self) or self[at].is_name else self[at].text

    def declared(self, at: int) -> DeclaredName | None:
        """Return the declaration of the name at an index, else None."""
        return self.names.names.get(self[at].text) if 0 <= at < len(self) and self[at].is_name else None

    def phrase(self, at: int, phrases: Iterable[Phrase]) -> Phrase:
        """Return the longest of some phrases whose words stand at an index; () if none does."""
        first = self.word(at)
        if not first:
            return ()
        begun = [phrase for phrase in phrases if phrase[0] == first]
        found = (phrase for phrase in begun if all(self.word(at + i) == word for i, word in enumerate(phrase)))
        return max(found, key=len, default=())

    def without(self, words: Iterable[Phrase]) -> Words:
        """Return the rest after all phrases of these that stand at the beginning."""
        rest, known = self, tuple(words)
        while phrase := rest.phrase(0, known):
            rest = rest[len(phrase) :]
        return rest

    def followed_by(self, other: Words) -> Words:
        """Return the words, and then those of another range."""
        return Words(self._source, self.names, (*self._words, *other._words))

    def outer(self) -> Iterable[int]:
        """Yield the indices of the words that no bracket encloses, and of the outermost brackets."""
        depth = 0
        for index, word in enumerate(self._words):
            depth -= word.text in (")", "]", "}")
            if depth <= 0:
                yield index
            depth += word.text in ("(", "[", "{")

    def find(self, phrases: Iterable[Phrase], start: int = 0) -> tuple[int, Phrase] | None:
        """Return where the first of some phrases stands outside brackets, and the phrase; None if none does."""
        known = tuple(phrases)
        return next(((at, found) for at in self.outer() if at >= start and (found := self.phrase(at, known))), None)

    def find_last(self, phrases: Iterable[Phrase]) -> tuple[int, Phrase] | None:
        """Return where the last of some phrases stands outside brackets, and the phrase; None if none does."""
        known, last, at = tuple(phrases), None, 0
        while found := self.find(known, at):
            last, at = found, found[0] + len(found[1])
        return last

    def split(self, phrases: Iterable[Phrase]) -> list[Words]:
        """Return the parts between some phrases outside brackets; one part if there are none."""
        known, parts, start = tuple(phrases), [], 0
        while found := self.find(known, start):
            parts.append(self[start : found[0]])
            start = found[0] + len(found[1])
        return [*parts, self[start:]]

    def number(self, at: int) -> str:
        """Return the digits of the number at an index, as `3` for `three`; "" if there is none."""
        if 0 <= at < len(self) and self[at].type == "NUMBER":
            return self[at].text
        return NUMBER_WORDS.get(self.word(at), "")

    def time(self, at: int) -> tuple[Time, int] | None:
        """Return the time at an index, as `5 s` for `5 seconds`, and the index after it, else None."""
        number, unit = self.number(at), self[at + 1].text if at + 1 < len(self) else ""
        unit = UNITS_ELSEWHERE.get(unit.lower(), unit)
        return (Time(number, unit), at + 2) if number and unit in (*REAL_TIME, "step", "steps") else None


def words_of(source: SourceFile, names: DeclaredNames, tokens: Sequence[Token], english: Collection[str]) -> Words:
    """Return the words of tokens; `don't` is one word, and what is declared or called is a name.

    In a file with imports, all words that are not ``english`` are names, because a library may declare them.
    """
    words: list[Word] = []
    index = 0
    while index < len(tokens):
        token, stop = tokens[index], index + 1
        following = tokens[stop : stop + 2]
        is_short = len(following) == 2 and following[0].text in _APOSTROPHES and following[1].text in ("t", "s", "re")
        if is_short and token.end == following[0].start:
            text, stop = f"{token.text.lower()}'{following[1].text}", index + 3
            words.append(Word(text, token.type, False, token.start, following[1].end))
        else:
            is_call = bool(following) and following[0].text == "(" and following[0].start == token.end
            is_imported = names.has_imports and token.text.lower() not in english
            is_name = token.type == "NAME" and (token.text in names.names or is_imported or is_call)
            text = token.text if is_name else _OPERATORS.get(token.type, token.text.lower())
            words.append(Word(text, token.type, is_name, token.start, token.end))
        index = stop
    return Words(source, names, tuple(words))


def phrases(*texts: str) -> tuple[Phrase, ...]:
    """Return phrases as tuples of their words."""
    return tuple(tuple(text.split()) for text in texts)
