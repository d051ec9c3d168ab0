"""Turn exceptions of a game's code into diagnostics that point to the line in the user's files."""

from __future__ import annotations

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from tltl_runtime.gymnasium_games.game_file import GameFile
from tltl_runtime.support.path_text import path_text
from tltlc.api import Diagnostic, Label, Span, TltlError, fileio

CANNOT_START: Final = "TLT0780"
RAISES: Final = "TLT0781"

_LONGEST: Final = 200
"""A message quotes at most this many characters of an exception."""


@contextmanager
def guarded(
    game: GameFile, code: str, what: str, label: Label, unless: tuple[type[Exception], ...] = ()
) -> Iterator[None]:
    """Turn an exception of the game's code in the ``with`` block into a TltlError.

    The error has the code ``code``. ``what`` is the subject of its message, for example "the game's
    `step`". Its label is the innermost line in the game's folder that took part in the exception; if there
    is none, ``label``, a place in the game file. A TltlError is raised unchanged, and so is an exception of
    a type in ``unless``.
    """
    try:
        yield
    except Exception as error:
        if isinstance(error, (TltlError, *unless)):
            raise
        raise TltlError([raised(game, code, what, error, label)]) from error


def raised(game: GameFile, code: str, what: str, error: BaseException, label: Label) -> Diagnostic:
    """Return the diagnostic for an exception; the arguments are those of :func:`guarded`."""
    place, elsewhere = _place(game.folder.resolve(), error)
    title = f"{what} raises {exception_text(error)}"
    help_ = "correct what the label points to"
    if elsewhere:
        help_ += f"; the exception comes from {elsewhere}"
    return Diagnostic(code, title, (place or label,), help_)


def exception_text(error: BaseException) -> str:
    """Return the type of an exception and the first line of its message: ``ValueError: no such map``."""
    message = next((line.strip() for line in str(error).splitlines() if line.strip()), "")
    text = f"{type(error).__name__}: {message}" if message else type(error).__name__
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def _place(folder: Path, error: BaseException) -> tuple[Label | None, str]:
    """Return the label of the innermost line in ``folder`` that took part in an exception; None without one.

    Also return where the exception was raised, as text; empty if that is the labelled line.
    """
    frames = [(Path(frame.filename), frame.lineno or 1) for frame in traceback.extract_tb(error.__traceback__)]
    if isinstance(error, SyntaxError) and error.filename:
        frames.append((Path(error.filename), error.lineno or 1))
    if not frames:
        return None, ""
    innermost = frames[-1]
    for path, line in reversed(frames):
        label = _line_label(path, line) if _is_inside(path, folder) else None
        if label is not None:
            is_innermost = (path, line) == innermost
            return label, "" if is_innermost else _frame_text(*innermost)
    return None, _frame_text(*innermost)


def _is_inside(path: Path, folder: Path) -> bool:
    try:
        return path.resolve().is_relative_to(folder)
    except (OSError, RuntimeError, ValueError):
        return False


def _line_label(path: Path, line: int) -> Label | None:
    """Return the label of a line, without its indentation; None if the file cannot be read."""
    try:
        source = fileio.read_source(path, path_text(path))
    except TltlError:
        return None
    lines = source.text.split("\n")
    if not 1 <= line <= len(lines):
        return Label(source, Span(0, 0))
    start = sum(len(text) + 1 for text in lines[: line - 1])
    text = lines[line - 1].rstrip()
    return Label(source, Span(start + len(text) - len(text.lstrip()), start + len(text)))


def _frame_text(path: Path, line: int) -> str:
    return f"`{path_text(path)}`, line {line}"
