"""``tltlc check``: everything that compiling would say, and nothing written."""

from __future__ import annotations

import click

from tltlc.cli.settings import Settings, source_options


@click.command(
    epilog="""\b
Examples:
  tltlc check cover_and_hide.tltl
  tltlc check --format github levels/*.tltl      remarks on a pull request
  tltlc check --format sarif levels/*.tltl > tltlc.sarif
"""
)
@click.argument("specs", metavar="SPEC...", nargs=-1, required=True)
@source_options
def command(specs: tuple[str, ...], settings: Settings, format: str) -> int:  # noqa: A002
    """Report every error and warning of each SPEC (a file, FILE:NAME, an artefact, or - for standard input).

    The exit status is 1 where there is an error, and 0 where there are warnings at most.
    """
    from tltlc.cli.inputs import open_input
    from tltlc.cli.report import Report
    from tltlc.diagnostics.diagnostic import TltlError

    with Report(format) as report:
        for spec in specs:
            try:
                opened = open_input(spec, settings)
            except TltlError as error:
                report.add(error.diagnostics)
                continue
            report.add(opened.diagnostics)
            if not opened.diagnostics:
                count = len(opened.automata)
                report.say(f"{opened.name}: {count} spec{'' if count == 1 else 's'}, nothing to report")
    return report.status
