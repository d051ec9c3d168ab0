"""Read how a number changes from one step to the next: ``ammo goes down by 1``, ``coins stays the same``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from tltlc.grammar.mistakes.sentences.words import Phrase, Words, phrases

CHANGES: Final[Mapping[Phrase, str]] = {
    **dict.fromkeys(
        phrases(
            "decreases", "decrease", "drops", "drop", "falls", "fall", "shrinks", "shrink", "goes down", "go down",
            "is reduced", "gets lower", "is lowered", "goes lower", "is decreased", "sinks",
        ),
        "<",
    ),
    **dict.fromkeys(
        phrases("increases", "increase", "rises", "rise", "grows", "grow", "goes up", "go up", "gets higher",
                "is raised", "goes higher", "is increased"),
        ">",
    ),
    **dict.fromkeys(
        phrases("stays the same", "stay the same", "remains the same", "does not change", "doesn't change",
                "do not change", "is unchanged", "stays constant", "remains unchanged", "stays unchanged",
                "remains constant", "keeps its value"),
        "==",
    ),
    **dict.fromkeys(phrases("changes", "change"), "!="),
}  # fmt: skip
"""Maps verbs for a change from one step to the next to the sign of the comparison with the value before."""
_LOSSES: Final = ("spend", "lose", "waste", "spending", "losing", "spends", "loses")
_GAINS: Final = ("gain", "earn", "gaining", "earning", "gains", "earns")

VERBS_OF_CHANGE: Final = (*_LOSSES, *_GAINS)

_SAME: Final = re.compile(r"([\w.]+) (?:== previous\(\1\)|>= previous\(\1\) and \1 <= previous\(\1\))")
_SEVERAL: Final = re.compile(r"\(*same(?: and same)*\)*")


def change_of(value: str, kind: str, words: Words) -> tuple[str, str] | None:
    """Return the conditions on a value and its value before, and a sign, for the words behind its name.

    The sign is that of the comparison; it is empty for several conditions. ``kind`` is the type of the
    value: equality and steps are only clear for an int.
    """
    phrase = words.phrase(0, CHANGES)
    before, rest = f"previous({value})", words[len(phrase) :]
    if not phrase:
        return None
    sign = CHANGES[phrase]
    if len(rest) == 2 and rest.word(0) == "by" and rest.number(1) and sign in ("<", ">") and kind == "int":
        return f"{value} == {before} {'-' if sign == '<' else '+'} {rest.number(1)}", ""
    if rest:
        return None
    if sign == "==" and kind != "int":
        return f"{value} >= {before} and {value} <= {before}", "and"
    return None if sign == "!=" and kind != "int" else (f"{value} {sign} {before}", sign)


def loss_of(words: Words) -> str:
    """Return the sign of the change that a verb before the name of a number tells: `<` for `spend gold`."""
    return "<" if words.word(0) in _LOSSES else ">" if words.word(0) in _GAINS else ""


def keeps_values(text: str) -> bool:
    """Whether a condition says of each of its numbers that it is that of the step before, and nothing else."""
    return _SEVERAL.fullmatch(_SAME.sub("same", text)) is not None
