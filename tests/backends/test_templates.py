from __future__ import annotations

import pytest

from tltlc.backends.templates import fill, fill_template


def test_placeholders_are_filled_once() -> None:
    assert fill("a @@b@@ c@@d@@\n", {"b": "@@d@@", "d": "\\1"}) == "a @@d@@ c\\1\n"


def test_the_line_of_an_empty_piece_is_removed() -> None:
    text = "{\n    @@a@@\n@@b@@\nx @@a@@\n}\n"
    assert fill(text, {"a": "", "b": "1\n2"}) == "{\n1\n2\nx \n}\n"


def test_only_the_chosen_blocks_are_kept() -> None:
    text = "1\n// @@if a@@\n2 @@x@@\n// @@end@@\n3\n    @@if b@@\n4\n    @@end@@\n"
    assert fill(text, {"x": "y"}, {"a"}) == "1\n2 y\n3\n"
    assert fill(text, {}, {"b"}) == "1\n3\n4\n"


def test_a_placeholder_without_a_piece_is_a_bug() -> None:
    with pytest.raises(KeyError):
        fill("@@a@@", {})


def test_a_template_is_read_from_its_folder() -> None:
    with pytest.raises(KeyError):
        fill_template("monitor.py.txt", {})
    with pytest.raises(FileNotFoundError):
        fill_template("monitor.cobol.txt", {})
