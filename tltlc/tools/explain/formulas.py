"""Parse the formulas and guards of an automaton from its texts."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from tltlc.automaton.fspa import Fspa, Guard, Implicant
from tltlc.core.source import SourceFile
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula, atom, rebuild
from tltlc.logic.text.printer import operand_text
from tltlc.pipeline import Session


def formula_of(fspa: Fspa) -> Formula | None:
    """Return the formula of an automaton, or None if its text is no valid formula.

    The text may be invalid if another tool made the automaton.
    """
    stand_ins = {declared.name: f"atom_{index}" for index, declared in enumerate(fspa.atoms)}
    text = fspa.formula.ascii
    if stand_ins:
        text = _any_of(stand_ins).sub(lambda match: stand_ins[match[0]], text)
    signals = "".join(f"signal {stand_in}: bool\n" for stand_in in stand_ins.values())
    session = Session(SourceFile(fspa.name, f"{signals}spec explained = {text}\n"))
    if any(diagnostic.severity == "error" for diagnostic in session.syntax_errors):
        return None
    specs = session.resolution.program.specs
    names = {stand_in: name for name, stand_in in stand_ins.items()}
    return _renamed(specs[0].formula, names) if specs else None


def _any_of(names: dict[str, str]) -> re.Pattern[str]:
    """Return a pattern that matches the names of atoms, the longest possible one first."""
    longest_first = sorted(names, key=len, reverse=True)
    return re.compile(rf"(?<![\w.])(?:{'|'.join(map(re.escape, longest_first))})(?![\w.])")


def _renamed(formula: Formula, names: dict[str, str]) -> Formula:
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        args = tuple(done[argument] for argument in node.args)
        done[node] = atom(names[node.name]) if node.op == "atom" else rebuild(node, args)
    return done[formula]


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
