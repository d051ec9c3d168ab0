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

CASES: Final = "cases are written `when x > 3: 1 otherwise: -1`"
"""The help where cases are written in another way."""

OPERATORS: Final = {"reach": "eventually", "keep": "always", "avoid": "always not", "require": ""}
"""What the clauses that ask for something are inside a formula."""

CONDITIONS: Final = ("if", "when", "whenever", "while")
"""English words that a condition follows."""

SYNONYMS: Final[dict[str, dict[str, str]]] = {
    "declaration": {
        "include": "import",
        "use": "import",
        "input": "signal",
        "var": "signal",
        "variable": "signal",
        "object": "entity",
        "objects": "entity",
        "const": "param",
        "constant": "param",
        "function": "predicate",
        "def": "let",
        "define": "let",
        "goal": "spec",
        "plan": "spec",
        "from": "import",
        **dict.fromkeys(("bool", "boolean", "int", "float", "number"), "signal"),
    },
    "clause": {
        "goal": "reach",
        "get": "reach",
        "maintain": "keep",
        "stay": "keep",
        "never": "avoid",
        "forbid": "avoid",
        "must": "require",
        "ensure": "require",
        "should": "require",
        "win": "reach",
        "remain": "keep",
        "lose": "avoid",
        "fail": "avoid",
        "prevent": "avoid",
    },
    "test_item": {"assert": "expect"},
}
"""What keywords are called elsewhere, by kind of piece."""

UNITS_ELSEWHERE: Final = {
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("mins", "minute", "minutes"), "min"),
    **dict.fromkeys(("hour", "hours"), "h"),
    **dict.fromkeys(("degree", "degrees"), "deg"),
    **dict.fromkeys(("frame", "frames", "tick", "ticks", "turn", "turns"), "steps"),
    **dict.fromkeys(("percent", "pct"), "%"),
    **dict.fromkeys(("hz", "fps"), "Hz"),
    **dict.fromkeys(("kmh", "kph"), "km/h"),
    "mps": "m/s",
}
"""What units are called elsewhere."""

JUDGE: Final = ("goal", "limit")
SEMANTICS: Final = ("finite", "infinite")
VERDICTS: Final = ("satisfied", "holding", "pending", "violated")


_NEGATING: Final = frozenset(("no", "non", "not", "nt", "never", "dont", "cant", "isnt", "less"))
"""What says the opposite, in front of another word or behind it."""
_PREFIXES: Final = _NEGATING | {"un", "in", "im", "il", "ir", "dis", "de", "anti"}
_OF_OPERATORS: Final = ("n", "x", "xn")
"""What makes another operator of one, as in `nand`; before names, it is a slip."""
_OPPOSITES: Final = (
    ("min", "max"),
    ("left", "right"),
    ("up", "down"),
    ("on", "off"),
    ("in", "out"),
    ("in", "ex"),
    ("in", "de"),
    ("as", "de"),
    ("en", "dis"),
    ("over", "under"),
    ("pre", "post"),
)
_ALIKE: Final = 0.6
_OF_OTHERS: Final = frozenset(("else", "eor", "entails", "hence", "except", "strong_until", "strong_next"))
"""Words that mean something else than the words of the language that look like them."""


@lru_cache(maxsize=1000)
def closest(word: str, known: tuple[str, ...]) -> str | None:
    """The known word that ``word`` is most likely a misspelling of, if any; none that says something else."""
    from difflib import get_close_matches

    word = word.lower()
    if word in _OF_OTHERS:
        return None
    known = tuple(each for each in known if not _negates(word, each) and word not in _operators_like(each))
    found = get_close_matches(word, known, n=1, cutoff=0.65)
    return found[0] if found else None


def says_otherwise(name: str, known: str) -> bool:
    """Whether a name is none that was misspelt, but says something else: `unlocked` for `locked`, `door_2`, `min_x`."""
    from difflib import SequenceMatcher

    name, known = name.lower(), known.lower()
    if _negates(name, known) or _negates(known, name):
        return True
    if any(known in (name.replace(a, b, 1), name.replace(b, a, 1)) for a, b in _OPPOSITES if a in name or b in name):
        return True
    if [*filter(str.isdigit, name)] != [*filter(str.isdigit, known)]:
        return True
    parts, others = name.split("_"), known.split("_")
    if len(parts) != len(others) or len(parts) == 1:
        return False
    pairs = ((a, b) for a, b in zip(parts, others, strict=True) if a != b)
    return any(SequenceMatcher(None, a, b).ratio() < _ALIKE for a, b in pairs)


def _negates(word: str, known: str) -> bool:
    """Whether a word is a known one with what makes the opposite of it put on, or into it."""
    if known in word:
        before, _, behind = word.partition(known)
        if before.strip("_") in _PREFIXES or behind.strip("_") in _NEGATING:
            return True
    size = len(word) - len(known)
    if size < 1:
        return False
    for at in range(len(known) + 1):
        if word[:at] != known[:at]:
            break
        if word[at + size :] == known[at:]:
            begins = at == 0 or word[at - 1] == "_"
            if word[at : at + size].strip("_") in (_PREFIXES if begins else _NEGATING):
                return True
    return False


def _operators_like(word: str) -> set[str]:
    return {f"{prefix}{word}" for prefix in _OF_OPERATORS}
