"""``tltlc check``: report every error and warning of compiling, and write nothing.

With a level, also report whether the specs fit the level.
"""

from __future__ import annotations

from typing import Any, Final

import click

from tltlc.interfaces.cli import plugins
from tltlc.interfaces.cli.settings import CompileSettings, source_options

LEVELS: Final = "tltlc.levels"
"""The key in ``Context.meta`` under which the click command that checks levels is stored.

Its options join those of ``check --level``. Its callback receives ``levels`` (as on the command
line), ``inputs`` (the compiled arguments), ``settings``, the ``report``, and the values of its
options.
"""


class CheckCommand(click.Command):
    """The command ``check``; it has the options for levels only if ``--level`` is given."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse like click; if a level is given, also parse the options for levels."""
        if not ctx.resilient_parsing and any(text.partition("=")[0] == "--level" for text in args):
            ctx.meta[LEVELS] = plugins.load_levels_plugin("check", "`tltlc check --level`")
        return super().parse_args(ctx, args)

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """Return the options of the command; the options for levels come before ``--help``."""
        *own, help_ = super().get_params(ctx)
        levels = ctx.meta.get(LEVELS)
        return [*own, *(levels.params if levels else ()), help_]


@click.command(
    cls=CheckCommand,
    epilog="""\b
Examples:
  tltlc check                                    all .tltl files in this folder and its subfolders
  tltlc check cover_and_hide.tltl
  tltlc check levels                             another folder
  tltlc check --format github levels             annotations on a pull request
  tltlc check --format sarif levels > tltlc.sarif
  tltlc check cover_and_hide.tltl --level vault.toml
  tltlc check --level navigation:v1              a level against its own spec
  tltlc check --level all --help                 more options for levels
""",
)
@click.argument("specs", metavar="[SPEC_OR_FOLDER]...", nargs=-1)
@click.option(
    "--level",
    "levels",
    metavar="LEVEL[:VARIANT]",
    multiple=True,
    help="Check that this level has everything the specs use (repeatable). LEVEL is a .toml file, the name of a level "
    "that comes with tltlc, or `all` for all of these. Without VARIANT, all variants are checked.",
)
@source_options
def command(
    specs: tuple[str, ...],
    levels: tuple[str, ...],
    settings: CompileSettings,
    format: str,  # noqa: A002
    **options: Any,
) -> int:
    """Report all errors and warnings of each SPEC (a file, FILE:NAME, an artefact, or - for standard input).

    In a folder, all .tltl files are checked, also those in subfolders. The default is the current folder.
    With --level, the command also reports what a spec needs and the level lacks, and what nobody can reach there;
    without SPEC, it uses the spec of the level. The exit status is 1 if there is an error, and 0 otherwise.
    """
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.interfaces.cli.folders import every_source
    from tltlc.interfaces.cli.inputs import open_input
    from tltlc.interfaces.cli.report import Report, count_text, tally
    from tltlc.io.spec_file import split

    context = click.get_current_context()
    specs = specs or (() if levels else (".",))
    inputs = []
    with Report(format) as report:
        paths = every_source(specs, report)
        for spec in paths:
            try:
                spec_input = open_input(spec, settings)
            except TltlError as error:
                report.add(error.diagnostics)
                continue
            report.add(spec_input.diagnostics)
            if levels:
                inputs.append(spec_input)
            if spec in specs and not spec_input.diagnostics:
                report.say(f"{spec_input.name}: {count_text(len(spec_input.automata), 'spec')}, nothing to report")
        if len(paths) > 1 or not set(paths).issubset(specs):
            report.say(f"{count_text(len({split(path)[0] for path in paths}), 'file')}: {tally(report.diagnostics)}")
        if levels and (inputs or not specs):
            context.meta[LEVELS].callback(levels=levels, inputs=inputs, settings=settings, report=report, **options)
    return report.status
