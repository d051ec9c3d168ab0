"""``tltlc render``: draw the automaton of a spec."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tltlc.interfaces.cli.paths import OutputPath, is_stdout
from tltlc.interfaces.cli.settings import CompileSettings, source_options

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Notation

_TARGET_OF_ENDING = {
    ".svg": "svg",
    ".png": "png",
    ".dot": "dot",
    ".gv": "dot",
    ".mmd": "mermaid",
    ".mermaid": "mermaid",
}


@click.command(
    epilog="""\b
Examples:
  tltlc render leave.tltl -o leave.svg
  tltlc render levels.tltl:level_1 -t png -o level_1.png
  tltlc render leave.tltl -t mermaid                 on standard output
"""
)
@click.argument("spec", metavar="SPEC[:NAME]")
@click.option(
    "--output",
    "-o",
    "path",
    metavar="FILE",
    type=OutputPath("file", stdout=True),
    help="Write the picture to this file; `-` is standard output (the default).",
)
@click.option(
    "--target",
    "-t",
    "target",
    type=click.Choice(("svg", "png", "dot", "mermaid")),
    help="The format of the picture (default: from the extension of FILE, or else svg).",
)
@click.option(
    "--notation",
    type=click.Choice(("unicode", "ascii", "english")),
    help="How to write formulas (default: the notation in tltl.toml, or else unicode).",
)
@source_options
def command(
    spec: str,
    path: Path | None,
    target: str | None,
    notation: Notation | None,
    settings: CompileSettings,
    format: str,  # noqa: A002
) -> int:
    """Draw the automaton of a spec: what remains to be done in each state, guards, distances, goal and trap.

    SPEC is a file, an artefact, or - for standard input. If the file has several specs, :NAME selects one.
    """
    from tltlc import backends
    from tltlc.interfaces.cli.inputs import open_input
    from tltlc.interfaces.cli.report import Report
    from tltlc.io.writing import write_file

    path = None if is_stdout(path) else path
    kind = target or _target_of(path)
    if path is None and kind == "png" and sys.stdout.isatty():
        raise click.UsageError("a terminal cannot show a PNG: name a file with -o")
    with Report(format, results=path is None) as report:
        spec_input = open_input(spec, settings)
        report.add(spec_input.diagnostics)
        options = backends.Options(
            notation=notation or spec_input.project.notation,
            report=lambda diagnostic: report.add((diagnostic,)),
        )
        for name, content in backends.emit(kind, spec_input.only_automaton(), options).items():
            if path is not None:
                if kind != "dot" and name.endswith(".dot"):
                    path = path.with_suffix(".dot")  # the layout took too long, and this is the graph itself
                write_file(path, content)
                report.say(f"wrote {path}")
            else:
                sys.stdout.buffer.write(content.encode() if isinstance(content, str) else content)
    return report.status


def _target_of(path: Path | None) -> str:
    if path is None:
        return "svg"
    kind = _TARGET_OF_ENDING.get(path.suffix.lower())
    if kind is None:
        endings = ", ".join(_TARGET_OF_ENDING)
        raise click.UsageError(f"`{path}` does not have the ending of a picture: use one of {endings}, or -t")
    return kind
