"""The lines of a game's standard error that say what is wrong, without those that say nothing about the game."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator
from itertools import chain, groupby
from typing import Final

_NOISE: Final = re.compile(
    r"""XDG_RUNTIME_DIR
    | ^ALSA\ lib | ^AL\ lib: | ^\[ALSOFT\] | \ At:\ (?:drivers|servers)/\S*audio
    | setlocale: | Setting\ locale\ failed | Locale\ not\ supported
    | ^ERROR:\ (?:get_language_code|set_locale):
    | ^WARNING:\ .*ObjectDB\ instances\ leaked | ^ERROR:\ .*[Rr]esources\ still\ in\ use\ at\ exit
    """,
    re.VERBOSE,
)
"""What systems without a screen, sound or language write, and what Godot writes about its own memory when it ends."""

_SCRIPT_ERROR: Final = re.compile(r"^SCRIPT ERROR: |^Uncaught ")
"""How Godot, and the browsers that open a page, begin a message about an error in a script of the game."""

_UNREADABLE: Final = re.compile(r"^SCRIPT ERROR: .*Parse Error|^Uncaught SyntaxError")
"""How they begin the message about a script that they cannot read, and go on without."""

_ENGINE_PLACE: Final = re.compile(r"\.(?:cpp|h|mm):\d+\b")
_OWN_MESSAGE: Final = re.compile(r"push_error|push_warning|^USER ")
"""What a script of Godot has written itself, although the place is in the engine."""

_MOST_SCRIPT_ERRORS: Final = 3
_REPEATED: Final = "   (several times in a row)"

_Message = tuple[str, ...]


def telling_lines(lines: Iterable[str], most: int) -> list[str]:
    """Return at most ``most`` of the lines that a game wrote: those that help to mend it.

    The first errors in scripts come first, then the last of the other lines. An indented line belongs to the one
    before it. Known noise is left out. So is an error of the engine if there is an error in a script, because it
    follows from that. A message that comes several times in a row is there once.
    """
    messages = [*_once(_messages(lines))]
    errors = [*dict.fromkeys(filter(_is_script_error, messages))][:_MOST_SCRIPT_ERRORS]
    others = [message for message in messages if not _is_script_error(message)]
    if errors:
        # The first message may have lost its beginning.
        others = [message for message in others if not _is_of_engine(message) and not message[0][:1].isspace()]
    first, rest = [*chain(*errors)][:most], [*chain(*others)]
    return [*first, *rest[max(len(rest) + len(first) - most, 0) :]]


def script_error(lines: Iterable[str]) -> str:
    """Return the first message about an error in a script of the game, in one line; empty if there is none."""
    return _in_one_line(next(filter(_is_script_error, _messages(lines)), ()))


def last_message(lines: Iterable[str]) -> str:
    """Return the last message that is no noise, in one line; empty if there is none."""
    return _in_one_line(next(iter(deque(_messages(lines), maxlen=1)), ()))


def has_unreadable_script(lines: Iterable[str]) -> bool:
    """Whether the game's engine says that it cannot read one of the game's scripts."""
    return any(map(_UNREADABLE.search, lines))


def _in_one_line(message: _Message) -> str:
    return " ".join(line.strip() for line in message if line != _REPEATED)


def _messages(lines: Iterable[str]) -> Iterator[_Message]:
    """Yield each message that is no noise: a line with the indented lines after it."""
    message: list[str] = []
    for line in chain(lines, [""]):
        if message and not line[:1].isspace():
            if not any(map(_NOISE.search, message)):
                yield tuple(message)
            message = []
        message.append(line)


def _once(messages: Iterable[_Message]) -> Iterator[_Message]:
    for message, equal in groupby(messages):
        yield (*message, _REPEATED) if sum(1 for _ in equal) > 1 else message


def _is_script_error(message: _Message) -> bool:
    return bool(_SCRIPT_ERROR.search(message[0]))


def _is_of_engine(message: _Message) -> bool:
    return not _OWN_MESSAGE.search(message[0]) and any(map(_ENGINE_PLACE.search, message))
