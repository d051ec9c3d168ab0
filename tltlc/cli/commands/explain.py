"""``tltlc explain``: the page of an error code."""

from __future__ import annotations

import re
import sys

import click


@click.command(
    epilog="""\b
Examples:
  tltlc explain TLT0201
  tltlc list codes        what there is to explain
"""
)
@click.argument("code", metavar="TLTnnnn")
def command(code: str) -> int:
    """Say what an error code means, with an example that causes it and the way to mend it."""
    from tltlc.diagnostics import codes

    wanted = re.sub(r"(?i)\A(?:tlt)?", "TLT", code.strip(), count=1)
    known = tuple(codes.codes())
    if wanted not in known:
        from difflib import get_close_matches

        close = get_close_matches(wanted, known, n=1)
        raise click.UsageError(
            f"there is no error code `{code}`: "
            + (f"did you mean `{close[0]}`?" if close else "`tltlc list codes` shows them"),
            click.get_current_context(),
        )
    text = codes.page(wanted)
    if sys.stdout.isatty():
        from rich.console import Console
        from rich.markdown import Markdown

        Console(width=min(Console().width, 100)).print(Markdown(text))
    else:
        print(text.rstrip("\n"))
    return 0
