"""Changes as arguments of functions: `times_within(changes mode, 2 s)`, `times_since(a, round changes)`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from tltlc.grammar.mistakes.declared_names import DeclaredName
from tltlc.grammar.mistakes.sentences.kinds import call_end
from tltlc.grammar.mistakes.sentences.vocabulary import CHANGING
from tltlc.grammar.mistakes.sentences.words import Words

_COUNTS: Final = ("times", "times_since", "times_within")
_EDGES: Final = ("begins", "ends")
_BEFORE: Final = ("(", ",")
_BEHIND: Final = (")", ",")
_MORE: Final = {"<=": 1, ">": 1, "==": 1, "<": 0, ">=": 0}
"""Maps signs to how much more than a number a count must reach before its comparison is settled."""


def change_of_enum(name: str, values: Iterable[str]) -> str:
    """Return the condition of an enum with another value than at the step before."""
    return " or ".join(f"ends ({name} is {value})" for value in values)


def change_of(name: str, declared: DeclaredName) -> str:
    """Return the condition of a name with another value than at the step before; "" if it may have none."""
    if declared.type == "enum":
        return change_of_enum(name, declared.values)
    if declared.type == "bool":
        return f"begins {name} or ends {name}"
    if declared.type == "int":
        return f"{name} != previous({name})"
    return f"{name} < previous({name}) or {name} > previous({name})" if declared.type else ""


def has_changed_argument(words: Words) -> bool:
    """Whether an argument of a function is a change: `(changes mode, …)`, `(a, mode changes)`."""
    return any(changed_name(words, at) for at in range(1, len(words)))


def with_changes(words: Words, following: Words) -> str:
    """Return the text of a call, with a condition for each argument such as `mode changes`.

    Changes of an enum or bool that are counted become a sum, because those at steps in a row would count once.
    ``following`` are the words after the call, with which it may be compared.
    """
    changed = next((at for at in range(1, len(words)) if changed_name(words, at)), 0)
    if not changed:
        return words.text
    name = changed_name(words, changed)
    declared, most = words.names.names[name], _most(following)
    rest = with_changes(words[changed + 2 :], following)
    if changed == 2 and words[0].text in _COUNTS and declared.type in ("enum", "bool") and most:
        ends = [f"({name} is {value})" for value in declared.values] or [name, f"(not {name})"]
        return f"({' + '.join(f'{words[0].text}(ends {end}{rest[:-1].rstrip()}, {most})' for end in ends)})"
    before = words[:changed].text
    return f"{before}{'' if before.endswith('(') else ' '}{change_of(name, declared)}{rest}"


def _most(following: Words) -> str:
    """Return the maximum that a comparison with a number needs; "" if none follows."""
    sign, number = following[:1].text, following.number(1) if len(following) > 1 else ""
    return str(int(number) + _MORE[sign]) if sign in _MORE and number.isdecimal() else ""


def changed_name(words: Words, at: int) -> str:
    """Return the name of which an argument at an index says that it changes; "" if it says something else."""
    if words[at - 1].text not in _BEFORE or at + 2 >= len(words) or words[at + 2].text not in _BEHIND:
        return ""
    for name, word in ((at, at + 1), (at + 1, at)):
        declared = words.declared(name)
        if declared is None or declared.parameters or not declared.type or call_end(words, name) != name + 1:
            continue
        is_edge = name > word and words[word].text in _EDGES and declared.type not in ("bool", "enum")
        if is_edge or (words[word].text in CHANGING and words[word].text not in words.names.names):
            return words[name].text
    return ""
