"""The option ``--changed``, which takes every word up to the next option."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import click

_OPTION: Final = "--changed"


class ChangedCommand(click.Command):
    """A command whose option ``--changed``, declared with ``multiple``, takes any number of words.

    So it accepts the output of ``$(git diff --name-only)``, which may be empty. If the option is
    given, its first value is an empty string. This distinguishes an option without words from a
    missing option.
    """

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the arguments of the command, with any number of words after ``--changed``."""
        return super().parse_args(ctx, list(_with_repeated_option(args)))


def _with_repeated_option(words: Sequence[str]) -> Iterator[str]:
    """Yield the words of a command line, with ``--changed`` repeated before each of its values.

    For example, ``--changed a b`` becomes ``--changed= --changed=a --changed=b``.
    """
    is_value = False
    for index, word in enumerate(words):
        if word == "--":
            yield from words[index:]
            return
        if word.startswith("-") and word != "-":
            is_value = word == _OPTION
            yield f"{_OPTION}=" if is_value else word
        else:
            yield f"{_OPTION}={word}" if is_value else word
