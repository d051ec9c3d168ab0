"""TOML is read within limits, which are checked before the standard parser gets the text."""

from __future__ import annotations

import sys
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import TOML
from tltlc.io.toml_text import parse

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

assert TOML.depth is not None
assert TOML.values is not None


def read(text: str) -> dict[str, Any]:
    return parse(SourceFile("x.toml", text), "TLT0801", "mend it")


def depth(value: object) -> int:
    """Return the number of tables and lists around the innermost value."""
    inside = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return 1 + max(map(depth, inside), default=0) if isinstance(value, (dict, list)) else 0


def nested(levels: int, value: str) -> str:
    return "[" * levels + value + "]" * levels


BOMBS = {
    "a dotted key": "a" + ".a" * 20_000 + " = 1",
    "a dotted key with blanks": "a" + " . a" * 20_000 + " = 1",
    "a dotted key with quotes": '"a"' + ".'a'" * 20_000 + " = 1",
    "a dotted header": "[a" + ".a" * 20_000 + "]",
    "many dotted keys": "\n".join(f"{'a.' * 33}a{number} = 1" for number in range(1000)),
    "lists": "a = " + nested(33, "1"),
    "inline tables": "a = " + "{ a = " * 33 + "1" + " }" * 33,
    "a dotted key inside lists": "a = " + "[" * 20 + "{ " + ".".join("a" * 13) + " = 1 }" + "]" * 20,
    "many keys": "".join(f"a{number}=1\n" for number in range(TOML.values + 1)),
    "many tables": "[[a]]\n" * (TOML.values // 2 + 1),
    "many headers": "".join(f"[{number}]\n" for number in range(TOML.values + 1)),
    "a long list": "a = [" + "1," * TOML.values + "]",
}


@pytest.mark.parametrize("text", BOMBS.values(), ids=BOMBS)
def test_a_bomb_is_rejected(text: str) -> None:
    assert len(text) <= TOML.size
    with pytest.raises(TltlError, match="TLT0006"):
        read(text)


SAFE = {
    "a dotted key": ".".join("a" * TOML.depth) + " = 1",
    "lists": "a = " + nested(TOML.depth - 1, "1"),
    "points in a quoted key": f'"{"." * 1000}" = 1',
    "points in a text": f'a = "{".a" * 1000}"',
    "brackets in a text": f'a = "{"[" * 1000}"',
    "brackets behind an escaped quote": 'a = "\\"' + "[" * 1000 + '"',
    "brackets in a long text": f'a = """{"[" * 1000}"""',
    "brackets in a comment": f"# {'[' * 1000} ' \" {'a.' * 1000}\na = 1",
    "quotes at the end of a long text": 'a = """"x"""""\nb = [[1]]',
}


@pytest.mark.parametrize("text", SAFE.values(), ids=SAFE)
def test_a_text_within_the_limits_is_read(text: str) -> None:
    assert read(text) == tomllib.loads(text)


@pytest.mark.parametrize("quotes", ['"', "'", '"""', "'''"])
@pytest.mark.parametrize("inside", ['\\"""', "\\'", '\\"', "x", '"', "'"])
def test_unterminated_strings_take_linear_time(quotes: str, inside: str) -> None:
    # A scan that starts again at each quote would take quadratic time.
    with pytest.raises(TltlError, match="TLT0801"):
        read("a = " + quotes + inside * (500_000 // len(inside)) + "\n[")


SIGNS = [*"ab.=,[]{}\n #", " = ", '"', "'", '"""', "'''", "\\", '"\\""']
WORDS = ["1", "a.b", "[a]\n", "[[a]]\n", "a = 1\n", "= [", "x = {"]
PIECES = st.sampled_from(SIGNS + WORDS)


@given(st.lists(PIECES, max_size=60).map("".join))
def test_any_text_is_read_like_the_standard_parser_or_rejected(text: str) -> None:
    try:
        expected = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        with pytest.raises(TltlError):
            read(text)
    else:
        assert depth(expected) <= TOML.depth
        assert read(text) == expected
