"""The requests of the playground page and their answers, as JSON.

Requests and answers are the same whether the compiler runs on a server or in the browser.
"""

from __future__ import annotations

import json
from typing import Any, Final, get_args

from tltlc.automaton.fspa import Notation
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.interfaces.playground.page_config import start
from tltlc.interfaces.playground.page_data import diagnostic, view
from tltlc.interfaces.playground.trace import PageLetter
from tltlc.io.json_text import loads
from tltlc.io.limits import ANSWER, MESSAGE

MOST_LETTERS: Final = 1_000
"""The most steps of the trace in a request."""
TOO_LARGE: Final = "this takes more memory than the playground has"
"""The title of the error for a text whose analysis needs too much memory."""


class RequestError(ValueError):
    """Raised if a text is not a valid request of the playground page."""


@record
class Question:
    """A request of the playground page about a spec text.

    ``spec``, ``letters``, ``notation`` and ``lengths`` are the parameters of :func:`view`.
    """

    text: str
    spec: str
    letters: tuple[PageLetter, ...]
    notation: Notation
    lengths: tuple[float | None, ...]


def answer(request: str) -> str:
    """Answer a request with the result of :func:`start` or :func:`view`, as JSON.

    If this fails, for example for lack of memory, answer with an error. Raises RequestError if the
    text is not a valid request.
    """
    parsed = question(request)
    if parsed is None:
        return _json(start())
    try:
        return _json(view(parsed.text, parsed.spec, parsed.letters, parsed.notation, parsed.lengths))
    except (MemoryError, RecursionError):
        return error_answer(TOO_LARGE)
    except Exception:
        # A traceback does not help the user, who can go on typing.
        return error_answer("a bug in tltlc stopped this", "please report it, with the text")


def question(request: str) -> Question | None:
    """Parse a request: a JSON object with the keys ``text``, ``spec``, ``letters``, ``notation`` and ``lengths``.

    All keys but ``text`` are optional. Return None for ``{}``, which asks for the result of
    :func:`start`. Raises RequestError if the text is not a valid request.
    """
    try:
        parsed = loads(request, MESSAGE)
    except (ValueError, RecursionError) as error:
        raise RequestError("a request must be JSON") from error
    if parsed == {}:
        return None
    if not isinstance(parsed, dict) or not isinstance(parsed.get("text"), str):
        raise RequestError("a request must have a `text`")
    spec, letters = parsed.get("spec", ""), parsed.get("letters", [])
    if not isinstance(spec, str) or not isinstance(letters, list) or len(letters) > MOST_LETTERS:
        raise RequestError(f"`spec` must be a name, and `letters` a list of at most {MOST_LETTERS}")
    notation = parsed.get("notation", "english")
    if notation not in get_args(Notation):
        raise RequestError(f"`notation` must be one of {', '.join(get_args(Notation))}")
    if not all(map(_is_letter, letters)):
        raise RequestError("a letter must be a list of atoms, or an object that maps names of signals to numbers")
    lengths = parsed.get("lengths", [])
    if not isinstance(lengths, list) or not all(length is None or _is_number(length) for length in lengths):
        raise RequestError("`lengths` must be a list of numbers or nulls")
    return Question(parsed["text"], spec, tuple(letters), notation, tuple(lengths))


def error_answer(title: str, help_: str = "make the spec smaller: bounds and large conjunctions cost most") -> str:
    """Return the answer for a text that cannot be analysed, as JSON: error TLT0775, with this title and help."""
    message = Diagnostic("TLT0775", title, help=help_)
    return _json({"diagnostics": [diagnostic(message)], "more": 0, "specs": [], "tests": [], "spec": None})


def size_error_answer() -> str:
    """Return the error, as JSON, to send instead of an answer larger than :data:`tltlc.io.limits.ANSWER` allows."""
    return error_answer(f"the answer is larger than {ANSWER.size >> 20} MiB, so it was not sent")


def _is_letter(letter: Any) -> bool:
    if isinstance(letter, dict):
        return all(map(_is_number, letter.values()))
    return isinstance(letter, list) and all(isinstance(name, str) for name in letter)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float))


def _json(value: Any) -> str:
    return json.dumps(value, allow_nan=False)
