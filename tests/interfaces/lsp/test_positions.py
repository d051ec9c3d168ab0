"""Columns are counted in the agreed encoding: 𝒰 is four bytes in UTF-8, two units in UTF-16, one in
UTF-32."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types

from tltlc.core.source import SourceFile, Span
from tltlc.interfaces.lsp.positions import offset, position, range_of

TEXT = "spec é = a 𝒰 b\r\nlet 𝒰"


@pytest.mark.parametrize(
    ("encoding", "columns"),
    [("utf-8", (0, 5, 7, 12, 16)), ("utf-16", (0, 5, 6, 11, 13)), ("utf-32", (0, 5, 6, 11, 12))],
)
def test_columns_are_counted_in_the_encoding(encoding: str, columns: tuple[int, ...]) -> None:
    source = SourceFile("a.tltl", TEXT)
    for character, column in zip((0, 5, 6, 11, 12), columns, strict=True):
        assert position(source, character, encoding) == types.Position(0, column)
        assert offset(source, types.Position(0, column), encoding) == character
    assert position(source, TEXT.index("let"), encoding) == types.Position(1, 0)


@given(st.text(st.sampled_from("a𝒰é\n\r\t \u2028\x0c😀")), st.sampled_from(["utf-8", "utf-16", "utf-32"]), st.data())
def test_a_position_converts_back_to_its_offset(text: str, encoding: str, data: st.DataObject) -> None:
    source = SourceFile("a.tltl", text)
    at = data.draw(st.integers(0, len(text)))
    back = offset(source, position(source, at, encoding), encoding)
    # No position is between the two characters of a line end.
    assert back == (at - 1 if text[at - 1 : at + 1] == "\r\n" and at else at)


def test_positions_outside_the_text_are_moved_to_the_nearest_one() -> None:
    source = SourceFile("a.tltl", "ab\ncd")
    assert offset(source, types.Position(0, 99)) == 2
    assert offset(source, types.Position(99, 0)) == 5
    # The second half of a surrogate pair maps to the position after it.
    assert offset(SourceFile("a.tltl", "𝒰x"), types.Position(0, 1)) == 1
    assert range_of(source, Span(1, 99)) == types.Range(types.Position(0, 1), types.Position(1, 2))
