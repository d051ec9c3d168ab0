"""``tltlc fmt``: format source files."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

from tltlc.io.project import FORMATTINGS

if TYPE_CHECKING:
    from tltlc.interfaces.cli.report import Report


@click.command(
    epilog="""\b
Examples:
  tltlc fmt                            all .tltl files in this folder and its subfolders
  tltlc fmt levels                     another folder
  tltlc fmt --check --diff levels      show what would change; for continuous integration
  tltlc fmt --style unicode heist.tltl
  tltlc fmt - < heist.tltl             from standard input to standard output
"""
)
@click.argument("paths", metavar="[FILE_OR_FOLDER]...", nargs=-1)
@click.option(
    "--check", is_flag=True, help="Change no file. List the files that would change; exit with 1 if there are any."
)
@click.option("--diff", is_flag=True, help="Change no file. Print the changes.")
@click.option(
    "--style",
    type=click.Choice(FORMATTINGS),
    help="How to spell operators: `eventually`, `F`, `<>` or `◇` (default: the style in tltl.toml, or else words).",
)
def command(paths: tuple[str, ...], check: bool, diff: bool, style: str | None) -> int:
    """Format source files: one style for line breaks and operators, with the same specs and comments.

    Files are rewritten in place; without arguments, all files of the current folder. A file that would not change is
    not touched. `-` reads standard input and writes standard output. A file with syntax errors stays as it is, and the
    exit status is 1.
    """
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.interfaces.cli import exits
    from tltlc.interfaces.cli.folders import every_source, links_outside
    from tltlc.interfaces.cli.report import Report, count_text
    from tltlc.io.project import project_for

    changed = unchanged = 0
    with Report(results=True) as report:
        for path in every_source(paths or (".",), report):
            try:
                file_style = style or project_for(path).formatting
                if not check and not diff and links_outside(path, paths or (".",)):
                    report.say(f"{path} was not changed: it is a link to a file outside the folder")
                    continue
                is_same = _format(path, file_style, report, check=check, diff=diff)
            except TltlError as error:
                report.add(error.diagnostics)
                continue
            changed, unchanged = changed + (not is_same), unchanged + is_same
        if check:
            report.say(f"{count_text(changed, 'file')} would change, {unchanged} would not")
            report.status = report.status or (exits.FINDINGS if changed else exits.CLEAN)
        elif unchanged and not diff and paths != ("-",):
            report.say(f"{count_text(unchanged, 'file')} already had this layout")
    return report.status


def _format(path: str, style: str, report: Report, *, check: bool, diff: bool) -> bool:
    """Format one file in place, and return whether it was formatted already.

    The formatted text of standard input is printed. With ``check``, change nothing, and print the
    name of a file that would change. With ``diff``, change nothing, and print the changes instead.
    """
    from pathlib import Path

    from tltlc.interfaces.cli.inputs import check_text
    from tltlc.interfaces.cli.report import wants_colour
    from tltlc.io.files import MAX_SOURCE_BYTES, decode
    from tltlc.io.spec_file import STDIN, input_kind, read_data
    from tltlc.io.writing import rewrite
    from tltlc.tools.fmt import format_source

    data, name = read_data(path, MAX_SOURCE_BYTES)
    source = decode(data, name, kind=input_kind(path))
    check_text(source)
    formatted = format_source(source, style)
    is_same = formatted.encode() == data
    if check and not diff and not is_same:
        print(source.name)
    if diff and not is_same:
        from tltlc.tools.fmt.changes import diff_text

        sys.stdout.write(diff_text(source.name, data.decode(), formatted, color=wants_colour(sys.stdout)))
    if not check and not diff:
        if path == STDIN:
            # The text is UTF-8, whatever encoding the terminal has.
            sys.stdout.buffer.write(formatted.encode())
        elif not is_same:
            rewrite(Path(path), formatted)
            report.say(f"formatted {path}")
    return is_same
