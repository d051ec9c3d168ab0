"""A page for each command, made of its own help."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Final

import click

from docs_site.page import Page
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli.command_line import OF_THE_RUNTIME, cli

FOLDER: Final = "commands"


def names() -> list[str]:
    """The commands, in the order of the help."""
    return cli.list_commands(_context())


def pages() -> Iterator[Page]:
    """One page each; where a command's extra is not installed, it says no more than what the command does."""
    above = _context()
    for name in names():
        try:
            command = cli.get_command(above, name)
        except TltlError:
            command = None
        text = _page(name, command, above) if command else f"# tltlc {name}\n\n{OF_THE_RUNTIME[name]}\n"
        yield Page(f"{FOLDER}/{name}.md", text, f"docs/{FOLDER}/{name}.md")


def linked(table: str) -> str:
    """A table of commands, each with a link to its page, as from the README."""
    known = "|".join(map(re.escape, names()))
    return re.sub(rf"^\| (`tltlc ({known})\b[^`]*`) \|", rf"| [\1](docs/{FOLDER}/\2.md) |", table, flags=re.MULTILINE)


def _context() -> click.Context:
    return click.Context(cli, info_name="tltlc", **cli.context_settings)


def _page(name: str, command: click.Command, above: click.Context) -> str:
    context = click.Context(command, info_name=name, parent=above)
    usage = " ".join(command.collect_usage_pieces(context))
    first, *rest = _paragraphs(command.help or "")
    lines = [f"# tltlc {name}", "", first, "", "```text", f"tltlc {name} {usage}", "```", ""]
    lines += [text for paragraph in rest for text in (paragraph, "")]
    lines += ["## Options", ""]
    for parameter in command.get_params(context):
        record = parameter.get_help_record(context)
        if record and isinstance(parameter, click.Option):
            lines += [f"`{record[0]}`", f":   {_escaped(record[1])}", ""]
    for paragraph in _paragraphs(command.epilog or ""):
        lines += [paragraph, ""]
    return "\n".join(lines)


def _paragraphs(text: str) -> list[str]:
    r"""The paragraphs of a help text; what stands behind ``\b`` keeps its lines, under a heading where it has one."""
    found = []
    for paragraph in inspect.cleandoc(text).split("\f")[0].split("\n\n"):
        if not paragraph.startswith("\b\n"):
            found.append(_escaped(paragraph))
            continue
        title, _, block = paragraph.removeprefix("\b\n").partition("\n")
        if not title.endswith(":"):
            title, block = "", f"{title}\n{block}"
        heading = f"## {title[:-1]}\n\n" if title else ""
        found.append(f"{heading}```text\n{inspect.cleandoc(block)}\n```")
    return found


def _escaped(text: str) -> str:
    """Plain text as Markdown; what stands between backticks is left alone."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if index % 2 else re.sub(r"([\\*_<\[\]#])", r"\\\1", part) for index, part in enumerate(parts))
