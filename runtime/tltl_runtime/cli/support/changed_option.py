"""The option ``--changed``, which takes every word up to the next option."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import click

_OPTION: Final = "--changed"


class ChangedCommand(click.Command):
    """A command whose option ``--changed``, declared with ``multiple``, takes any number of words.

    So it takes what ``$(git diff --name-only)`` stands for, which may be nothing: its first value is then empty, which
    tells it from an option that is not there.
    """

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the arguments of the command."""
        return super().parse_args(ctx, list(_one_by_one(args)))


def _one_by_one(words: Sequence[str]) -> Iterator[str]:
    """The words, with the option before each one that it takes."""
    taking = False
    for number, word in enumerate(words):
        if word == "--":
            yield from words[number:]
            return
        if word.startswith("-") and word != "-":
            taking = word == _OPTION
            yield f"{_OPTION}=" if taking else word
        else:
            yield f"{_OPTION}={word}" if taking else word
