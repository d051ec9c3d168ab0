from __future__ import annotations

import pytest

from tltlc.program.template import fill, filled


def test_places_are_filled_and_pieces_left_alone() -> None:
    assert fill("a @@b@@ c@@d@@\n", {"b": "@@d@@", "d": "\\1"}) == "a @@d@@ c\\1\n"


def test_a_line_of_an_empty_piece_goes() -> None:
    text = "{\n    @@a@@\n@@b@@\nx @@a@@\n}\n"
    assert fill(text, {"a": "", "b": "1\n2"}) == "{\n1\n2\nx \n}\n"


def test_blocks_stay_where_they_are_wanted() -> None:
    text = "1\n// @@if a@@\n2 @@x@@\n// @@end@@\n3\n    @@if b@@\n4\n    @@end@@\n"
    assert fill(text, {"x": "y"}, {"a"}) == "1\n2 y\n3\n"
    assert fill(text, {}, {"b"}) == "1\n3\n4\n"


def test_a_place_without_a_piece_is_a_bug() -> None:
    with pytest.raises(KeyError):
        fill("@@a@@", {})


def test_templates_lie_beside() -> None:
    with pytest.raises(KeyError):
        filled("monitor.py.txt", {})
