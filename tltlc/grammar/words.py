"""The keywords that begin declarations, clauses and lines of tests, each with the form of what it begins."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

DECLARATIONS: Final = {
    "import": '`import NAME`, `import NAME (name, name)`, `import NAME as NAME` or `import "file.tltl"`',
    "signal": "`signal NAME: TYPE in [low, high]`",
    "entity": "`entity NAME, NAME`",
    "param": "`param NAME: TYPE in [low, high] = VALUE`",
    "clock": "`clock 20 Hz` or `clock 0.05 s`",
    "predicate": "`predicate NAME(x: entity) in [-1, 1] = EXPRESSION`",
    "let": "`let NAME(x) = FORMULA`",
    "exclusive": "`exclusive ATOM, ATOM`",
    "spec": "`spec NAME = FORMULA` or `spec NAME { reach … keep … }`",
    "test": '`test "title" for SPEC { step ATOM, ATOM  expect satisfied }`',
}

CLAUSES: Final = {
    "reach": "`reach a then b`",
    "keep": "`keep a`",
    "avoid": "`avoid a`",
    "require": "`require FORMULA`",
    "level": "`level NAME`",
    "limit": "`limit 400 steps` or `limit 20 s`",
    "judge": "`judge at goal` or `judge at limit`",
    "semantics": "`semantics finite` or `semantics infinite`",
    "tag": "`tag NAME, NAME`",
}

TEST_ITEMS: Final = {
    "step": "`step a, not b` or `step 3x a`",
    "expect": '`expect satisfied` (or holding, pending, violated), `expect progress >= 0.5` or `expect state "F a"`',
}

JUDGE: Final = ("goal", "limit")
SEMANTICS: Final = ("finite", "infinite")
VERDICTS: Final = ("satisfied", "holding", "pending", "violated")


@lru_cache(maxsize=1000)
def closest(word: str, known: tuple[str, ...]) -> str | None:
    """The known word that ``word`` is most likely a misspelling of, if any."""
    from difflib import get_close_matches

    found = get_close_matches(word.lower(), known, n=1, cutoff=0.65)
    return found[0] if found else None
