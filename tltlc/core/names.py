"""Names of signals and atoms: with arguments, such as ``near(s1)``, or of comparisons, such as ``fuel > 5``."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

_BASE: Final = re.compile(r"[^\W\d][\w.]*\(")
_CALL: Final = re.compile(r"(?<![\w.])[^\W\d][\w.]*\(")
_BRACKETS: Final = {"(": 1, ")": -1}
_SIGNS: Final = re.compile(" (<|>|==) ")
_CHOICE: Final = re.compile(r"([^\W\d][\w.]*(?:\([^()]*\))?) (is) ([^\W\d]\w*)")
_MIRRORED: Final = {"<": ">", ">": "<"}
_OPPOSITES: Final = {"<": ">=", ">": "<=", "==": "!=", "is": "is not"}


class ComparisonName(str):
    """The name of an atom that compares two values, such as ``fuel > 5``: a text that knows its parts.

    ``left`` and ``right`` are the two sides as they are written. ``operator`` is ``<`` or ``>``, ``==``
    for integers, or ``is`` for an enum and the name of one of its values.
    """

    __slots__ = ("left", "operator", "right")
    left: str
    operator: str
    right: str

    def __new__(cls, left: str, operator: str, right: str) -> ComparisonName:
        """Make the name from its three parts."""
        name = super().__new__(cls, f"{left} {operator} {right}")
        name.left, name.operator, name.right = left, operator, right
        return name

    @property
    def opposite(self) -> str:
        """The comparison that holds exactly where this one does not: ``fuel <= 5`` for ``fuel > 5``."""
        return f"{self.left} {self.opposite_operator} {self.right}"

    @property
    def opposite_operator(self) -> str:
        """The operator of :attr:`opposite`."""
        return _OPPOSITES[self.operator]

    @property
    def signal_first(self) -> ComparisonName:
        """The same comparison, with the signal first that is compared with a value of its own.

        ``coins < previous(coins)`` for ``previous(coins) > coins``. Other comparisons stay as they are.
        """
        signal = self.right
        is_name = signal.endswith(")") or signal.isidentifier()
        is_own = is_name and re.search(rf"(?<![\w.]){re.escape(signal)}(?![\w.(])", self.left) is not None
        if self.operator not in _MIRRORED or not is_own:
            return self
        return ComparisonName(self.right, _MIRRORED[self.operator], self.left)

    def __getnewargs__(self) -> tuple[str, str, str]:  # type: ignore[override]
        return self.left, self.operator, self.right


class SpokenName(str):
    """The name of an atom for people, such as "hidden within 5 s": a phrase that says when it is about.

    ``verb`` asks for it: "reach hidden within 5 s", "keep hidden for 5 s". It is empty where any verb fits.
    ``is_past`` says that the phrase is about the steps up to this one, such as "hidden for at least 5 s".
    """

    __slots__ = ("is_past", "verb")
    verb: str
    is_past: bool

    def __new__(cls, text: str, verb: str = "", *, is_past: bool = False) -> SpokenName:
        """Make the name from its text and its verb."""
        name = super().__new__(cls, text)
        name.verb, name.is_past = verb, is_past
        return name

    def __getnewargs_ex__(self) -> tuple[tuple[str, str], dict[str, bool]]:
        return (str(self), self.verb), {"is_past": self.is_past}


def full_name(base: str, arguments: tuple[str, ...]) -> str:
    """Join a base and its arguments to a name: ``near(s1, s2)``, or ``alive`` without arguments."""
    return f"{base}({', '.join(arguments)})" if arguments else base


def split_name(name: str) -> tuple[str, tuple[str, ...]]:
    """Split a full name into its base and its arguments: ``near(s1)`` into ``("near", ("s1",))``.

    A name that is not a call, such as ``distance(s1) > 3``, is returned whole, with no arguments;
    that of a comparison is a :class:`ComparisonName`.
    """
    head = _BASE.match(name)
    if head is None:
        return _whole(name), ()
    arguments: list[str] = []
    depth, start = 1, head.end()
    for index in range(start, len(name)):
        depth += {"(": 1, ")": -1}.get(name[index], 0)
        if depth == 0 and index < len(name) - 1:
            return _whole(name), ()
        if depth == 0 or (depth == 1 and name.startswith(", ", index)):
            arguments.append(name[start:index])
            start = index + 2
    return (name[: head.end() - 1], tuple(arguments)) if depth == 0 and all(arguments) else (_whole(name), ())


def with_calls(name: str, call_text: Callable[[str], str | None]) -> str:
    """Return a name with other texts for the calls in it: ``2 * times(not a)`` for ``2 * times(!a)``.

    ``call_text`` gets each call, such as ``times(!a)``, and returns its text; for None, the calls in its
    arguments get theirs.
    """
    parts: list[str] = []
    place = 0
    while (head := _CALL.search(name, place)) is not None:
        depth, end = 1, head.end()
        while depth and end < len(name):
            depth += _BRACKETS.get(name[end], 0)
            end += 1
        text = call_text(name[head.start() : end]) if not depth else None
        parts += [name[place : head.end()]] if text is None else [name[place : head.start()], text]
        place = head.end() if text is None else end
    return "".join([*parts, name[place:]])


def _whole(name: str) -> str:
    """Return a name, as a :class:`ComparisonName` if it has one comparison outside all brackets."""
    if choice := _CHOICE.fullmatch(name):
        return ComparisonName(*choice.groups())
    places = [sign for sign in _SIGNS.finditer(name) if _depth(name, sign.start()) == 0]
    if len(places) != 1:
        return name
    left, operator, right = name[: places[0].start()], places[0][1], name[places[0].end() :]
    return ComparisonName(left, operator, right) if left.strip() and right.strip() else name


def _depth(name: str, index: int) -> int:
    """Return how many brackets are open at a place of a name."""
    return sum(_BRACKETS.get(character, 0) for character in name[:index])
