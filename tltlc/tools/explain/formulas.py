"""Formulas of an automaton, read back from the texts that it holds."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from tltlc.automaton.fspa import Fspa, Guard, Implicant
from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula, atom, rebuild
from tltlc.logic.text.printer import operand_text
from tltlc.resolve.program import resolve


def formula_of(fspa: Fspa) -> Formula | None:
    """The formula of an automaton; None where its text is none, as it may be where another tool made it."""
    stand_ins = {each.name: f"atom_{index}" for index, each in enumerate(fspa.atoms)}
    text = fspa.formula.ascii
    if stand_ins:
        text = _any_of(stand_ins).sub(lambda match: stand_ins[match[0]], text)
    signals = "".join(f"signal {stand_in}: bool\n" for stand_in in stand_ins.values())
    module, found = parse(SourceFile(fspa.name, f"{signals}spec explained = {text}\n"))
    if any(each.severity == "error" for each in found):
        return None
    program, _ = resolve(module)
    names = {stand_in: name for name, stand_in in stand_ins.items()}
    return _renamed(program.specs[0].formula, names) if program.specs else None


def _any_of(names: dict[str, str]) -> re.Pattern[str]:
    """Matches the names of atoms, the longest that fits."""
    longest_first = sorted(names, key=len, reverse=True)
    return re.compile(rf"(?<![\w.])(?:{'|'.join(map(re.escape, longest_first))})(?![\w.])")


def _renamed(formula: Formula, names: dict[str, str]) -> Formula:
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        args = tuple(done[argument] for argument in node.args)
        done[node] = atom(names[node.name]) if node.op == "atom" else rebuild(node, args)
    return done[formula]


def guard_reader(fspa: Fspa) -> Callable[[Guard], Formula]:
    """Reads guards: their texts are literals in sums of products, or in products of sums in brackets."""
    spelled: dict[str, Formula] = {}
    for each in fspa.atoms:
        found = atom(each.name)
        spelled |= {each.name: found, operand_text(found): found, f"!{operand_text(found)}": build.not_(found)}

    def read(guard: Guard) -> Formula:
        found = _sum(guard.text, spelled)
        return found if found is not None else build.or_(*(literals(fspa, prime) for prime in guard.primes))

    return read


def literals(fspa: Fspa, implicant: Implicant) -> Formula:
    """The conjunction of literals, ``true`` where there are none."""
    named = [(atom(fspa.atoms[index].name), holds) for index, holds in implicant]
    return build.and_(*(each if holds else build.not_(each) for each, holds in named))


def _sum(text: str, spelled: dict[str, Formula]) -> Formula | None:
    """The formula of a sum, of a product or of a literal; None where it is no such thing."""
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
    """The parts of a text between symbols that stand in no brackets."""
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
