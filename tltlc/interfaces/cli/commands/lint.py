"""``tltlc lint``: what compiles and yet may not say what was meant, with fixes."""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import TYPE_CHECKING

import click

from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.settings import Settings, check_libraries, compile_settings, source_options

if TYPE_CHECKING:
    from tltlc.diagnostics.diagnostic import Diagnostic
    from tltlc.interfaces.cli.report import Report
    from tltlc.tools.lint.rule import Finding


@click.command(
    epilog="""\b
Examples:
  tltlc lint                            every .tltl file in this folder, and below
  tltlc lint levels/vault.tltl --fix    remove what is not needed
  tltlc lint --format github levels     remarks on a pull request
  tltlc explain TLT0412                 what a rule finds, and why

\b
`// tltlc: allow TLT0419` at the end of a line, or above it, silences a rule there; before the first declaration, in
the whole file. `[lint] allow = ["TLT0419"]` in tltl.toml silences it everywhere.
"""
)
@click.argument("paths", metavar="[FILE_OR_FOLDER]...", nargs=-1)
@click.option("--fix", "fixing", is_flag=True, help="Apply the fixes that change the meaning of nothing.")
@source_options
def command(paths: tuple[str, ...], fixing: bool, settings: Settings, format: str) -> int:  # noqa: A002
    """Report what is likely to be a mistake in specs that compile, such as goals that are met by doing nothing.

    Every warning of the compiler is among it, and without arguments the current folder is searched.  The exit status
    is 1 where there is an error or a warning, and 0 where there are notes at most.
    """
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.interfaces.cli.folders import every_source, leads_out
    from tltlc.interfaces.cli.report import Report, counted, tally
    from tltlc.tools.lint.importers import used_elsewhere, words
    from tltlc.tools.lint.neighbours import neighbours

    with Report(format) as report:
        every = every_source(paths or (".",), report)
        others = {path: words(str(path), text) for path, text in neighbours(every).items()}
        for path in every:
            try:
                mending = fixing and not leads_out(path, paths or (".",))
                if fixing and not mending:
                    report.say(f"{path} is left as it is: it is a link out of the folder")
                found = _of_file(path, used_elsewhere(path, others.values()), mending, settings, report)
            except TltlError as error:
                found = error.diagnostics
            report.add(found)
        if len(every) > 1 or not report.found:
            report.say(f"{counted(len(every), 'file')}: {tally(report.found)}")
    return report.status or _status(report.found)


def _of_file(
    path: str, elsewhere: Container[str], fixing: bool, settings: Settings, report: Report
) -> tuple[Diagnostic, ...]:
    """What is left to be said of a file, mended before where that is asked for; others may use the names elsewhere."""
    from pathlib import Path

    from tltlc.interfaces.cli.inputs import check_text
    from tltlc.io.project import project_for
    from tltlc.io.spec_file import STDIN, read
    from tltlc.io.writing import rewrite
    from tltlc.tools.lint.fixing import fix
    from tltlc.tools.lint.run import lint

    if fixing and path == STDIN:
        raise click.UsageError("`--fix` writes the file that it mends: name one", click.get_current_context())
    project = project_for(path)
    source, _ = read(path)
    check_text(source)
    check_libraries(settings.libraries)
    options = compile_settings(settings, project)
    with project.levelling():
        if not fixing:
            return _diagnostics(lint(source, options, elsewhere, project.lint))
        mended = fix(source, options, project.lint, elsewhere)
    if mended.source != source:
        rewrite(Path(path), mended.source.text)
    for each in mended.fixed:
        label = each.labels[0]
        report.say(f"fixed {label.source.name}:{label.source.position(label.span.start)[0]}: {each.title}")
    return _diagnostics(mended.left)


def _diagnostics(found: tuple[Finding, ...]) -> tuple[Diagnostic, ...]:
    return tuple(each.diagnostic for each in found)


def _status(found: Iterable[Diagnostic]) -> int:
    return exits.FINDINGS if any(each.severity != "note" for each in found) else exits.CLEAN
