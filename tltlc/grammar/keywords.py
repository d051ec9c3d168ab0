"""The keywords that begin declarations, clauses and lines of tests, with their syntax."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from tltlc.grammar.typos import likely_name

DECLARATIONS: Final = {
    "import": '`import NAME`, `import NAME (name, name)`, `import NAME as NAME` or `import "file.tltl"`',
    "signal": "`signal NAME: TYPE in [low, high]`",
    "entity": "`entity NAME, NAME` or `entity GROUP = NAME, NAME`",
    "param": "`param NAME: TYPE in [low, high] = VALUE`",
    "clock": "`clock 20 Hz`, `clock 0.05 s` or `clock varies`",
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
    "step": "`step a, not b`, `step 3x a`, `step for 2 s a` or `step health = 40, a`",
    "expect": '`expect satisfied` (or holding, pending, violated), `expect progress >= 0.5` or `expect state "F a"`',
}

CASES: Final = "write cases as `when x > 3: 1 otherwise: -1`"
"""The help text for a case distinction in the syntax of another language, such as ``a ? b : c``."""

OPERATORS: Final = {"reach": "eventually", "keep": "always", "avoid": "always not", "require": ""}
"""Maps clause keywords to the operators that mean the same inside a formula; `require` needs no operator."""

PHRASE_LIST: Final = '"How do I say…?" in docs/guides/phrases.md lists what people want to say, and how to write it'
RULE_WORDS: Final = (
    "a rule begins with `keep` for what must hold at every step, `avoid` for what must never hold,\n"
    "`reach` for what must hold at some step, or `require` for what must come before something else\n"
    f"{PHRASE_LIST}"
)
"""The help for a sentence that no rule and no grammar understands."""

CONDITIONS: Final = ("if", "when", "whenever", "while")
"""English words that begin a condition."""

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
        **dict.fromkeys(("bool", "boolean", "int", "integer", "float", "double", "number", "enum"), "signal"),
        **dict.fromkeys(("signals", "flag", "sensor", "event"), "signal"),
        "entities": "entity",
        **dict.fromkeys(("rate", "fps", "dt", "timestep", "framerate", "tickrate"), "clock"),
        **dict.fromkeys(("rule", "property", "specification", "objective", "quest", "mission"), "spec"),
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
        **dict.fromkeys(("assert", "invariant"), "keep"),
    },
    "test_item": {"assert": "expect"},
}
"""For each kind of statement, maps words that people write in place of a keyword to the keyword."""

UNITS_ELSEWHERE: Final = {
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("msec", "msecs", "millis", "millisec", "millisecs", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("mins", "minute", "minutes"), "min"),
    **dict.fromkeys(("hour", "hours"), "h"),
    **dict.fromkeys(("degree", "degrees"), "deg"),
    **dict.fromkeys(("frame", "frames", "tick", "ticks", "turn", "turns"), "steps"),
    **dict.fromkeys(("percent", "pct"), "%"),
    **dict.fromkeys(("hz", "fps"), "Hz"),
    **dict.fromkeys(("kmh", "kph"), "km/h"),
    "mps": "m/s",
}
"""Maps names of units that the language does not know to the names that it has for these units."""

JUDGE: Final = ("goal", "limit")
SEMANTICS: Final = ("finite", "infinite")
VERDICTS: Final = ("satisfied", "holding", "pending", "violated")


_OTHER_WORDS: Final = frozenset(
    """
    alter avid click cock else eor entails eventual except excessive exclusion expert explosive gal harding heading
    helping hence hiding hoping hosting housing neat nest net padding pendant pounding predict predicted predicts
    pudding relate retire reverse roach steep stems stop stops strong_next strong_until ten tent text the thin tree
    """.split()
)
"""English words that resemble a word of the language but are no misspelling of it."""


@lru_cache(maxsize=1000)
def closest_word(word: str, known: tuple[str, ...]) -> str | None:
    """Return the word of ``known`` that ``word`` equals or misspells, ignoring capital letters.

    Return None if ``word`` resembles no known word, or if it is one of ``_OTHER_WORDS``: English words
    that only look like a misspelling.
    """
    word = word.lower()
    return None if word in _OTHER_WORDS else likely_name(word, known)
