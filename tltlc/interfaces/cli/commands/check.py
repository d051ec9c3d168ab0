"""``tltlc check``: report every error and warning of the compiler and the linter, and write nothing.

With a level or a game, also report whether the specs fit it.
"""

from __future__ import annotations

from typing import Any, Final

import click

from tltlc.interfaces.cli import plugins
from tltlc.interfaces.cli.settings import CompileSettings, source_options

CHECKS: Final = {"--level": "tltlc.levels", "--game": "tltlc.games"}
"""Maps an option of ``tltlc check`` to the entry-point group whose entry ``check`` does the work for it.

The entry is a click command. It is stored in ``Context.meta`` under the name of the group, and its
options join those of ``tltlc check``. Its callback receives ``levels`` or ``games`` (as on the
command line), ``inputs`` (the compiled arguments), ``settings``, the ``report``, and the values of
the entry's own options.
"""


class CheckCommand(click.Command):
    """The command ``check``; it has further options if ``--level`` or ``--game`` is given."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse like click; if a level or a game is given, first load the further options for it."""
        for option, group in CHECKS.items():
            if not ctx.resilient_parsing and any(text.partition("=")[0] == option for text in args):
                ctx.meta[group] = plugins.load_from(group, "check", f"`tltlc check {option}`")
        return super().parse_args(ctx, args)

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """Return the parameters of the command; the further options for levels and games come before ``--help``."""
        *own, help_ = super().get_params(ctx)
        more = [ctx.meta[group].params for group in CHECKS.values() if group in ctx.meta]
        return [*own, *(param for params in more for param in params), help_]


@click.command(
    cls=CheckCommand,
    epilog="""\b
Examples:
  tltlc check                                    all .tltl files in this folder and its subfolders
  tltlc check leave.tltl
  tltlc check levels                             another folder
  tltlc check --format github levels             annotations on a pull request
  tltlc check --format sarif levels > tltlc.sarif
  tltlc check --game lake.game.toml              all scenes of a game, each against its own spec
  tltlc check lake.tltl --game lake.game.toml:small
  tltlc check vault.tltl --level vault.toml      a level of the stealth game that comes with tltlc
  tltlc check --level all --help                 more options for such levels
""",
)
@click.argument("specs", metavar="[SPEC_OR_FOLDER]...", nargs=-1)
@click.option(
    "--level",
    "levels",
    metavar="LEVEL[:VARIANT]",
    multiple=True,
    help="Check that this level of the stealth game has everything the specs use (repeatable). LEVEL is a .toml file, "
    "the name of a level that comes with tltlc, or `all` for all of these. Without VARIANT, all variants are checked.",
)
@click.option(
    "--game",
    "games",
    metavar="FILE.game.toml[:SCENE[:VARIANT]]",
    multiple=True,
    help="Play this game, and check that it has everything the specs use (repeatable). Without SCENE, all scenes are "
    "checked, and without VARIANT, all variants. The command runs the Python code that the file names.",
)
@source_options
def command(
    specs: tuple[str, ...],
    levels: tuple[str, ...],
    games: tuple[str, ...],
    settings: CompileSettings,
    format: str,  # noqa: A002
    **options: Any,
) -> int:
    """Report all errors and warnings of each SPEC (a file, FILE:NAME, an artefact, or - for standard input).

    These include the probable mistakes in specs that `tltlc lint` finds, but not its advice about training, sizes and
    what is unused.
    In a folder, all .tltl files are checked, also those in subfolders. The default is the current folder.
    With --game, the command also plays each scene of a game twice, and reports what the game offers, how fast it is,
    and whether equal seeds and actions give equal plays. With --level, it also reports what a spec needs but a level of
    the stealth game does not have, and what no player can reach there. Without SPEC, both use the specs of the scenes
    or levels. The exit status is 1 if there is an error, and 0 otherwise.
    """
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.interfaces.cli.folders import every_source
    from tltlc.interfaces.cli.inputs import open_input
    from tltlc.interfaces.cli.lint_findings import diagnostics_of
    from tltlc.interfaces.cli.report import Report, count_text, tally
    from tltlc.io.spec_file import split
    from tltlc.tools.lint.joining import joined

    context = click.get_current_context()
    places = {"--level": levels, "--game": games}
    specs = specs or (() if levels or games else (".",))
    inputs = []
    with Report(format) as report:
        paths = every_source(specs, report)
        for spec in paths:
            try:
                spec_input = open_input(spec, settings)
            except TltlError as error:
                report.add(error.diagnostics)
                continue
            diagnostics = diagnostics_of(spec_input, split(spec)[1])
            report.add(joined(diagnostics) if format == "text" else diagnostics)
            if levels or games:
                inputs.append(spec_input)
            if spec in specs and not diagnostics:
                report.say(f"{spec_input.name}: {count_text(len(spec_input.automata), 'spec')}, nothing to report")
        if len(paths) > 1 or not set(paths).issubset(specs):
            report.say(f"{count_text(len({split(path)[0] for path in paths}), 'file')}: {tally(report.diagnostics)}")
        for option, given in places.items():
            if given and (inputs or not specs):
                check = context.meta[CHECKS[option]]
                own = {str(param.name): options[str(param.name)] for param in check.params}
                place = {f"{option.removeprefix('--')}s": given}
                check.callback(**place, inputs=inputs, settings=settings, report=report, **own)
    return report.status
