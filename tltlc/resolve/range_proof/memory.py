"""Remembers the answers that needed sympy, so that each question costs its import at most once.

They are kept in ``$TLTLC_CACHE_DIR`` (set but empty: nowhere) or the system's place for caches.  A file
that cannot be read or written is as good as none.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

from tltlc.core.record import record
from tltlc.expression.tree import Condition, Const, Expression, Op, When
from tltlc.io.json_text import load
from tltlc.io.limits import REPORT, WORK
from tltlc.io.temporary import temporaries
from tltlc.resolve.range_proof.cases import variables
from tltlc.resolve.range_proof.region import Box, Variable

CHECKER_VERSION = 2  # raise it whenever an answer may change

_FILE_NAME = "predicates.json"
_MOST_ANSWERS = 2000
_MOST_STEPS = WORK["check of a predicate"]


@record
class Answer:
    """Whether something is proved, and the steps that this took: they count where it is remembered, too."""

    proved: bool
    steps: int


def answer(question: str, compute: Callable[[], Answer]) -> Answer:
    """The remembered answer to a question, or the computed one, which is remembered from then on."""
    from hashlib import sha256

    key = sha256(question.encode()).hexdigest()
    folder = cache_folder()
    own = _read(folder / _FILE_NAME) if folder else {}
    if key in own:
        return own[key]
    result = compute()
    if folder:
        kept = list(own.items())[1 - _MOST_ANSWERS :]
        _write(folder / _FILE_NAME, dict([*kept, (key, result)]))
    return result


def question(kind: str, expression: Expression, box: Box, bools: frozenset[Variable], low: float, high: float) -> str:
    """A text that two predicates share only if they are the same but for the names of signals and params."""
    names = {variable: f"{type(variable).__name__[0].lower()}{n}" for n, variable in enumerate(variables(expression))}
    ranges = [
        f"{name}{'?' if variable in bools else ''}:{box[variable][0]!r},{box[variable][1]!r}"
        for variable, name in names.items()
    ]
    parts = (str(CHECKER_VERSION), kind, repr(low), repr(high), " ".join(ranges), _text(expression, names))
    return "|".join(parts)


def cache_folder() -> Path | None:
    """Where the user's answers are kept, or None if nowhere."""
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
    """The answers in a file; none where it is missing, damaged or of another version."""
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
    kept = {key: [answer.proved, answer.steps] for key, answer in answers.items()}
    # Without it, the answers only take longer the next time.
    with suppress(OSError), temporaries() as made:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = made.path(path)
        temporary.write_text(json.dumps({"version": CHECKER_VERSION, "answers": kept}), "utf-8")
        temporary.replace(path)


def _text(node: Expression | Condition, names: Mapping[Variable, str]) -> str:
    if isinstance(node, Const):
        return repr(float(node.value))
    if isinstance(node, (Op, Condition)):
        return f"({node.op} {' '.join(_text(arg, names) for arg in node.args)})"
    if isinstance(node, When):
        cases = [f"[{_text(condition, names)} {_text(value, names)}]" for condition, value in node.cases]
        return f"(when {' '.join(cases)} {_text(node.otherwise, names)})"
    return names[node]
