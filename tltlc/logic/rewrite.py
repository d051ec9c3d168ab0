"""Named rewrites that shorten formulas over finite traces, and the simplifier that applies them.

On a finite trace, ``X`` is false and ``N`` is true at the last sample. So ``X true`` means "not the
last sample", and both ``F G a`` and ``G F a`` mean "``a`` at the last sample".
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Final

from tltlc.core.record import record
from tltlc.logic import boolean_rules, temporal_rules
from tltlc.logic.formula import Formula, FormulaOp, rebuild

_MOST_PASSES: Final = 12
_MOST_STEPS: Final = 50


@record
class Rewrite:
    """A rewrite of formulas whose outermost operator is in ``ops``.

    ``apply`` returns an equivalent formula that is not larger (see :func:`size`); if the rewrite
    does not match, it returns the same object. ``law`` has examples ``before = after``, separated
    by ``;``, which tests check.
    """

    name: str
    ops: tuple[FormulaOp, ...]
    law: str
    apply: Callable[[Formula], Formula]


_AND_OR: Final[tuple[FormulaOp, ...]] = ("and", "or")

REWRITES: Final = (
    Rewrite(
        "negation",
        ("not",),
        "!true = false; !!a = a; !(a -> b) = a & !b; !(!a & b) = a | !b; !(!a <-> b) = a <-> b",
        boolean_rules.push_not,
    ),
    Rewrite(
        "temporal negation",
        ("not",),
        "!X a = N !a; !N a = X !a; !F a = G !a; !G !a = F a; !(!a U b) = a R !b; !(!a W b) = a M !b",
        temporal_rules.push_not,
    ),
    Rewrite(
        "constants",
        _AND_OR,
        "a & true = a; a & false = false; a | true = true; a | false = a",
        boolean_rules.drop_constants,
    ),
    Rewrite("idempotence", _AND_OR, "a & a = a; a | b | a = a | b", boolean_rules.drop_repeated),
    Rewrite(
        "complement",
        _AND_OR,
        "a & !a = false; F a | G !a = true; a & b & !a = false",
        boolean_rules.decide_complementary,
    ),
    Rewrite("absorption", _AND_OR, "a & (a | b) = a; F a & F(a & b) = F(a & b); G a | a = a", boolean_rules.absorb),
    Rewrite(
        "resolution", _AND_OR, "a & (!a | b) = a & b; a & (a -> b) = a & b; a | !a & b = a | b", boolean_rules.resolve
    ),
    Rewrite(
        "factor",
        _AND_OR,
        "F a & G c | F b & G c = (F a | F b) & G c; (a | b) & (a | c) = a | b & c",
        boolean_rules.factor,
    ),
    Rewrite(
        "last sample",
        _AND_OR,
        "F G a & F G b = F G (a & b); G F a | F G b = G F (a | b)",
        temporal_rules.merge_at_last,
    ),
    Rewrite(
        "distribution",
        _AND_OR,
        "G a & G b = G(a & b); F a | F b = F(a | b); X a & N b = X(a & b); X a | N b = N(a | b); X a & X b = X(a & b)",
        temporal_rules.distribute,
    ),
    Rewrite(
        "expansion",
        _AND_OR,
        "a | X F a = F a; a & N G a = G a; b | a & X(a U b) = a U b; b & (a | N(a R b)) = a R b",
        temporal_rules.fold_expansion,
    ),
    Rewrite(
        "weak and strong",
        _AND_OR,
        "a U b | G a = a W b; a M b | G b = a R b; a W b & F b = a U b; a R b & F a = a M b",
        temporal_rules.merge_weak_and_strong,
    ),
    Rewrite(
        "implication",
        ("implies",),
        "true -> a = a; a -> false = !a; a -> a | b = true; !a -> b = a | b",
        boolean_rules.shorten_implication,
    ),
    Rewrite(
        "equivalence",
        ("iff",),
        "a <-> a = true; a <-> !a = false; true <-> a = a; a <-> false = !a; !a <-> !b = a <-> b",
        boolean_rules.shorten_equivalence,
    ),
    Rewrite(
        "constant operand",
        ("X", "N", "F", "G"),
        "F true = true; F false = false; G true = true; G false = false; X false = false; N true = true",
        temporal_rules.evaluate_constant,
    ),
    Rewrite(
        "trace end",
        ("F", "G"),
        "F N a = true; G X a = false; F(a | N b) = true; G(b & F X a) = false",
        temporal_rules.evaluate_at_last,
    ),
    Rewrite(
        "nesting",
        ("F", "G"),
        "F F a = F a; F(a U b) = F b; F(a M b) = F(a & b); F G F a = G F a; F X a = X F a; F(a | F b) = F(a | b); "
        "G G a = G a; G(a R b) = G b; G(a W b) = G(a | b); G F G a = F G a; G N a = N G a; G(a & (c R b)) = G(a & b)",
        temporal_rules.simplify_nested,
    ),
    Rewrite(
        "until",
        ("U", "W"),
        "a U true = true; a U false = false; false U a = a; true U a = F a; !a U a = F a; a U (a U b) = a U b; "
        "a U F b = F b; a W true = true; "
        "a W false = G a; false W a = a; true W a = true; !a W a = true; (a W b) W b = a W b",
        temporal_rules.simplify_until,
    ),
    Rewrite(
        "release",
        ("R", "M"),
        "a R true = true; a R false = false; true R a = a; false R a = G a; !a R a = G a; a R (a R b) = a R b; "
        "a R G b = G b; a M true = F a; "
        "a M false = false; true M a = a; false M a = false; !a M a = false; (a M b) M b = a M b",
        temporal_rules.simplify_release,
    ),
)
"""The rewrites, in the order in which they are tried."""

_BY_OP: Final[dict[str, tuple[Rewrite, ...]]] = {
    op: tuple(rewrite for rewrite in REWRITES if op in rewrite.ops)
    for op in ("not", "and", "or", "implies", "iff", "X", "N", "F", "G", "U", "W", "R", "M")
}


def simplify(formula: Formula, known: dict[Formula, Formula] | None = None) -> Formula:
    """Return a formula that is equivalent on every finite trace and not larger (see :func:`size`).

    Operands keep their order. Rewrites all subformulas, operands first, and repeats this until
    nothing changes, at most 12 times. ``known`` caches the results for subformulas; pass the same
    dict for formulas that share subformulas.
    """
    known = {} if known is None else known
    for _ in range(_MOST_PASSES):
        simpler = _run_pass(formula, known)
        if simpler is formula:
            break
        formula = simpler
    return formula


def size(formula: Formula) -> int:
    """Return the number of atoms, constants and operators in the printed formula.

    The size of ``a & b & c`` is 5.
    """
    sizes: dict[Formula, int] = {}
    for node in formula.bottom_up():
        operators = len(node.args) - 1 if node.op in _AND_OR else 1
        sizes[node] = operators + sum(sizes[argument] for argument in node.args)
    return sizes[formula]


def _run_pass(formula: Formula, done: dict[Formula, Formula]) -> Formula:
    for node in formula.bottom_up(known=done):
        done[node] = _rewrite_root(rebuild(node, tuple(done[argument] for argument in node.args)))
    return done[formula]


@lru_cache(maxsize=16384)
def _rewrite_root(node: Formula) -> Formula:
    """Apply rewrites to the outermost operator of a formula until no rewrite matches."""
    for _ in range(_MOST_STEPS):
        for rewrite in _BY_OP.get(node.op, ()):
            rewritten = rewrite.apply(node)
            if rewritten is not node:
                node = rewritten
                break
        else:
            break
    return node
