"""``tltlc compile``: all files of all specs are made first, and only then written."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import click

from tltlc.cli import exits
from tltlc.cli.outputs import output_option, target_option, targets_of, write_automata
from tltlc.cli.settings import Settings, source_options


@click.command(
    epilog="""\b
Examples:
  tltlc compile cover_and_hide.tltl                  three files beside you
  tltlc compile cover_and_hide.tltl -o build -t json,svg
  tltlc compile levels.tltl --spec level_1 --spec level_2
  tltlc compile build/level_1.fspa.json -t python    from an artefact
  tltlc compile levels.tltl -o Assets/Specs -t csharp --watch
"""
)
@click.argument("spec", metavar="SPEC")
@output_option
@target_option
@click.option("--spec", "names", metavar="NAME", multiple=True, help="Only this spec of the file (repeatable).")
@click.option(
    "--watch", is_flag=True, help="Stay, and compile again whenever a file changes that was read, until Ctrl-C."
)
@source_options
def command(
    spec: str,
    folder: Path,
    target_lists: tuple[str, ...],
    names: tuple[str, ...],
    watch: bool,
    settings: Settings,
    format: str,  # noqa: A002
) -> int:
    """Compile the specs of SPEC (a file, FILE:NAME, an artefact, or - for standard input).

    For each spec NAME this writes NAME.fspa.json, NAME.dot and NAME_monitor.py, or what -t asks for.
    Nothing is written unless everything could be, and files that would not change stay untouched.
    """
    from tltlc.cli.inputs import open_input
    from tltlc.cli.report import Report

    def compile_once(changed: tuple[str, ...] = ()) -> int:
        with Report(format) as report:
            if changed:
                report.say(f"\n{time.strftime('%H:%M:%S')} changed: {', '.join(changed)}")
            asked = targets_of(target_lists)
            opened = open_input(spec, settings, names)
            report.add(opened.diagnostics)
            if not write_automata(opened.automata, asked, folder, opened.project, report):
                report.say(f"{opened.name}: there is no spec in it, so nothing was written")
        return report.status

    def compile_and_tell(changed: tuple[str, ...]) -> None:
        # No file that changes would mend the command line.
        if compile_once(changed) == exits.USAGE and not changed:
            raise exits.StopQuietlyError(exits.USAGE)
        if format == "text":
            print("waiting for changes, until Ctrl-C", file=sys.stderr)

    if watch:
        from tltlc.cli.watching import repeat
        from tltlc.spec_file import STDIN, split

        if split(spec)[0] == STDIN:
            raise click.UsageError("--watch takes a file: standard input does not change")
        repeat(compile_and_tell)
    return compile_once()
