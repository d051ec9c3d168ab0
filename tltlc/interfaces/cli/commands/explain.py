"""``tltlc explain``: explain a spec in plain words, or print the page of an error code."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from tltlc.interfaces.cli.settings import CompileSettings, compile_options

if TYPE_CHECKING:
    from tltlc.tools.explain.explanation import Explanation

_CODE: Final = re.compile(r"(?i)\A\s*(?:tlt)?[0-9]{1,4}\s*\Z")
_CODE_LIKE: Final = re.compile(r"(?i)\A\s*tlt[0-9a-z]*\s*\Z")


@click.command(
    epilog="""\b
Examples:
  tltlc explain leave.tltl
  tltlc explain levels.tltl:level_1 --format markdown
  tltlc explain levels --format markdown > levels.md    every spec of a folder
  tltlc explain TLT0201
  tltlc explain TLT02     all codes that start with TLT02
  tltlc list codes        all codes
"""
)
@click.argument("what", metavar="SPEC[:NAME]|FOLDER|TLTnnnn")
@click.option(
    "--format",
    type=click.Choice(("text", "markdown", "json")),
    default="text",
    help="The format of the explanation (default: text).",
)
@compile_options
def command(what: str, format: str, settings: CompileSettings) -> int:  # noqa: A002
    """Explain a spec, or an error code and how to fix the error.

    For a spec, the output lists its steps, the conditions that always hold, what violates it, when it ends, its states,
    and the shortest traces that succeed and fail. SPEC is a file, an artefact, or - for standard input. Without :NAME,
    all specs of the file are explained; in a folder, those of all .tltl files, also in subfolders.
    """
    if (_CODE.match(what) or _CODE_LIKE.match(what)) and not Path(what).exists():
        return _print_code_page(what)
    return _explain_specs(what, format, settings)


def _explain_specs(argument: str, format: str, settings: CompileSettings) -> int:  # noqa: A002
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.interfaces.cli.folders import every_source
    from tltlc.interfaces.cli.inputs import open_input
    from tltlc.interfaces.cli.report import Report
    from tltlc.tools.explain.explanation import explain

    explanations: list[Explanation] = []
    with Report(results=True) as report:
        for path in every_source([argument], report):
            try:
                spec_input = open_input(path, settings)
            except TltlError as error:
                report.add(error.diagnostics)
                continue
            report.add(spec_input.diagnostics)
            explanations += map(explain, spec_input.automata)
        if explanations or not report.status:
            _print_explanations(explanations, format)
    return report.status


def _print_explanations(explanations: list[Explanation], format: str) -> None:  # noqa: A002
    if format == "json":
        import json

        from tltlc.tools.explain.values import json_values

        click.echo(
            json.dumps(
                {"specs": [json_values(explanation) for explanation in explanations]}, indent=2, ensure_ascii=False
            )
        )
        return
    if format == "markdown":
        from tltlc.tools.explain.markdown import markdown as write
    else:
        from tltlc.tools.explain.text import text as write
    click.echo("\n".join(write(explanation) for explanation in explanations), nl=False)


def _print_code_page(code: str) -> int:
    """Print the documentation page of an error code such as ``TLT0201``, and return the exit status.

    If ``code`` is only the beginning of error codes, such as ``TLT02``, list these codes with their
    titles. Raise click.UsageError if no code begins with it.
    """
    from tltlc.diagnostics import code_pages

    full_code = re.sub(r"(?i)\A(?:tlt)?", "TLT", code.strip(), count=1)
    if full_code not in code_pages.codes():
        family = code_pages.codes_with_prefix(full_code)
        if not family:
            *first, last = (f"`{nearest}`" for nearest in code_pages.nearest_codes(full_code))
            candidates = f"{', '.join(first)} or {last}"
            raise click.UsageError(
                f"there is no error code `{code}`: did you mean {candidates}?", click.get_current_context()
            )
        from tltlc.interfaces.cli.commands.list import show

        show([{"name": member, "doc": code_pages.title(member)} for member in family])
        return 0
    text = code_pages.page(full_code)
    if sys.stdout.isatty():
        from rich.console import Console
        from rich.markdown import Markdown

        Console(width=min(Console().width, 100)).print(Markdown(text))
    else:
        print(text.rstrip("\n"))
    return 0
