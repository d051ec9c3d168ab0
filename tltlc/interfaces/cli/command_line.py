"""The command line: finds and runs a command, and turns failures into messages and exit statuses.

Each built-in command is a module of :mod:`tltlc.interfaces.cli.commands`. Other installed packages
add commands through the entry-point group ``tltlc.commands``; each entry is a click command. A
command is loaded only when the user names it.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from keyword import iskeyword
from typing import Any, Final, NoReturn

import click

from tltlc.interfaces.cli import exits, plugins
from tltlc.interfaces.cli.numbers import FiniteRange, WholeRange
from tltlc.io import resources
from tltlc.io.limits import COMMAND, ProcessLimit
from tltlc.io.resources import OutOfTimeError

BUILT_IN: Final = {
    "compile": "Compile specs to artefacts, diagrams and monitors.",
    "import": "Convert an automaton of another tool (HOA) to an artefact.",
    "check": "Report errors in specs, and what a game lacks.",
    "lint": "Report probable mistakes in specs that compile.",
    "fmt": "Format source files in one style.",
    "render": "Draw the automaton of a spec.",
    "monitor": "Judge recorded traces by a spec.",
    "test": "Run the test blocks of source files.",
    "watch": "Check, lint and test source files whenever one changes.",
    "witness": "Print traces that show what a spec means.",
    "mine": "Propose specs from recorded traces.",
    "diff": "Say how two specs differ.",
    "breaking": "Report changes that break a game or a recorded baseline.",
    "conformance": "Write test cases for the monitors of an engine.",
    "lsp": "Start a language server for editors.",
    "mcp": "Start a server for coding agents.",
    "serve": "Serve a page for trying out specs.",
    "list": "List predicates, targets, games, levels or error codes.",
    "explain": "Explain a spec or an error code.",
    "new": "Create a spec or a small game to start with.",
    "completion": "Print the completion script of a shell.",
}

BOUNDED: Final = frozenset(BUILT_IN) - {
    "compile",
    "mine",
    "monitor",
    "watch",
    "lsp",
    "mcp",
    "serve",
    "new",
    "completion",
}
"""Built-in commands whose whole run is limited by ``--max-cpu`` and ``--max-memory``.

The commands that are left out here limit only parts of their work.
"""

RUNTIME_COMMANDS: Final = {
    "demonstrate": "Let the expert of a game play, and record it.",
    "play": "Play a game with the keyboard, and record it.",
    "record": "Record demonstrations for an agent to imitate.",
    "replay": "Show recorded episodes: a summary, plans, films, signals.",
    "train": "Train an agent until it meets a spec.",
    "evaluate": "Let a trained policy play, and report how often it meets the spec.",
    "inspect": "Show what a policy was trained for, or export it as ONNX.",
    "regress": "Report which levels still play as designed, and where and why not.",
    "baseline": "Record how the policies of a suite play now.",
    "table1": "Reproduce the paper's Table I.",
}
"""The commands of the runtime (``tltl_runtime``), with their summaries for the help text.

