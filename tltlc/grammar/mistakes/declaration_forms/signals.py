"""Read signals and entities in other forms: ``bool a``, ``signals a, b: bool``, ``signal lap: int 0..30``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.record import record, replace
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.declaration_forms.meant import (
    MISSING_ENDS,
    MISSING_RANGE,
    Cursor,
    MeantDeclaration,
    WholeText,
)
from tltlc.grammar.mistakes.declaration_forms.ranges import (
    UNIT_OF_TYPE,
    Range,
    read_bounds,
    read_range,
    read_unit_as_type,
    read_values,
    whole_values,
)
from tltlc.grammar.mistakes.declaration_forms.uses import used_as

TYPES: Final = {
    **dict.fromkeys(("bool", "boolean", "bit", "truth"), "bool"),
    **dict.fromkeys(("int", "integer", "uint", "int32", "i32", "long", "short", "byte"), "int"),
    **dict.fromkeys(("number", "float", "double", "real", "num", "numeric", "decimal", "float32", "f32"), "number"),
    **dict.fromkeys(("ratio", "percent", "percentage", "fraction"), "ratio"),
    **dict.fromkeys(("length", "distance"), "length"),
    **dict.fromkeys(("time", "duration"), "time"),
    **dict.fromkeys(("speed", "velocity"), "speed"),
    "angle": "angle",
}
"""Maps names of types, in this and in other languages, to the types of this language."""
TYPE_WORDS: Final = frozenset(TYPES)
ENUM_WORDS: Final = ("enum", "type")
"""Words that begin the declaration of an enum in other languages."""
_LEADING_TYPES: Final = ("bool", "boolean", "int", "integer", "float", "double", "number", "real", *ENUM_WORDS)
"""Types that begin a declaration in other languages, as in ``bool seen``."""
SIGNAL_WORDS: Final = frozenset(
    """
    signal signals var vars variable variables input inputs sensor sensors observation obs observable flag flags prop
    props proposition atom let val state state_var event events declare
    """.split()
)
ENTITY_WORDS: Final = frozenset("entities object objects actor actors".split())
_TRUTHS: Final = frozenset("flag flags prop props proposition atom event events".split())
"""Words for signals that are true or false."""
_NO_RANGE: Final = ("bool", "ratio")
_ASSUMED: Final = "1e6"
"""The end of a range with which a file is checked if the author wrote none; no help takes it for one of an int."""
_IS_TYPE: Final = (":", "=", "as", "is")


@record
class _Type:
    """What is declared of a signal: its type, its range and the values of an enum, each empty if none is written.

    ``enum`` is the name of the file's enum that has these values.
    """

    type: str = ""
    ends: tuple[str, ...] = ()
    values: tuple[str, ...] = ()
    enum: str = ""


def read_entities(tokens: Sequence[Token]) -> MeantDeclaration | None:
    """Return the entities that ``entities a, b`` or ``entity: a`` is meant to declare, or None."""
    cursor = Cursor(tokens)
    if not cursor.accept("entity", *ENTITY_WORDS):
        return None
    cursor.accept(":", "=")
    names = _names(cursor)
    cursor.accept(";")
    if not names or not cursor.is_done:
        return None
    line = f"entity {', '.join(names)}"
    return MeantDeclaration("entity", (line,), (line,))


def read_signals(tokens: Sequence[Token], text: WholeText) -> MeantDeclaration | None:
    """Return the signals that a piece is meant to declare, or None.

    ``text`` says how a signal without a type is used, and what enums there are.
    """
    cursor = Cursor(tokens)
    word = cursor.token.text.lower()
    is_named = not _is_name(cursor) and cursor.accept(*SIGNAL_WORDS)
    is_marked = is_named and cursor.accept(":")
    is_block = is_named and cursor.token.text == "{" and tokens[-1].text == "}"
    if is_block:
        cursor = Cursor(tokens[:-1], cursor.at + 1)
    elif is_marked and cursor.token.type != "NAME":
        return None
    signals: list[MeantDeclaration] = []
    while not cursor.is_done:
        meant = _signals(cursor, text, word, is_named or bool(signals), is_block=is_block)
        if meant is None:
            return None
        signals.append(meant)
        while cursor.accept(";", ","):
            pass
        cursor.accept(*SIGNAL_WORDS)
    if not signals:
        return None
    return MeantDeclaration(
        "signal",
        tuple(line for meant in signals for line in meant.lines),
        tuple(line for meant in signals for line in meant.read_as),
        all(meant.is_complete for meant in signals),
        signals[0].help if len(signals) == 1 else "",
        next((meant.reason for meant in signals if meant.reason), ""),
        tuple(enum for meant in signals for enum in meant.enums),
    )


def _is_name(cursor: Cursor) -> bool:
    """Whether a word such as ``state`` is the name of the signal, as in ``state: {idle, alert}`` and ``flag: bool``."""
    following, type_ = cursor.peek(1).text, cursor.peek(2)
    is_typed = type_.type != "NAME" or type_.text.lower() in TYPES
    return cursor.token.type == "NAME" and not cursor.token.text.endswith("s") and following == ":" and is_typed


def _signals(
    cursor: Cursor, text: WholeText, word: str, is_named: bool, *, is_block: bool = False
) -> MeantDeclaration | None:
    """Read one or more names with one type. In a block, another declaration may follow without a mark between."""
    first = _leading_type(cursor, text)
    names = _names(cursor)
    if not names or not (first is not None or is_named or cursor.token.text == ":"):
        return None
    if first is not None and first.values:
        type_: _Type | None = first
    elif first is not None and first.type == "enum":
        cursor.accept(":", "=")
        values = read_values(cursor)
        type_ = _Type(values=values) if values else None
    else:
        type_ = _type(cursor, text, first, is_named)
    if type_ is None:
        return None
    value = _default(cursor)
    is_last = cursor.is_done or cursor.token.text in (";", ",", *SIGNAL_WORDS)
    if value is None or not (is_last or (is_block and cursor.token.type == "NAME")):
        return None
    if not (type_.type or type_.ends or type_.values):
        if word == "let":
            return None
        is_bool = word in _TRUTHS or value in ("true", "false")
        type_ = _Type("bool") if is_bool else type_
    meant = _declared(names, type_, text.tokens)
    return replace(meant, reason=f"{meant.reason}: the game supplies the value at each step") if value else meant


def _lacks_name(cursor: Cursor) -> bool:
    """Whether a range or a type stands where a name should be, as in ``signal in [0, 3]``."""
    word, following = cursor.token.text, cursor.peek(1).text
    return (word in ("in", "from") and following != ":") or (word in TYPE_WORDS and following in ("in", "from"))


def _names(cursor: Cursor) -> tuple[str, ...]:
    """Read names, with their parameters, that are separated by commas; stop before what follows a last comma."""
    names: list[str] = []
    while cursor.token.type == "NAME" and not _lacks_name(cursor):
        name = cursor.token.text
        cursor.at += 1
        if cursor.token.text == "(" and cursor.peek(1).type in ("NAME", "ENTITY"):
            parameters = _parameters(cursor)
            if parameters is None:
                return ()
            name += parameters
        names.append(name)
        is_listed = cursor.token.text == "," and cursor.peek(1).type == "NAME"
        if not is_listed:
            break
        cursor.at += 1
    return tuple(names)


def _parameters(cursor: Cursor) -> str | None:
    """Read ``(x: entity)`` and return it, None without ``)``; a parameter without a name gets one."""
    texts: list[str] = []
    while not cursor.is_done and cursor.token.text != ")":
        texts.append(cursor.token.text)
        cursor.at += 1
    if cursor.is_done:
        return None
    cursor.at += 1
    inside = " ".join(texts[1:])
    return "(x: entity)" if inside == "entity" else f"({inside})".replace(" :", ":").replace(" ,", ",")


def _leading_type(cursor: Cursor, text: WholeText) -> _Type | None:
    """Read a type before the name, as in ``bool seen``; None if there is none."""
    start = cursor.at
    enum = _enum(cursor, text)
    if enum is not None and cursor.token.type == "NAME" and cursor.token.text.lower() not in _IS_TYPE:
        return enum
    cursor.at = start
    word, following = cursor.token.text.lower(), cursor.peek(1)
    if word not in _LEADING_TYPES or following.type != "NAME" or following.text.lower() in (*_IS_TYPE, "in", "from"):
        return None
    cursor.at += 1
    cursor.at += word == "enum" and cursor.token.text in ("class", "struct") and cursor.peek(1).type == "NAME"
    return _Type("enum") if word in ENUM_WORDS else _Type(TYPES[word])


def _enum(cursor: Cursor, text: WholeText) -> _Type | None:
    """Read the name of an enum of the file, as in ``Engine`` and ``enum Engine``; None if there is none."""
    is_named = cursor.token.text == "enum" and cursor.peek(1).text in text.enums
    name = cursor.peek(is_named).text
    if name not in text.enums:
        return None
    cursor.at += 1 + is_named
    return _Type(values=text.enums[name], enum=name)


def _type(cursor: Cursor, text: WholeText, first: _Type | None, is_named: bool) -> _Type | None:
    """Read the type, range or values after the names; None if they cannot be read."""
    is_typed = cursor.token.text.lower() in _IS_TYPE or cursor.accept("of", "type")
    if first is None and cursor.peek().text == "{" and is_named:
        values = read_values(cursor)
        return _Type(values=values) if values else None
    is_value = cursor.token.text == "=" and cursor.peek(1).type in ("NUMBER", "TRUE", "FALSE", "MINUS")
    if is_typed and not is_value and cursor.accept(*_IS_TYPE):
        cursor.at += cursor.token.text in ("a", "an") and cursor.peek(1).text.lower() in TYPES
    enum = _enum(cursor, text) if first is None else None
    if enum is not None:
        return enum
    word = cursor.token.text.lower()
    type_ = first.type if first else ""
    if word in TYPES and cursor.peek(1).text not in ("|", "/", "or"):
        cursor.at += 1
        if type_ and type_ != TYPES[word]:
            return None
        type_ = TYPES[word]
    unit = UNIT_OF_TYPE.get(type_, "").strip()
    if not type_ and is_typed and not is_value:
        type_, unit = read_unit_as_type(cursor)
    if not type_:
        values = read_values(cursor)
        if values:
            return _Type(values=values)
    elif cursor.token.text == ",":
        return _Type(type_)
    ends = whole_values(cursor) or read_range(cursor) or read_bounds(cursor, is_whole=type_ == "int")
    return _with_range(type_, ends, unit) if ends else _Type(type_)


def _with_range(type_: str, ends: Range, unit: str) -> _Type | None:
    """Return a type with a range, whose unit may say more about the type; ends without a unit get ``unit``."""
    low, high, type_of_unit = ends
    if type_ in ("", "number") and type_of_unit:
        type_ = type_of_unit
    if type_ == "int" and not all(_is_whole_end(end) for end in (low, high)):
        return None
    if unit and not type_of_unit:
        low, high = (end if end.endswith("inf") or end in MISSING_ENDS else f"{end} {unit}" for end in (low, high))
    return None if type_ == "bool" else _Type(type_, (low, high))


def _is_whole_end(end: str) -> bool:
    return end.lstrip("-").isdecimal() or end.endswith("inf") or end in MISSING_ENDS


def _default(cursor: Cursor) -> str | None:
    """Read the value that a signal is given; return it, or "" if there is none, or None if it cannot be read."""
    if not cursor.accept("=", "default", ":=", "initially", "init"):
        return ""
    cursor.accept("=", ":")
    sign = "-" if cursor.accept("-") else ""
    token = cursor.token
    if token.type not in ("NUMBER", "TRUE", "FALSE", "NAME", "STRING"):
        return None
    cursor.at += 1
    if cursor.token.type == "UNIT":
        cursor.at += 1
    if token.type == "NAME" and (cursor.accept(".") or cursor.accept_words(":", ":")):
        cursor.at += 1
    return f"{sign}{token.text.lower()}"


def _declared(names: Sequence[str], type_: _Type, text: Sequence[Token]) -> MeantDeclaration:
    """Return the declarations of signals with one type."""
    if type_.values:
        lines = tuple(f"signal {name}: ({', '.join(type_.values)})" for name in names)
        return MeantDeclaration("signal", lines, lines, enums=(type_.enum,) if type_.enum else ())
    if set(type_.ends).intersection(MISSING_ENDS):
        return _with_missing_ends(names, type_.type or "number", type_.ends)
    ends = f" in [{', '.join(type_.ends)}]" if type_.ends else ""
    if ends or type_.type in _NO_RANGE:
        lines = tuple(f"signal {name}{f': {type_.type}' if type_.type else ''}{ends}" for name in names)
        return MeantDeclaration("signal", lines, lines)
    if type_.type:
        return _with_missing_ends(names, type_.type, MISSING_ENDS)
    return _without_type(names, text)


def _with_missing_ends(names: Sequence[str], type_: str, ends: Sequence[str]) -> MeantDeclaration:
    """Return the declarations of signals of which one or both ends of the range are not written."""
    unit = UNIT_OF_TYPE.get(type_, "")
    assumed = {"LOW": f"-{_ASSUMED}{unit}", "HIGH": f"{_ASSUMED}{unit}"}
    read_as = ", ".join(assumed.get(end, end) for end in ends)
    written = ", ".join(f"{end}{unit}" if end in MISSING_ENDS else end for end in ends)
    known = {"LOW": "its least value for LOW", "HIGH": "its greatest value for HIGH"}
    missing = [words for end, words in known.items() if end in ends]
    return MeantDeclaration(
        "signal",
        tuple(f"signal {name}: {type_} in [{written}]" for name in names),
        tuple(f"signal {name}: {type_} in [{read_as}]" for name in names),
        is_complete=False,
        reason=", with its least value for LOW and its greatest for HIGH"
        if len(missing) > 1
        else f", with {missing[0]}",
    )


def _without_type(names: Sequence[str], text: Sequence[Token]) -> MeantDeclaration:
    """Return the declarations of signals without a type, which the rest of the file may tell."""
    uses = {used_as(name.partition("(")[0], text) for name in names}
    if uses == {"bool"}:
        lines = tuple(f"signal {name}: bool" for name in names)
        return MeantDeclaration("signal", lines, lines)
    if uses == {"number"}:
        return _with_missing_ends(names, "number", MISSING_ENDS)
    if uses == {"int"}:
        return _with_missing_ends(names, "int", MISSING_ENDS)
    help_ = (
        f"write `signal {names[0]}: bool` if it is true or false, `signal {names[0]}: number {MISSING_RANGE}` "
        f"if it is a number, with its least value for LOW and its greatest for HIGH"
    )
    return MeantDeclaration("signal", (), (), False, help_)
