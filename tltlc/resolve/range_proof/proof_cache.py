"""Cache the results of proofs about the ranges of predicates, because importing sympy is slow.

Sympy is imported only for a proof whose result is not in the cache. The cache is a file in the
folder that the environment variable ``TLTLC_CACHE_DIR`` names, or in the user's cache folder if the
variable is not set. If the variable is empty, there is no cache. A file that cannot be read or
written is ignored.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

from tltlc.core.record import record
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When
from tltlc.io.json_text import load
from tltlc.io.limits import REPORT, WORK
from tltlc.io.temporary import temporaries
from tltlc.resolve.range_proof.cases import variables
from tltlc.resolve.range_proof.region import Box, Variable

CHECKER_VERSION = 2  # increase this whenever an answer may change

_FILE_NAME = "predicates.json"
_MOST_ANSWERS = 2000
_MOST_STEPS = WORK["check of a predicate"]


@record
class Answer:
    """The result of an attempted proof: whether it succeeded, and how many steps it took.

    The steps count against the limit of the check each time that the cached answer is used.
    """

    proved: bool
    steps: int


def answer(question: str, compute: Callable[[], Answer]) -> Answer:
    """Return the cached answer to a question, or call ``compute`` and cache its result.

    The question is a text from :func:`question`.
    """
    from hashlib import sha256

    key = sha256(question.encode()).hexdigest()
    folder = cache_folder()
    answers = _read(folder / _FILE_NAME) if folder else {}
    if key in answers:
        return answers[key]
    result = compute()
    if folder:
        recent = list(answers.items())[1 - _MOST_ANSWERS :]
        _write(folder / _FILE_NAME, dict([*recent, (key, result)]))
    return result


def question(kind: str, expression: Expression, box: Box, bools: frozenset[Variable], low: float, high: float) -> str:
    """Return a text that identifies what is to be proved, the key of the cache.

    ``kind`` is ``range`` or ``continuity``. The text does not contain the names of signals and params,
    so predicates that differ only in these names share an answer.
    """
    names = {variable: f"{type(variable).__name__[0].lower()}{n}" for n, variable in enumerate(variables(expression))}
    ranges = [
        f"{name}{'?' if variable in bools else ''}:{box[variable][0]!r},{box[variable][1]!r}"
        for variable, name in names.items()
    ]
    parts = (str(CHECKER_VERSION), kind, repr(low), repr(high), " ".join(ranges), _text(expression, names))
    return "|".join(parts)


def cache_folder() -> Path | None:
    """Return the folder of the user's cached answers, or None if answers are not stored.

    Answers are not stored if ``TLTLC_CACHE_DIR`` is set but empty, or if the user has no home folder.
    """
    chosen = os.environ.get("TLTLC_CACHE_DIR")
    if chosen is not None:
        return Path(chosen) if chosen else None
    try:
        if sys.platform == "win32":
            return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "tltlc" / "Cache"
        if sys.platform == "darwin":
            return Path.home() / "Library" / "Caches" / "tltlc"
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "tltlc"
    except RuntimeError:  # no home folder
        return None


def _read(path: Path) -> dict[str, Answer]:
    """Return the answers in a file, by key; an empty dict if the file is missing, damaged or of another version."""
    try:
        content = load(path, REPORT)
    except (OSError, ValueError, RecursionError):
        return {}
    if not isinstance(content, dict) or content.get("version") != CHECKER_VERSION:
        return {}
    answers = content.get("answers")
    if not isinstance(answers, dict):
        return {}
    return {key: Answer(*value) for key, value in answers.items() if _is_answer(value)}


def _is_answer(value: object) -> bool:
    return isinstance(value, list) and [type(part) for part in value] == [bool, int] and 0 <= value[1] <= _MOST_STEPS


def _write(path: Path, answers: Mapping[str, Answer]) -> None:
    entries = {key: [answer.proved, answer.steps] for key, answer in answers.items()}
    # If writing fails, the answers are only computed again next time.
    with suppress(OSError), temporaries() as made:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = made.path(path)
        temporary.write_text(json.dumps({"version": CHECKER_VERSION, "answers": entries}), "utf-8")
        temporary.replace(path)


def _text(node: Expression | Condition, names: Mapping[Variable, str]) -> str:
    if isinstance(node, Const):
        return repr(float(node.value))
    if isinstance(node, (Op, Condition)):
        return f"({node.op} {' '.join(_text(arg, names) for arg in node.args)})"
    if isinstance(node, When):
        cases = [f"[{_text(condition, names)} {_text(value, names)}]" for condition, value in node.cases]
        return f"(when {' '.join(cases)} {_text(node.otherwise, names)})"
    assert isinstance(node, (SignalValue, ParamValue)), "predicates read registers as signals"
    return names[node]
