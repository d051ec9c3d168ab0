"""Parse the guards of an automaton from their texts."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from tltlc.automaton.fspa import Fspa, Guard, Implicant
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula, atom
from tltlc.logic.text.printer import operand_text


def guard_reader(fspa: Fspa) -> Callable[[Guard], Formula]:
    """Return a function that parses guards.

    The texts of guards are sums of products of literals, or products of sums in brackets.
    """
    spelled: dict[str, Formula] = {}
    for declared in fspa.atoms:
        formula = atom(declared.name)
        spelled |= {
            declared.name: formula,
            operand_text(formula): formula,
            f"!{operand_text(formula)}": build.not_(formula),
        }

    def read(guard: Guard) -> Formula:
        formula = _sum(guard.text, spelled)
        return formula if formula is not None else build.or_(*(literals(fspa, prime) for prime in guard.primes))

    return read


def literals(fspa: Fspa, implicant: Implicant) -> Formula:
    """Return the conjunction of literals; ``true`` if there are none."""
    named = [(atom(fspa.atoms[index].name), holds) for index, holds in implicant]
    return build.and_(*(literal if holds else build.not_(literal) for literal, holds in named))


def _sum(text: str, spelled: dict[str, Formula]) -> Formula | None:
    """Parse a sum, a product or a literal. Return None if the text is none of these."""
    if text in spelled:
        return spelled[text]
    for symbol, make in ((" | ", build.or_), (" & ", build.and_)):
        parts = [*_split(text, symbol)]
        if len(parts) > 1:
            read = [_sum(part, spelled) for part in parts]
            known = [part for part in read if part is not None]
            return make(*known) if len(known) == len(read) else None
    if text.startswith("(") and text.endswith(")"):
        return _sum(text[1:-1], spelled)
    return build.TRUE if text == "true" else None


def _split(text: str, symbol: str) -> Iterator[str]:
    """Yield the parts of a text between symbols that are outside brackets."""
    if "(" not in text:
        yield from text.split(symbol)
        return
    depth = start = 0
    for place, sign in enumerate(text):
        depth += (sign == "(") - (sign == ")")
        if depth == 0 and text.startswith(symbol, place):
            yield text[start:place]
            start = place + len(symbol)
    yield text[start:]
