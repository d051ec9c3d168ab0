"""Parse the text of a HOA file into its syntax tree."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

from lark import Lark, Token, UnexpectedInput, UnexpectedToken, v_args
from lark.exceptions import VisitError
from lark.visitors import Transformer_NonRecursive

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.tools.hoa.problems import format_error, unsupported_error
from tltlc.tools.hoa.tree import Alias, Header, Hoa, HoaEdge, HoaExpression, HoaState, HoaString, Sets, Targets

_STRING_OR_COMMENT: Final = re.compile(r'"(?:\\.|[^\\"])*(?:"|\\?\Z)|/\*', re.DOTALL)
"""Matches a string in quotes, whose end may be missing, or the beginning of a comment."""
_IN_A_COMMENT: Final = re.compile(r"/\*|\*/")
_ESCAPE: Final = re.compile(r"\\(?:u([0-9a-fA-F]{4})|U(000[0-9a-fA-F]{5}|0010[0-9a-fA-F]{4})|(.))", re.DOTALL)
_LARGEST: Final = 2**31 - 1

_NAMES: Final = {
    "ALIAS": "an alias like `@name`",
    "HEADER": "a header like `name:`",
    "IDENTIFIER": "a word",
    "INT": "a number",
    "LABEL": "a label like `[0 & !1]`",
    "STRING": "a text in double quotes",
    "VERSION": "a version like `v1`",
}
"""What messages call each terminal of the grammar that matches a pattern."""
_MOST_EXPECTED: Final = 5
_LONGEST_SHOWN: Final = 40

_ONCE: Final = ("States:", "AP:", "Acceptance:", "name:")


def read_hoa(source: SourceFile) -> Hoa:
    """Return the syntax tree of a HOA file.

    Whether the numbers of states, sets and atoms exist is not checked yet.

    Raises:
        TltlError: TLT0651 if the text does not follow the format; TLT0652 if the file has several
            automata, or ends with ``--ABORT--``.
    """
    if source.text.lstrip().startswith("{"):
        title, help_ = (
            f"`{source.name}` is JSON, not an automaton in the Hanoi format",
            "an artefact needs no import",
        )
        raise TltlError([Diagnostic("TLT0651", title, help=help_)])
    text = _without_comments(source)
    try:
        hoa: Hoa = _Tree(source).transform(_parser().parse(text, start="automaton"))
    except UnexpectedInput as error:
        raise _syntax_error(source, error, Span(0, len(text.rstrip())), "the end of the file") from None
    except VisitError as error:
        raise _cause(error) from None
    return hoa


def _cause(error: VisitError) -> Exception:
    """Return the error that a method of :class:`_Tree` raised, which Lark has wrapped.

    The error is wrapped twice if it is about a label, because labels are parsed separately.
    """
    cause: Exception = error
    while isinstance(cause, VisitError):
        cause = cause.orig_exc
    return cause


@lru_cache(maxsize=1)
def _parser() -> Lark:
    grammar = Path(__file__).with_name("hoa.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", lexer="basic", start=["automaton", "label"], maybe_placeholders=True)


def _without_comments(source: SourceFile) -> str:
    """Return the text with spaces in place of comments, so that all offsets stay the same.

    Comments nest. Raises TltlError, TLT0651, if a comment does not end.
    """
    pieces: list[str] = []
    code_start = comment_start = depth = 0
    place = 0
    while match := (_IN_A_COMMENT if depth else _STRING_OR_COMMENT).search(source.text, place):
        place = match.end()
        if match.group() == "/*":
            if depth == 0:
                comment_start = match.start()
                pieces.append(source.text[code_start:comment_start])
            depth += 1
        elif match.group() == "*/":
            depth -= 1
            if depth == 0:
                code_start = place
                pieces.append(" " * (code_start - comment_start))
    if depth:
        title, help_ = "this comment does not end", "comments nest: each `/*` needs a `*/`"
        raise format_error(source, Span(comment_start, comment_start + 2), title, help_)
    return "".join([*pieces, source.text[code_start:]])


# --- syntax errors --------------------------------------------------------------------------------


def _syntax_error(source: SourceFile, error: UnexpectedInput, whole: Span, at_end: str) -> TltlError:
    """Return the error for a text that cannot be parsed: the whole file, or a label in it.

    ``whole`` is the span of this text in the file. ``at_end`` is what messages call its end, for
    example ``the end of the file``.
    """
    if not isinstance(error, UnexpectedToken):
        start = whole.start + (error.pos_in_stream or 0)
        if source.text.startswith("--ABORT--", start):
            title, help_ = (
                "the tool that wrote this automaton did not finish it",
                "let the tool write it again, to its end",
            )
            return unsupported_error(source, Span(start, start + len("--ABORT--")), title, help_)
        character = source.text[start]
        endless = {'"': "this text does not end", "[": "this label does not end"}
        return format_error(
            source, Span(start, start + 1), endless.get(character, f"`{character}` is not expected here")
        )
    token = error.token
    if token.type != "$END":
        span, title = _shift(_span(token), whole.start), f"`{_shorten(token)}` is not expected here"
    elif source.text[whole.end :].strip():
        span, title = Span(whole.end, whole.end + 1), f"{at_end} is not expected here"
    else:
        here = Span(whole.end, whole.end)
        return format_error(source, here, "the file ends too early", "it was cut off: an automaton ends with `--END--`")
    if error.accepts == {"$END"} and token == "HOA:":
        title, help_ = f"`{source.name}` contains several automata", "use a file with only one of them"
        return unsupported_error(source, span, title, help_, "another one")
    expected = sorted(at_end if name == "$END" else _terminal_name(name) for name in error.accepts)
    label_message = f"expected {_alternatives(expected)}" if 0 < len(expected) <= _MOST_EXPECTED else ""
    return format_error(source, span, title, label_message=label_message)


def _shift(span: Span, by: int) -> Span:
    return Span(span.start + by, span.end + by)


def _alternatives(names: list[str]) -> str:
    *head, last = names
    return f"{', '.join(head)} or {last}" if head else last


def _terminal_name(terminal: str) -> str:
    pattern = next((definition.pattern for definition in _parser().terminals if definition.name == terminal), None)
    if terminal in _NAMES or pattern is None:
        return _NAMES.get(terminal, terminal)
    return f"`{pattern.value}`"


def _shorten(token: str) -> str:
    return token if len(token) <= _LONGEST_SHOWN else f"{token[:_LONGEST_SHOWN]}…"


# --- the tree -------------------------------------------------------------------------------------


@v_args(inline=True)
class _Tree(Transformer_NonRecursive[Token, Hoa]):
    """Builds the records of :mod:`tltlc.tools.hoa.tree`, and checks the header.

    Lark calls each method for the grammar rule of the same name.
    """

    def __init__(self, source: SourceFile) -> None:
        super().__init__()
        self._source = source
        self._labels: dict[str, HoaExpression] = {}
        self._start = 0
        """The offset in the file at which the parsed text begins: 0, except while a label is parsed."""

    def automaton(self, version: Token, *items: Any) -> Hoa:
        """Build the whole :class:`Hoa`. Raises TltlError, TLT0651, if the header is wrong."""
        if version != "v1":
            help_ = "tltlc reads version 1 of the format, `HOA: v1`"
            raise format_error(
                self._source, self._span(version), f"the version `{_shorten(version)}` is not known", help_
            )
        states = tuple(item for item in items if isinstance(item, HoaState))
        header: dict[str, list[Any]] = {}
        for kind, value, span in (item for item in items if not isinstance(item, HoaState)):
            values = header.setdefault(kind, [])
            if values and kind in _ONCE:
                raise format_error(self._source, span, f"`{kind}` occurs here again", "keep one of the two")
            values.append(value)
        if "Acceptance:" not in header:
            title, help_ = "the header has no acceptance", "add a line like `Acceptance: 1 Inf(0)`"
            raise format_error(self._source, Span(0, 4), title, help_)
        ((sets, condition),) = header["Acceptance:"]
        return Hoa(
            source=self._source,
            count=next(iter(header.get("States:", ())), None),
            starts=tuple(header.get("Start:", ())),
            atoms=next(iter(header.get("AP:", ())), ()),
            aliases=tuple(header.get("Alias:", ())),
            sets=sets,
            condition=condition,
            name=next(iter(header.get("name:", ())), None),
            headers=tuple(header.get("", ())),
            states=states,
        )

    # The methods for items of the header return the name of the item, its value, and its span.

    def states(self, word: Token, count: Token) -> Any:
        """Read the header item ``States: 3``."""
        return "States:", self._number(count), self._span(word)

    def start(self, targets: Targets) -> Any:
        """Read the header item ``Start: 0``."""
        return "Start:", targets, targets.span

    def atoms(self, word: Token, count: Token, *names: HoaString) -> Any:
        """Read the header item ``AP: 2 "a" "b"``."""
        if self._number(count) != len(names):
            title = f"`AP:` says {count}, but {len(names)} {'name follows' if len(names) == 1 else 'names follow'}"
            raise format_error(self._source, self._span(word), title, "write the number of names")
        return "AP:", names, self._span(word)

    def alias(self, name: Token, term: HoaExpression) -> Any:
        """Read the header item ``Alias: @a 0 & !1``."""
        return "Alias:", Alias(str(name), term, self._span(name)), self._span(name)

    def acceptance(self, word: Token, sets: Token, condition: HoaExpression) -> Any:
        """Read the header item ``Acceptance: 2 Fin(0) & Inf(1)``."""
        return "Acceptance:", (self._number(sets), condition), self._span(word)

    def name(self, word: Token, text: HoaString) -> Any:
        """Read the header item ``name: "G F a"``."""
        return "name:", text, self._span(word)

    def header(self, name: Token, *values: Token) -> Any:
        """Read a header item that no other method reads, e.g. ``acc-name: Buchi``."""
        return "", Header(str(name), tuple(map(_as_text, values)), self._span(name)), self._span(name)

    # The methods for the body.

    def state(
        self, label: Token | None, number: Token, name: HoaString | None, sets: Sets, *edges: HoaEdge
    ) -> HoaState:
        """Build a state, e.g. ``State: 0 "F a" {0}``, with its edges."""
        text = None if name is None else name.text
        return HoaState(self._number(number), text, self._label(label), sets, edges, self._span(number))

    def edge(self, label: Token | None, targets: Targets, sets: Sets) -> HoaEdge:
        """Build an edge, e.g. ``[0 & !1] 3 {0}``."""
        return HoaEdge(self._label(label), targets, sets)

    def _label(self, label: Token | None) -> HoaExpression | None:
        """Parse a label in square brackets.

        Equal labels share one expression, with the spans of the first label.
        """
        if label is None:
            return None
        if label not in self._labels:
            span = self._span(label)
            inside = Span(span.start + 1, span.end - 1)
            try:
                tree = _parser().parse(label[1:-1], start="label")
            except UnexpectedInput as error:
                raise _syntax_error(self._source, error, inside, "`]`") from None
            self._start = inside.start
            term: Any = self.transform(tree)
            self._start = 0
            self._labels[str(label)] = term
        return self._labels[label]

    def sets(self, *numbers: Token | None) -> Sets:
        """Build the acceptance sets of a state or an edge, e.g. ``{0 1}``."""
        present = [number for number in numbers if number is not None]
        return Sets(tuple(map(self._number, present)), self._span(present[0], present[-1])) if present else Sets()

    def targets(self, *states: Token) -> Targets:
        """Build the targets of an edge, or initial states: ``3``, or ``3 & 4``."""
        return Targets(tuple(map(self._number, states)), self._span(states[0], states[-1]))

    def string(self, text: Token) -> HoaString:
        """Build a string from a text in double quotes."""
        whole = self._span(text)
        return HoaString(_ESCAPE.sub(_unescape, text[1:-1]), Span(whole.start + 1, whole.end - 1))

    # Boolean expressions.

    def any_of(self, *terms: HoaExpression) -> HoaExpression:
        """Build a disjunction, or return its only operand."""
        return terms[0] if len(terms) == 1 else HoaExpression("or", terms)

    def all_of(self, *terms: HoaExpression) -> HoaExpression:
        """Build a conjunction, or return its only operand."""
        return terms[0] if len(terms) == 1 else HoaExpression("and", terms)

    def negation(self, _: Token, term: HoaExpression) -> HoaExpression:
        """Build a negation, e.g. ``!0``."""
        return HoaExpression("not", (term,))

    def atom(self, index: Token) -> HoaExpression:
        """Build an atom from its index, e.g. ``0``."""
        return HoaExpression("atom", (), self._number(index), False, self._span(index))

    def aliased(self, name: Token) -> HoaExpression:
        """Build the use of an alias, e.g. ``@a``."""
        return HoaExpression("alias", (), str(name), False, self._span(name))

    def constant(self, word: Token) -> HoaExpression:
        """Build a constant, ``t`` (true) or ``f`` (false)."""
        return HoaExpression("true" if word.type == "TRUE" else "false")

    def set(self, kind: Token, outside: Token | None, number: Token) -> HoaExpression:
        """Build a term of an acceptance condition, e.g. ``Fin(0)`` or ``Inf(!0)``."""
        if kind not in ("Fin", "Inf"):
            title, help_ = f"`{kind}` is not an acceptance condition", "use `Fin` or `Inf` of a set"
            raise format_error(self._source, self._span(kind), title, help_)
        op: Any = kind.lower()
        return HoaExpression(op, (), self._number(number), outside is not None, self._span(number))

    # Tokens.

    def _number(self, digits: Token) -> int:
        # Check the length first: Python refuses to convert thousands of digits.
        if len(digits) > len(str(_LARGEST)) or int(digits) > _LARGEST:
            title, help_ = "this number is too large", f"the largest number in the format is {_LARGEST:,}"
            raise format_error(self._source, self._span(digits), title, help_)
        return int(digits)

    def _span(self, first: Token, last: Token | None = None) -> Span:
        return _shift(_span(first, last), self._start)


def _unescape(match: re.Match[str]) -> str:
    code, long_code, character = match.groups()
    return character or chr(int(code or long_code, 16))


def _as_text(value: Token) -> str:
    return _ESCAPE.sub(_unescape, value[1:-1]) if value.type == "STRING" else str(value)


def _span(first: Token, last: Token | None = None) -> Span:
    start, end = first.start_pos, (last or first).end_pos
    assert start is not None and end is not None
    return Span(start, end)
