"""``tltlc compile``: all files of all specs are made first, and only then written."""

from __future__ import annotations

from pathlib import Path

import click

from tltlc.cli.settings import Settings, source_options


@click.command(
    epilog="""\b
Examples:
  tltlc compile cover_and_hide.tltl                  three files beside you
  tltlc compile cover_and_hide.tltl -o build -t json,svg
  tltlc compile levels.tltl --spec level_1 --spec level_2
  tltlc compile build/level_1.fspa.json -t python    from an artefact
"""
)
@click.argument("spec", metavar="SPEC")
@click.option(
    "--output", "-o", "folder", metavar="DIR", type=click.Path(path_type=Path), default=".", help="Write here."
)
@click.option(
    "--target",
    "-t",
    "target_lists",
    metavar="TARGETS",
    multiple=True,
    help="What to write, by commas: `tltlc list targets` (default: json,dot,python, or those of tltl.toml).",
)
@click.option("--spec", "names", metavar="NAME", multiple=True, help="Only this spec of the file (repeatable).")
@source_options
def command(
    spec: str,
    folder: Path,
    target_lists: tuple[str, ...],
    names: tuple[str, ...],
    settings: Settings,
    format: str,  # noqa: A002
) -> int:
    """Compile the specs of SPEC (a file, FILE:NAME, an artefact, or - for standard input).

    For each spec NAME this writes NAME.fspa.json, NAME.dot and NAME_monitor.py, or what -t asks for.
    Nothing is written unless everything could be.
    """
    from tltlc import backends
    from tltlc.cli.inputs import open_input
    from tltlc.cli.report import Report
    from tltlc.writing import write_files

    with Report(format) as report:
        asked = [name.strip() for names in target_lists for name in names.split(",")]
        for target in asked:
            backends.target(target)
        opened = open_input(spec, settings, names)
        report.add(opened.diagnostics)
        targets = dict.fromkeys(asked or opened.project.targets or backends.DEFAULT_TARGETS)
        options = backends.Options(
            notation=opened.project.notation, report=lambda diagnostic: report.add((diagnostic,))
        )
        files: dict[str, str | bytes] = {}
        for fspa in opened.automata:
            for target in targets:
                files.update(backends.emit(target, fspa, options))
        for path in write_files(folder, files):
            report.say(f"wrote {path}")
        if not files:
            report.say(f"{opened.name}: there is no spec in it, so nothing was written")
    return report.status
