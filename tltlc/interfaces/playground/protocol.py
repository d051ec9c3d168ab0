"""What the page asks and is answered, as JSON: the same by the server and in the browser alone."""

from __future__ import annotations

import json
from typing import Any, Final, get_args

from tltlc.backends import Notation
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.interfaces.playground.page_config import start
from tltlc.interfaces.playground.page_data import diagnostic, view
from tltlc.interfaces.playground.trace import Letter
from tltlc.io.json_text import loads
from tltlc.io.limits import ANSWER, MESSAGE

MOST_LETTERS: Final = 1_000
TOO_LARGE: Final = "this takes more memory than the playground has"


class RequestError(ValueError):
    """What was asked is no request."""


@record
class Question:
    """What the page asks about a text; ``spec``, ``letters`` and ``notation`` are those of :func:`view`."""

    text: str
    spec: str
    letters: tuple[Letter, ...]
    notation: Notation


def answer(request: str) -> str:
    """The answer to a request: what :func:`start` or :func:`view` returns.

    Raises RequestError for anything else than such a request.
    """
    asked = question(request)
    if asked is None:
        return _json(start())
    try:
        return _json(view(asked.text, asked.spec, asked.letters, asked.notation))
    except (MemoryError, RecursionError):
        return gave_up(TOO_LARGE)
    except Exception:
        # Whoever types has no use for a traceback, and can go on typing.
        return gave_up("a bug in tltlc stopped this", "please report it, with the text")


def question(request: str) -> Question | None:
    """What a request asks by its keys ``text``, ``spec``, ``letters``, ``notation``; None where it asks how to start.

    Raises RequestError for anything else than such a request.
    """
    try:
        asked = loads(request, MESSAGE)
    except (ValueError, RecursionError) as error:
        raise RequestError("a request is JSON") from error
    if asked == {}:
        return None
    if not isinstance(asked, dict) or not isinstance(asked.get("text"), str):
        raise RequestError("a request has a `text`")
    spec, letters = asked.get("spec", ""), asked.get("letters", [])
    if not isinstance(spec, str) or not isinstance(letters, list) or len(letters) > MOST_LETTERS:
        raise RequestError(f"`spec` is a name, and `letters` a list of at most {MOST_LETTERS}")
    notation = asked.get("notation", "english")
    if notation not in get_args(Notation):
        raise RequestError(f"`notation` is one of {', '.join(get_args(Notation))}")
    if not all(map(_is_letter, letters)):
        raise RequestError("a letter is a list of atoms, or an object of numbers by the names of signals")
    return Question(asked["text"], spec, tuple(letters), notation)


def gave_up(why: str, way_out: str = "make the spec smaller: bounds and large conjunctions cost most") -> str:
    """The answer where nothing can be said of a text: TLT0775, and why."""
    said = Diagnostic("TLT0775", why, help=way_out)
    return _json({"diagnostics": [diagnostic(said)], "more": 0, "specs": [], "tests": [], "spec": None})


def gave_up_on_size() -> str:
    """The answer in place of one that is larger than :data:`tltlc.io.limits.ANSWER`."""
    return gave_up(f"the answer is larger than {ANSWER.size >> 20} MiB, and was given up")


def _is_letter(letter: Any) -> bool:
    if isinstance(letter, dict):
        return all(isinstance(value, (int, float)) for value in letter.values())
    return isinstance(letter, list) and all(isinstance(name, str) for name in letter)


def _json(value: Any) -> str:
    return json.dumps(value, allow_nan=False)