They come with tltlc, but each needs an extra of tltlc, that is, optional dependencies. Like the
commands of other packages, they are entry points.
"""

ENTRY_POINTS: Final = "tltlc.commands"
"""The entry-point group for commands of the runtime and of other packages."""

COMPLETE_VARIABLE: Final = "_TLTLC_COMPLETE"
"""The environment variable that a shell sets to get completions instead of running the command."""


class CommandLine(click.Group):
    """The click group that contains all commands of ``tltlc``."""

    def main(self, args: Sequence[str] | None = None, *_: Any, **extra: Any) -> NoReturn:
        """Run the command and exit.

        Messages go to standard error. A traceback appears only if TLTLC_DEBUG is 1.
        """
        exits.received_signals.clear()
        for stream in (sys.stdout, sys.stderr):
            if hasattr(stream, "reconfigure"):
                # A terminal that cannot show ∧ gets an escape sequence instead of a crash.
                stream.reconfigure(errors="backslashreplace")
        # `obj` is True if the arguments come from the process. Then it runs only this command, and
        # limits may apply to the whole process.
        extra.update(obj=args is None, prog_name="tltlc", complete_var=COMPLETE_VARIABLE, standalone_mode=False)
        try:
            status = super().main(None if args is None else list(args), **extra) or 0
            sys.stdout.flush()
        except (Exception, OutOfTimeError) as error:
            status = exits.report(_completion_error(error))
        exits.flush()
        sys.exit(status)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse like click, but accept the argument ``-:NAME``, which means the spec NAME in standard input.

        Without arguments, print the help and exit with the status for wrong usage.
        """
        if not args and not ctx.resilient_parsing:
            click.echo(ctx.get_help(), err=True)
            raise exits.StopQuietlyError(exits.USAGE)
        if any(text.startswith("-:") for text in args):
            # click would parse such an argument as short options.
            from tltlc.io.spec_file import STDIN_NAME

            args = [f"{STDIN_NAME}{text[1:]}" if text.startswith("-:") else text for text in args]
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command, and record the files that it reads, so that it cannot overwrite them.

        If the reader of the output closes the pipe, or the user presses Ctrl-C, raise
        StopQuietlyError with the exit status that :mod:`tltlc.interfaces.cli.exits` defines for it.
        """
        from tltlc.io.access_log import access_log

        try:
            with access_log():
                return super().invoke(ctx)
        except click.UsageError as error:
            if error.ctx is None and ctx.invoked_subcommand is not None:
                # click's option parser does not know for which command it parses.
                command = self.get_command(ctx, ctx.invoked_subcommand)
                if command is not None:
                    error.ctx = click.Context(command, parent=ctx, info_name=ctx.invoked_subcommand)
            raise
        except BrokenPipeError:
            raise exits.StopQuietlyError(exits.CLOSED_PIPE) from None
        except KeyboardInterrupt:
            raise exits.StopQuietlyError(exits.interrupted_status()) from None

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands: the built-in ones, then those from entry points, sorted."""
        return [*BUILT_IN, *sorted(plugin.name for plugin in plugins.find(ENTRY_POINTS) if plugin.name not in BUILT_IN)]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Load and return the command with this name; None if there is no such command."""
        if cmd_name in BUILT_IN:
            from importlib import import_module

            # A module cannot be named like a Python keyword.
            module = f"tltlc.interfaces.cli.commands.{cmd_name}{'_' if iskeyword(cmd_name) else ''}"
            command: click.Command = import_module(module).command
            return command
        for plugin in plugins.find(ENTRY_POINTS):
            if plugin.name == cmd_name:
                loaded: click.Command = plugins.load(plugin, f"`tltlc {plugin.name}`")
                return loaded
        return None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Resolve like click; if there is no such command, raise a usage error that suggests a similar name."""
        if args[0].startswith("-") or self.get_command(ctx, args[0]):
            return super().resolve_command(ctx, args)
        from difflib import get_close_matches

        close = get_close_matches(args[0], self.list_commands(ctx), n=1)
        raise click.UsageError(
            f"There is no command `{args[0]}`." + (f" Did you mean `{close[0]}`?" if close else ""), ctx
        )

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the names and summaries of all commands into the help text, without loading a command.

        The commands are those in :data:`BUILT_IN`, and the entry points of installed packages.
        """
        rows = list(BUILT_IN.items())
        for plugin in sorted(plugins.find(ENTRY_POINTS), key=lambda plugin: plugin.name):
            if plugin.name not in BUILT_IN:
                summary = RUNTIME_COMMANDS.get(
                    plugin.name, f"A command of {plugin.module}, from {plugin.distribution}."
                )
                extra = f" (needs the extra {', '.join(plugin.extras)})" if plugin.extras else ""
                rows.append((plugin.name, f"{summary[:-1]}{extra}."))
        with formatter.section("Commands"):
            formatter.write_dl(rows)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[Any]:
        """Return the commands whose names begin with ``incomplete``, and click's other completions.

        No command is loaded.
        """
        from click.shell_completion import CompletionItem

        names = [CompletionItem(name, help=BUILT_IN.get(name)) for name in self.list_commands(ctx)]
        return [item for item in names if item.value.startswith(incomplete)] + click.Command.shell_complete(
            self, ctx, incomplete
        )


def _completion_error(error: Exception | OutOfTimeError) -> Exception | OutOfTimeError:
    """Return a usage error if ``error`` comes from a wrong use of shell completion; otherwise ``error`` itself.

    Only the scripts of ``tltlc completion`` should set :data:`COMPLETE_VARIABLE`. They also set the
    other variables that click needs. If a user sets it alone, click raises a KeyError or ValueError.
    """
    if os.environ.get(COMPLETE_VARIABLE) and isinstance(error, (KeyError, ValueError)):
        return click.UsageError(f"{COMPLETE_VARIABLE} is for the scripts that `tltlc completion` prints: unset it")
    return error


def _version(ctx: click.Context, _: click.Parameter, is_given: bool) -> None:
    if is_given and not ctx.resilient_parsing:
        from tltlc import __version__

        click.echo(f"tltlc {__version__}")
        ctx.exit()


_HELP: Final = """\
Find out whether a game still plays as designed.

A spec has the rules of a level: what the player must do, and what must not happen. tltlc judges recorded play by it,
trains agents that meet it, reports what no longer plays as before, and writes monitors for engines.

\b
Start here:
  tltlc new my_hall --game python    a small game for agents; also `godot`, `web` …
  tltlc new my_game                  a spec and a recorded trace, without a game
  tltlc serve --open                 a page for trying out specs

\b
With a game:
  tltlc check --game hall.game.toml  does the game have what the spec needs?
  tltlc train --game hall.game.toml  an agent learns to meet the spec
  tltlc baseline suite.toml          record how agents play now
  tltlc regress suite.toml           do they still play like that?
"""


@click.group(
    cls=CommandLine,
    help=_HELP,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="`tltlc COMMAND --help` shows the options of a command, with examples.",
)
@click.option(
    "--version", is_flag=True, is_eager=True, expose_value=False, callback=_version, help="Show the version and exit."
)
@click.option(
    "--max-cpu",
    type=WholeRange(min=0, max=10**9),
    metavar="SECONDS",
    default=COMMAND.work_s,
    show_default=True,
    help="Stop a command after this much processor time; 0 means no limit.",
)
@click.option(
    "--max-memory",
    type=FiniteRange(min=0, max=2**20),
    metavar="GIB",
    default=COMMAND.memory / 2**30,
    show_default=True,
    help="Stop a command that needs more memory than this; 0 means no limit.",
)
@click.pass_context
def cli(ctx: click.Context, max_cpu: int, max_memory: float) -> None:
    """Find out whether a game still plays as designed: judge play, train agents, report what has changed."""
    if ctx.obj:
        resources.permit(ProcessLimit(memory=int(max_memory * 2**30), work_s=max_cpu))
    if ctx.invoked_subcommand in BOUNDED:
        ctx.with_resource(resources.resource_limits())


if os.environ.get("TLTLC_DEBUG") == "1":
    import faulthandler

    # Show where a crash or a hang below Python happens.
    faulthandler.enable()
