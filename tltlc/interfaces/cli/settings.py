"""The options that all commands on source files have, and their combination with the project file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from tltlc.core.record import EMPTY, record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.diagnostics.render import FORMATS
from tltlc.interfaces.cli.numbers import WholeRange
from tltlc.io.files import is_dir

if TYPE_CHECKING:
    from tltlc.io.project import Project
    from tltlc.pipeline import CompileOptions

CommandFunction = TypeVar("CommandFunction", bound=Callable[..., Any])


@record
class CompileSettings:
    """The options of the command line for compiling.

    ``libraries`` are folders that are searched before the libraries of the project file. ``params``
    maps names of params to new values, as texts: ``{"level_size": "30 m"}``. ``state_budget`` is the
    most states that an automaton may have; None for the default.
    """

    libraries: tuple[Path, ...] = ()
    params: Mapping[str, str] = EMPTY
    state_budget: int | None = None


def source_options(command: CommandFunction) -> CommandFunction:
    """Add the options ``--library --param --state-budget --format`` to a command.

    The command receives the first three as ``settings`` (:class:`CompileSettings`), and ``format``.
    """
    return compile_options(format_option(command))


def compile_options(command: CommandFunction) -> CommandFunction:
    """Add the options ``--library --param --state-budget`` to a command.

    The command receives them as ``settings`` (:class:`CompileSettings`).
    """
    from functools import wraps

    @wraps(command)
    def with_settings(
        *args: Any, library: tuple[Path, ...], param: tuple[str, ...], state_budget: int | None, **rest: Any
    ) -> Any:
        params = parse_assignments(param, "NAME=VALUE", "--param")
        return command(*args, settings=CompileSettings(library, params, state_budget), **rest)

    for option in reversed(
        (
            click.option(
                "--library",
                "-L",
                metavar="DIR",
                type=click.Path(path_type=Path, readable=False),
                multiple=True,
                help="Search this folder for imports, too (repeatable).",
            ),
            click.option(
                "--param",
                "-p",
                metavar="NAME=VALUE",
                multiple=True,
                help="Set a param, e.g. `level_size=30 m` (repeatable).",
            ),
            click.option(
                "--state-budget",
                metavar="N",
                type=WholeRange(min=1),
                help="Stop with an error if an automaton needs more than N states. The limit on work grows with N "
                "(default: 50000).",
            ),
        )
    ):
        with_settings = option(with_settings)
    return with_settings  # type: ignore[return-value]


format_option = click.option(
    "--format",
    type=click.Choice(FORMATS),
    default="text",
    help="The format of errors and warnings (default: text).",
)


def compile_settings(settings: CompileSettings, project: Project, specs: tuple[str, ...] = ()) -> CompileOptions:
    """Return the compiler's options, which combine the command line (``settings``) and the project file.

    ``specs`` has the names of the specs to compile; if it is empty, all are compiled.
    """
    from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
    from tltlc.pipeline import CompileOptions

    return CompileOptions(
        library_dirs=(*settings.libraries, *project.libraries),
        params=settings.params,
        state_budget=settings.state_budget or DEFAULT_STATE_BUDGET,
        specs=specs,
    )


def search_steps(settings: CompileSettings) -> int:
    """Return how many steps of work a search in automata may take, for example for a shortest trace.

    The number grows with the state budget. Building an automaton over infinite traces may take as
    many steps.
    """
    from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
    from tltlc.automaton.work import STEPS_PER_STATE

    return STEPS_PER_STATE * (settings.state_budget or DEFAULT_STATE_BUDGET)


def check_libraries(libraries: tuple[Path, ...]) -> None:
    """Raise TLT0001 for a library folder that does not exist or is not a folder."""
    for folder in libraries:
        if not is_dir(folder):
            title = f"there is no library folder `{folder}`"
            raise TltlError([Diagnostic("TLT0001", title, help="name a folder that exists")])


def parse_assignments(texts: tuple[str, ...], form: str, option: str) -> dict[str, str]:
    """Parse texts of the form ``NAME=VALUE``, and return the values by name.

    Raise click.BadParameter for a text of another form, or for a name that is set twice. ``form``
    and ``option`` are how the message names the form and the option, such as ``AP=PREDICATE`` and
    ``--atom``.
    """
    values: dict[str, str] = {}
    for text in texts:
        name, equals, value = map(str.strip, text.partition("="))
        if not equals or not name or not value:
            raise click.BadParameter(f"`{text}` is not of the form {form}", param_hint=option)
        if name in values:
            raise click.BadParameter(f"`{name}` is set twice", param_hint=option)
        values[name] = value
    return values
