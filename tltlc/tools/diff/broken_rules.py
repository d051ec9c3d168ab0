"""Which values of atoms exclude each other because an atom says that a rule about the same sample is broken.

One version of a spec may have the rule in its guards, and the other an atom for it
(:mod:`tltlc.resolve.breaches`).
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from typing import TYPE_CHECKING, Final

from tltlc.automaton.remembered_formulas import kept_rules
from tltlc.logic.formula import Formula, not_
from tltlc.logic.normal_form import negation_normal_form

if TYPE_CHECKING:
    from tltlc.automaton.compare import NamedLiterals
    from tltlc.automaton.fspa import Fspa

_MOST_PRODUCTS: Final = 64
"""Rules with more products are left out: then a comparison may be undecided, but it is not wrong."""


def conflicts(fspa: Fspa, split_names: Container[str], suffix: str) -> Iterator[NamedLiterals]:
    """Yield conjunctions of literals that no sample meets, such as "``breach(a -> b)`` and b".

    ``suffix`` is added to the atoms in ``split_names``.
    """

    def named(name: str) -> str:
        return f"{name}{suffix}" if name in split_names else name

    for name, rule in kept_rules(fspa).items():
        for breaks in (False, True):
            for product in _products(negation_normal_form(not_(rule) if breaks else rule)) or ():
                yield ((named(name), not breaks), *((named(atom), holds) for atom, holds in product.items()))


def _products(formula: Formula) -> list[dict[str, bool]] | None:
    """Return the products of the disjunctive form of a formula in negation normal form, as far as they can be met.

    Return None if some part of the formula has too many.
    """
    if formula.op in ("true", "false"):
        return [{}] if formula.op == "true" else []
    if formula.op not in ("and", "or"):
        literal = formula.args[0] if formula.op == "not" else formula
        return [{literal.name: formula.op != "not"}]
    products: list[dict[str, bool]] = [{}] if formula.op == "and" else []
    for part in formula.args:
        factors = _products(part)
        if factors is None:
            return None
        if formula.op == "or":
            products += factors
        else:
            pairs = ((product, factor) for product in products for factor in factors)
            products = [one | other for one, other in pairs if _agree(one, other)]
        if len(products) > _MOST_PRODUCTS:
            return None
    return products


def _agree(one: Mapping[str, bool], other: Mapping[str, bool]) -> bool:
    return all(one.get(name, holds) == holds for name, holds in other.items())
