"""Make a page for each command from its help."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Final

import click

from docs_site.page import Page
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli.command_line import RUNTIME_COMMANDS, cli

FOLDER: Final = "commands"
REFERENCE: Final = "commands.md"
"""The URI of the page that lists the commands."""


def names() -> list[str]:
    """Return the names of the commands, in the order of the help."""
    return cli.list_commands(_context())


def pages() -> Iterator[Page]:
    """Yield the page of each command; if its extra is not installed, the page has only a summary."""
    parent = _context()
    for name in names():
        try:
            command = cli.get_command(parent, name)
        except TltlError:
            command = None
        text = _page(name, command, parent) if command else f"# tltlc {name}\n\n{RUNTIME_COMMANDS[name]}\n"
        yield Page(f"{FOLDER}/{name}.md", text, f"docs/{FOLDER}/{name}.md")


def with_links(table: str) -> str:
    """Link each command in the tables of ``docs/commands.md`` to its page."""
    pattern = "|".join(map(re.escape, names()))
    return re.sub(rf"^\| (`tltlc ({pattern})\b[^`]*`) \|", rf"| [\1]({FOLDER}/\2.md) |", table, flags=re.MULTILINE)


def _context() -> click.Context:
    return click.Context(cli, info_name="tltlc", **cli.context_settings)


def _page(name: str, command: click.Command, parent: click.Context) -> str:
    context = click.Context(command, info_name=name, parent=parent)
    usage = " ".join(command.collect_usage_pieces(context))
    first, *rest = _paragraphs(command.help or "")
    lines = [f"# tltlc {name}", "", first, "", "```text", f"tltlc {name} {usage}", "```", ""]
    lines += [text for paragraph in rest for text in (paragraph, "")]
    lines += ["## Options", ""]
    for parameter in command.get_params(context):
        record = parameter.get_help_record(context)
        if record and isinstance(parameter, click.Option):
            lines += [f"`{record[0]}`", f":   {_escape(record[1])}", ""]
    for paragraph in _paragraphs(command.epilog or ""):
        lines += [paragraph, ""]
    return "\n".join(lines)


def _paragraphs(text: str) -> list[str]:
    r"""Return the paragraphs of a help text as Markdown.

    A paragraph after ``\b`` keeps its lines, as a block; its first line becomes a heading if it ends
    with a colon.
    """
    paragraphs = []
    for paragraph in inspect.cleandoc(text).split("\f")[0].split("\n\n"):
        if not paragraph.startswith("\b\n"):
            paragraphs.append(_escape(paragraph))
            continue
        title, _, block = paragraph.removeprefix("\b\n").partition("\n")
        if not title.endswith(":"):
            title, block = "", f"{title}\n{block}"
        heading = f"## {title[:-1]}\n\n" if title else ""
        paragraphs.append(f"{heading}```text\n{inspect.cleandoc(block)}\n```")
    return paragraphs


def _escape(text: str) -> str:
    """Escape plain text for Markdown, except between backquotes."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if index % 2 else re.sub(r"([\\*_<\[\]#])", r"\\\1", part) for index, part in enumerate(parts))
