"""``tltlc lint``: report probable mistakes in specs that compile, and fix some of them."""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import TYPE_CHECKING

import click

from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.settings import CompileSettings, check_libraries, compile_settings, source_options

if TYPE_CHECKING:
    from tltlc.diagnostics.diagnostic import Diagnostic
    from tltlc.interfaces.cli.report import Report
    from tltlc.tools.lint.rule import LintFinding


@click.command(
    epilog="""\b
Examples:
  tltlc lint                            all .tltl files in this folder and its subfolders
  tltlc lint levels/vault.tltl --fix    apply the safe fixes
  tltlc lint --format github levels     annotations on a pull request
  tltlc explain TLT0412                 what a rule reports, and why

\b
`// tltlc: allow TLT0419` at the end of a line, or above it, silences a rule there; before the first declaration, in
the whole file. `[lint] allow = ["TLT0419"]` in tltl.toml silences it everywhere.
"""
)
@click.argument("paths", metavar="[FILE_OR_FOLDER]...", nargs=-1)
@click.option("--fix", "fixing", is_flag=True, help="Apply the fixes that keep the meaning of every spec.")
@source_options
def command(paths: tuple[str, ...], fixing: bool, settings: CompileSettings, format: str) -> int:  # noqa: A002
    """Report probable mistakes in specs that compile, such as a goal that is met by doing nothing.

    The output includes all warnings of the compiler. Without arguments, the command reads the current folder. The exit
    status is 1 if there is an error or a warning, and 0 otherwise.
    """
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.interfaces.cli.folders import every_source, links_outside
    from tltlc.interfaces.cli.report import Report, count_text, tally
    from tltlc.tools.lint.importers import importer_names, names_used_elsewhere
    from tltlc.tools.lint.joining import joined
    from tltlc.tools.lint.neighbours import neighbours

    with Report(format) as report:
        files = every_source(paths or (".",), report)
        neighbour_words = {path: importer_names(str(path), text) for path, text in neighbours(files).items()}
        for path in files:
            try:
                can_fix = fixing and not links_outside(path, paths or (".",))
                if fixing and not can_fix:
                    report.say(f"{path} was not changed: it is a link to a file outside the folder")
                diagnostics = _lint_file(
                    path, names_used_elsewhere(path, neighbour_words.values()), can_fix, settings, report
                )
            except TltlError as error:
                diagnostics = error.diagnostics
            report.add(joined(diagnostics) if format == "text" else diagnostics)
        if len(files) > 1 or not report.diagnostics:
            report.say(f"{count_text(len(files), 'file')}: {tally(report.diagnostics)}")
    return report.status or _status(report.diagnostics)


def _lint_file(
    path: str, elsewhere: Container[str], fixing: bool, settings: CompileSettings, report: Report
) -> tuple[Diagnostic, ...]:
    """Lint a file, after fixing it if ``fixing``; return the remaining diagnostics.

    ``elsewhere`` contains the names that other files may use, so their declarations are not
    reported as unused. Each fix is reported to ``report``. Raises TltlError if the file has errors.
    """
    from pathlib import Path

    from tltlc.interfaces.cli.inputs import check_text
    from tltlc.io.project import project_for
    from tltlc.io.spec_file import STDIN, read
    from tltlc.io.writing import rewrite
    from tltlc.tools.lint.fix_application import fix
    from tltlc.tools.lint.run import lint

    if fixing and path == STDIN:
        raise click.UsageError("`--fix` cannot change standard input: name a file", click.get_current_context())
    project = project_for(path)
    source, _ = read(path)
    check_text(source)
    check_libraries(settings.libraries)
    options = compile_settings(settings, project)
    with project.apply_lint_levels():
        if not fixing:
            return _diagnostics(lint(source, options, elsewhere, project.lint))
        fixes = fix(source, options, project.lint, elsewhere)
    if fixes.source != source:
        rewrite(Path(path), fixes.source.text)
    for diagnostic in fixes.fixed:
        label = diagnostic.labels[0]
        report.say(f"fixed {label.source.name}:{label.source.position(label.span.start)[0]}: {diagnostic.title}")
    return _diagnostics(fixes.remaining)


def _diagnostics(findings: tuple[LintFinding, ...]) -> tuple[Diagnostic, ...]:
    return tuple(finding.diagnostic for finding in findings)


def _status(diagnostics: Iterable[Diagnostic]) -> int:
    return exits.FINDINGS if any(diagnostic.severity != "note" for diagnostic in diagnostics) else exits.CLEAN
