"""Messages stay readable, however long the texts are that they quote."""

from __future__ import annotations

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.diagnostics.render import FORMATS, render
from tltlc.diagnostics.shortening import LONGEST_QUOTE, LONGEST_TEXT, short_text

LONG = "a" * (3 << 20)


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_shortens_a_long_name(name: str) -> None:
    label = Label(SourceFile("x.tltl", "spec"), Span(0, 4), f"`{LONG}` is here")
    diagnostic = Diagnostic("TLT0101", f"there is no `{LONG}`", (label,), f"did you mean `{LONG}b`?")
    text = render([diagnostic], name)
    assert len(text) < 10_000
    assert f"`{'a' * 199}…{'a' * 100}`" in text.replace("\\u2026", "…")


def test_text_between_two_short_quotes_is_not_shortened() -> None:
    text = f"`a` {'word ' * 200}`b`"
    assert short_text(text) == text


def test_a_quote_keeps_its_beginning_and_its_end() -> None:
    short = short_text("no file `" + "x" * 500 + "/end.tltl`")
    assert short.startswith("no file `xxx")
    assert short.endswith("/end.tltl`")
    assert len(short) == len("no file ``") + LONGEST_QUOTE


def test_a_text_without_quotes_is_shortened() -> None:
    assert len(short_text("word " * 10_000)) == LONGEST_TEXT
