"""Commands named on pages exist, and have the options that the pages give them."""

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
from tltlc.interfaces.cli.command_line import RUNTIME_COMMANDS, cli

# The page of TLT0700 shows wrong usage on purpose.
CODES = (ROOT / "tltlc" / "diagnostics" / "pages").glob("*.md")
PAGES_OF_CODES = sorted(path for path in CODES if path.stem != "TLT0700")
CONTEXT = click.Context(cli, info_name="tltlc", **cli.context_settings)
NAMES = {*cli.list_commands(CONTEXT), *RUNTIME_COMMANDS}
NO_OPTIONS = re.compile(r"""\$\(.*|'[^']*'|"[^"]*\"""")
"""Quoted values, and calls of other programs."""


def commands(page: Path) -> Iterator[tuple[str, str]]:
    """Yield the name and the arguments of each command in the code of a page."""
    text = page.read_text(encoding="utf-8")
    inline = re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL))
    lines = [
        line for block in blocks(page) if block.kind in ("sh", "console", "yaml") for line in block.text.splitlines()
    ]
    for code in [*inline, *lines]:
        for match in re.finditer(r"(?:^|[ /])tltlc ([a-z]\w*)((?: [^;&>]*)?)", re.sub("(^| )# .*", "", code)):
            yield match[1], match[2]


@lru_cache
def options(name: str) -> frozenset[str] | None:
    """Return the options of a command, or None if its extra is not installed."""
    try:
        command = cli.get_command(CONTEXT, name)
    except TltlError:
        return None
    if command is None:
        return None
    return frozenset(
        option for parameter in command.params for option in (*parameter.opts, *parameter.secondary_opts)
    ) | {
        "-h",
        "--help",
    }


@pytest.mark.parametrize("page", [*PAGES, *PAGES_OF_CODES], ids=lambda page: page.stem)
def test_commands_and_their_options_exist(page: Path) -> None:
    for name, arguments in commands(page):
        assert name in NAMES, f"{page.name}: tltlc {name}"
        known_options = options(name)
        for option in re.findall(r"(?<![\w-])--?[a-z][\w-]*", NO_OPTIONS.sub("", arguments)):
            assert known_options is None or option in known_options, f"{page.name}: tltlc {name} {option}"


def test_the_pages_name_every_command() -> None:
    assert {name for page in PAGES for name, _ in commands(page)} == NAMES


def test_the_program_of_the_playground_guide_prints_the_shown_output(capsys: pytest.CaptureFixture[str]) -> None:
    page_blocks = blocks(DOCS / "guides" / "playground.md")
    place, program = next((place, block) for place, block in enumerate(page_blocks) if block.kind == "python")
    exec(program.text, {})
    assert capsys.readouterr().out == page_blocks[place + 1].text


@pytest.mark.parametrize("name", sorted(NAMES))
def test_every_option_has_a_help_text(name: str) -> None:
    try:
        command = cli.get_command(CONTEXT, name)
    except TltlError:
        pytest.skip(f"the extra for `{name}` is not installed")
    assert command is not None
    without = [option.opts for option in command.params if isinstance(option, click.Option) and not option.help]
    assert not without
