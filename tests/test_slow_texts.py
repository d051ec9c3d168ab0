"""Texts that once took quadratic time or more."""

from __future__ import annotations

import pytest

from tests.time_limit import run_with_time_limit


@pytest.mark.parametrize(
    "code",
    [
        # A project file of blank lines with one unknown key.
        "from tltlc.io.project import _key_labels; from tltlc.core.source import SourceFile\n"
        "_key_labels(SourceFile('tltl.toml', '\\n' * 1_000_000 + 'librarys'), 'kez')",
        # A project file of many unknown keys.
        "from tltlc.io.project import _key_labels; from tltlc.core.source import SourceFile\n"
        "source = SourceFile('tltl.toml', ''.join(f'k{n}=1\\n' for n in range(100_000)))\n"
        "for n in range(100_000): assert _key_labels(source, f'k{n}')",
        # The value of a param with an invalid unit.
        "from tltlc.resolve.constants import parse_override\nassert parse_override('1' * 1_000_000 + '!') is None",
        "from tltlc.resolve.constants import parse_override\n"
        "assert parse_override('1' + ' ' * 1_000_000 + '!') is None",
        # An automaton of another tool with an unterminated string.
        "from tltlc.tools.hoa.reader import _without_comments; from tltlc.core.source import SourceFile\n"
        "_without_comments(SourceFile('a.hoa', '\"' + '\\\\\"' * 2_000_000))",
        "from tltlc.tools.hoa.reader import _without_comments; from tltlc.core.source import SourceFile\n"
        "_without_comments(SourceFile('a.hoa', '\"' + '\\\\\"' * 2_000_000 + '\\\\'))",
    ],
    ids=["blank lines", "unknown keys", "digits", "blanks", "quotes", "quotes and a backslash"],
)
def test_slow_texts_are_processed_quickly(code: str) -> None:
    run_with_time_limit(code)
