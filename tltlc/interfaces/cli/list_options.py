"""Options that take a list of values, such as the files that a shell makes of ``bad/*.csv``."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

import click


class ListOption(click.Option):
    """A repeatable option that takes all arguments up to the next option.

    ``--option=VALUE`` takes one value, and ``--`` ends the list. The option belongs to a
    :class:`ListOptionCommand`.
    """


class ListOptionCommand(click.Command):
    """A click command that may have options of the class :class:`ListOption`."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse like click, after each value of a list option has got a flag of its own.

        Raises click.UsageError: a list option has no value, or has taken all arguments, so that none is left for
        the command.
        """
        flags = [flag for option in self.params if isinstance(option, ListOption) for flag in option.opts]
        try:
            return super().parse_args(ctx, [*_one_value_each(args, flags)])
        except click.MissingParameter as error:
            given = [flag for flag in flags if flag in args]
            if not given or not isinstance(error.param, click.Argument):
                raise
            name = (error.param.metavar or error.param.human_readable_name).removesuffix("...")
            raise click.UsageError(
                f"there are no {name}: {given[0]} takes all names after it. Write the {name} before {given[0]}, or "
                "after `--`",
                ctx,
            ) from None


def _one_value_each(arguments: Sequence[str], flags: Collection[str]) -> Iterator[str]:
    """Yield the arguments, with the flag of a list option before each value of its list.

    Raises click.BadOptionUsage: a list option has no value.
    """
    flag = ""
    for number, argument in enumerate(arguments):
        if argument == "--":
            yield from arguments[number:]
            return
        if _is_option(argument):
            flag = argument if argument in flags else ""
            if not flag:
                yield argument
            elif number + 1 == len(arguments) or _is_option(arguments[number + 1]):
                raise click.BadOptionUsage(flag, f"option '{flag}' requires an argument")
        else:
            if flag:
                yield flag
            yield argument


def _is_option(argument: str) -> bool:
    return argument.startswith("-") and argument != "-"
