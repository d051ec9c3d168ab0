"""Commands that pages name are there, with the options that they are given."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

import click
import pytest

from tests.docs.blocks import DOCS, ROOT, blocks
from tests.docs.test_pages import PAGES
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli.command_line import OF_THE_RUNTIME, cli

# The page of TLT0700 shows wrong usage.
CODES = (ROOT / "tltlc" / "diagnostics" / "pages").glob("*.md")
PAGES_OF_CODES = sorted(path for path in CODES if path.stem != "TLT0700")
CONTEXT = click.Context(cli, info_name="tltlc", **cli.context_settings)
NAMES = {*cli.list_commands(CONTEXT), *OF_THE_RUNTIME}
NO_OPTIONS = re.compile(r"""\$\(.*|'[^']*'|"[^"]*\"""")
"""Values in quotes, and other programs."""


def commands(page: Path) -> Iterator[tuple[str, str]]:
    """The name of each command that a page has in code, and what stands behind it."""
    text = page.read_text(encoding="utf-8")
    inline = re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL))
    lines = [
        line for block in blocks(page) if block.kind in ("sh", "console", "yaml") for line in block.text.splitlines()
    ]
    for code in [*inline, *lines]:
        for found in re.finditer(r"(?:^|[ /])tltlc ([a-z]\w*)((?: [^;&>]*)?)", re.sub("(^| )# .*", "", code)):
            yield found[1], found[2]


@lru_cache
def options(name: str) -> frozenset[str] | None:
    """Those of a command, None where its extra is not installed."""
    try:
        command = cli.get_command(CONTEXT, name)
    except TltlError:
        return None
    if command is None:
        return None
    return frozenset(option for each in command.params for option in (*each.opts, *each.secondary_opts)) | {
        "-h",
        "--help",
    }


@pytest.mark.parametrize("page", [*PAGES, *PAGES_OF_CODES], ids=lambda page: page.stem)
def test_commands_and_their_options_are_there(page: Path) -> None:
    for name, arguments in commands(page):
        assert name in NAMES, f"{page.name}: tltlc {name}"
        there = options(name)
        for option in re.findall(r"(?<![\w-])--?[a-z][\w-]*", NO_OPTIONS.sub("", arguments)):
            assert there is None or option in there, f"{page.name}: tltlc {name} {option}"


def test_pages_name_every_command() -> None:
    assert {name for page in PAGES for name, _ in commands(page)} == NAMES


def test_the_program_of_the_guide_to_the_playground_prints_that(capsys: pytest.CaptureFixture[str]) -> None:
    found = blocks(DOCS / "guides" / "playground.md")
    place, program = next((place, block) for place, block in enumerate(found) if block.kind == "python")
    exec(program.text, {})
    assert capsys.readouterr().out == found[place + 1].text
