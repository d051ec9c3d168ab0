"""Read TOML so that every value has a label: its file and the place of its key in this file.

Values may come from several files: an overlay is a file that changes values of a level. Thanks to
the labels, a diagnostic about a changed value points into the overlay.
"""

from __future__ import annotations

import re
from typing import Any, Final

from tltlc.api import Label, SourceFile, Span, fileio, record

_HELP: Final = 'write values as in `at = [1.0, 2.0, 0.0]`, and texts as in `asset = "corridor"`'
_KEY: Final = r"(?:[A-Za-z0-9_-]+|\"(?:\\.|[^\"\\\n])*\"|'[^'\n]*')"
_DOTTED: Final = re.compile(rf"{_KEY}(?:[ \t]*\.[ \t]*{_KEY})*")
_BLANK: Final = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_TEXT_VALUE: Final = re.compile(r"[ \t]*=[ \t]*(\"(?!\"\")(?:\\.|[^\"\\\n])*\"|'(?!'')[^'\n]*')")
_SCALAR: Final = re.compile(
    r"\"\"\"(?:\\.|(?!\"\"\")[^\\])*\"{3,5}|'''(?:(?!''').)*'{3,5}|\"(?:\\.|[^\"\\\n])*\"|'[^'\n]*'|[^\n,#\]}]*",
    re.DOTALL,
)
_VALUE_PART: Final = re.compile(
    r"\"\"\"(?:\\.|(?!\"\"\")[^\\])*\"{3,5}|'''(?:(?!''').)*'{3,5}|\"(?:\\.|[^\"\\\n])*\"|'[^'\n]*'|#[^\n]*|[\[\]{}\n]|.",
    re.DOTALL,
)


@record
class Entry:
    """A value of a TOML file, and its label, which is the place of its key.

    The value is a scalar, a list, a :data:`Tree`, or a list of entries whose values are trees.
    """

    value: Any
    label: Label


Tree = dict[str, Entry]
"""The entries of a table, by key."""


def read_tree(source: SourceFile, code: str = "TLT0801", help_: str = _HELP) -> Tree:
    """Parse a TOML text; return its top-level table, with a label for every value.

    Raises:
        TltlError: the error ``code``, with the help ``help_``, if the text is not TOML; TLT0006 if
            it nests too deep or has too many values.
    """
    data = fileio.parse_toml(source, code, help_)
    return _tree(data, (), _key_spans(source.text), Label(source, Span(0, 0)))


def value_label(key: Label) -> Label:
    """Return the label of the text that is the value of a key; ``key`` is the label of the key.

    If something else than a text in one line follows the key, return ``key``.
    """
    match = _TEXT_VALUE.match(key.source.text, key.span.end)
    return Label(key.source, Span(match.start(1), match.end(1))) if match else key


def _tree(data: dict[str, Any], path: tuple[str | int, ...], spans: dict[Any, Span], around: Label) -> Tree:
    tree: Tree = {}
    for key, value in data.items():
        here = (*path, key)
        label = Label(around.source, spans[here]) if here in spans else around
        if isinstance(value, dict):
            tree[key] = Entry(_tree(value, here, spans, label), label)
        elif isinstance(value, list) and value and all(isinstance(item, dict) for item in value):
            tables = []
            for number, item in enumerate(value):
                place = Label(around.source, spans.get((*here, number), label.span))
                tables.append(Entry(_tree(item, (*here, number), spans, place), place))
            tree[key] = Entry(tables, label)
        else:
            tree[key] = Entry(value, label)
    return tree


def _key_spans(text: str) -> dict[tuple[str | int, ...], Span]:
    """Return the spans of the keys and table headers in a valid TOML text, by path.

    A path has keys and, in lists of tables, indices: ``("room", 0, "size")``.
    """
    spans: dict[tuple[str | int, ...], Span] = {}
    counts: dict[tuple[str | int, ...], int] = {}
    table: tuple[str | int, ...] = ()
    position = 0
    while (position := _end(_BLANK, text, position)) < len(text):
        brackets = 2 if text.startswith("[[", position) else 1 if text[position] == "[" else 0
        start = _end(_BLANK, text, position + brackets)
        end = _end(_DOTTED, text, start)
        path = _dotted_path(text[start:end], () if brackets else table, counts)
        if brackets == 2:
            counts[path] = counts.get(path, -1) + 1
            spans.setdefault(path, Span(start, end))
            path = (*path, counts[path])
        for length in range(0 if brackets else len(table), len(path)):
            spans.setdefault(path[:length], Span(start, end))
        spans[path] = Span(start, end)
        if brackets:
            table = path
            position = text.find("]", end) + brackets
        else:
            begin = text.index("=", end) + 1
            position = _value_end(text, begin)
            if "{" in text[begin:position]:
                _inline_spans(text, begin, path, spans)
    return spans


def _inline_spans(
    text: str, position: int, path: tuple[str | int, ...], spans: dict[tuple[str | int, ...], Span]
) -> int:
    """Add the spans of the keys in the inline tables of the value at ``position``; return where the value ends.

    ``path`` is the path of the value. Items of a list have the paths ``(*path, 0)``, ``(*path, 1)`` and so on.
    """
    position = _end(_BLANK, text, position)
    opening = text[position : position + 1]
    if opening not in ("{", "["):
        return _end(_SCALAR, text, position)
    position, number = _end(_BLANK, text, position + 1), 0
    while position < len(text) and text[position] not in "}]":
        before = position
        if opening == "{":
            end = _end(_DOTTED, text, position)
            own = _dotted_path(text[position:end], path, {})
            for length in range(len(path) + 1, len(own) + 1):
                spans.setdefault(own[:length], Span(position, end))
            position = _end(_BLANK, text, end) + 1
        else:
            own = (*path, number)
            number += 1
        position = _end(_BLANK, text, _inline_spans(text, position, own, spans))
        position = _end(_BLANK, text, position + (text[position : position + 1] == ","))
        if position <= before:
            break
    return position + 1


def _dotted_path(
    dotted: str, around: tuple[str | int, ...], counts: dict[tuple[str | int, ...], int]
) -> tuple[str | int, ...]:
    """Return the path of a dotted key in the table at path ``around``: ``a.b`` -> ``("a", "b")``.

    If a key names a list of tables, the path continues in the last table of this list so far:
    ``a.b`` -> ``("a", 2, "b")``. ``counts`` has the index of this table, by the path of the list.
    """
    path = around
    keys = re.findall(_KEY, dotted)
    for number, key in enumerate(keys):
        path = (*path, _name(key))
        if number < len(keys) - 1 and path in counts:
            path = (*path, counts[path])
    return path


def _name(key: str) -> str:
    """Return the name that a key stands for: the text of a quoted key, with its escapes decoded."""
    if key[0] not in "\"'":
        return key
    (name,) = fileio.parse_toml(SourceFile("", f"{key} = 0"), "TLT0801", "")
    return name


def _end(pattern: re.Pattern[str], text: str, position: int) -> int:
    match = pattern.match(text, position)
    return match.end() if match else position


def _value_end(text: str, position: int) -> int:
    """Return the position after the line on which the value at ``position`` ends."""
    depth = 0
    while position < len(text):
        part = _VALUE_PART.match(text, position)
        assert part is not None  # its last alternative is any character
        position = part.end()
        depth += (part[0] in ("[", "{")) - (part[0] in ("]", "}"))
        if part[0] == "\n" and depth == 0:
            break
    return position
