"""Normalise formulas to Boolean combinations of four kinds of formulas.

The four kinds are Sigma-2 formulas (no ``U`` inside a ``W``), Pi-2 formulas (no ``W`` inside a
``U``), ``G F p`` with p in Sigma-1 (no ``W``), and ``F G p`` with p in Pi-1 (no ``U``).
The rewrites are from S. Sickert, J. Esparza, "An Efficient Normalisation Procedure for
Linear Temporal Logic and Very Weak Alternating Automata" (LICS 2020), and from their rewrite system
(TACAS 2023). Formulas that are already Sigma-2 or Pi-2 are not changed.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from tltlc.automaton.infinite import normal_form
from tltlc.automaton.work import OutOfWork
from tltlc.logic.formula import FALSE, TRUE, Formula


@lru_cache(maxsize=65536)
def contains(formula: Formula, op: str) -> bool:
    """Whether a formula contains the operator ``op``."""
    return formula.op == op or any(contains(argument, op) for argument in formula.args)


@lru_cache(maxsize=65536)
def is_sigma_2(formula: Formula) -> bool:
    """Whether a formula has no ``U`` inside a ``W``, and no ``G F p`` or ``F G p``."""
    if formula.op in ("G", "F"):
        return False
    if formula.op == "W" and contains(formula, "U"):
        return False
    return all(map(is_sigma_2, formula.args))


@lru_cache(maxsize=65536)
def is_pi_2(formula: Formula) -> bool:
    """Whether a formula has no ``W`` inside a ``U``, and no ``G F p`` or ``F G p``."""
    if formula.op in ("G", "F"):
        return False
    if formula.op == "U" and contains(formula, "W"):
        return False
    return all(map(is_pi_2, formula.args))


def delta_2(formula: Formula) -> Formula:
    """Return an equivalent formula that is normalised: a Boolean combination of four kinds of formulas.

    They are formulas without ``U`` inside a ``W``, formulas without ``W`` inside a ``U``, ``G F p``
    without ``W``, and ``F G p`` without ``U``. Raises OutOfWork if the formula becomes too large.
    """
    return _Normaliser().normal(formula)


def delta_2_dually(formula: Formula) -> Formula:
    """Normalise the negation of a formula with :func:`delta_2`, and return the negation of the result.

    The result is normalised and equivalent to ``formula``, but may differ from ``delta_2(formula)``.
    Raises OutOfWork if the formula becomes too large.
    """
    return normal_form.negation(delta_2(normal_form.negation(formula)))


_MOST_STEPS: Final = 3000
"""The most formulas that one normalisation may rewrite."""


class _Normaliser:
    def __init__(self) -> None:
        self._steps = 0
        self._normal: dict[Formula, Formula] = {}
        self._flat: dict[Formula, Formula] = {}

    def normal(self, formula: Formula) -> Formula:
        """Return an equivalent normalised formula, as :func:`delta_2` describes it; results are cached."""
        result = self._normal.get(formula)
        if result is None:
            self._spend()
            result = self._normal[formula] = self._normalise(formula)
        return result

    def _normalise(self, formula: Formula) -> Formula:
        op, args = formula.op, formula.args
        if op == "and" or op == "or":
            make = normal_form.conjunction if op == "and" else normal_form.disjunction
            return make(map(self.normal, args))
        if op == "G" and args[0].op == "F":
            return self._always_eventually(args[0].args[0])
        if op == "F" and args[0].op == "G":
            return self._eventually_always(args[0].args[0])
        if is_sigma_2(formula) or is_pi_2(formula):
            return formula
        if op == "X":
            return _push_next(self.normal(args[0]))
        flat = self.flat(formula)
        if flat is formula:
            # The formula has too many subformulas G F p and F G p to move them out.
            raise OutOfWork
        return flat if is_sigma_2(flat) else self.normal(flat)

    def _always_eventually(self, inner: Formula) -> Formula:
        outermost = _outermost(inner, "W")
        if outermost is None:
            return normal_form.always_eventually(inner)
        p, q = outermost.args
        strong = normal_form.always_eventually(normal_form.substitute(inner, {outermost: normal_form.until(p, q)}))
        always = normal_form.always_eventually(normal_form.substitute(inner, {outermost: TRUE}))
        return self.normal(
            normal_form.disjunction((strong, normal_form.conjunction((normal_form.eventually_always(p), always))))
        )

    def _eventually_always(self, inner: Formula) -> Formula:
        outermost = _outermost(inner, "U")
        if outermost is None:
            return normal_form.eventually_always(inner)
        p, q = outermost.args
        weak = normal_form.eventually_always(normal_form.substitute(inner, {outermost: normal_form.weak_until(p, q)}))
        never = normal_form.eventually_always(normal_form.substitute(inner, {outermost: FALSE}))
        return self.normal(
            normal_form.disjunction((normal_form.conjunction((normal_form.always_eventually(q), weak)), never))
        )

    def flat(self, formula: Formula) -> Formula:
        """Return an equivalent formula without any ``U`` inside a ``W``, except within ``G F p`` and ``F G p``."""
        result = self._flat.get(formula)
        if result is None:
            self._spend()
            result = self._flat[formula] = self._flatten(formula)
        return result

    def _spend(self) -> None:
        self._steps += 1
        if self._steps > _MOST_STEPS:
            raise OutOfWork

    def _flatten(self, formula: Formula) -> Formula:
        if normal_form.is_rigid(formula) or not formula.args or formula.op == "not":
            return formula
        if formula.op != "W" or not contains(formula, "U"):
            args = {argument: self.flat(argument) for argument in formula.args}
            if all(new is old for old, new in args.items()):
                return formula
            rebuilt = normal_form.substitute_operands(formula, args)
            return rebuilt if rebuilt is formula else self.flat(rebuilt)
        a, b = formula.args
        if contains(b, "U"):
            return self.flat(normal_form.disjunction((normal_form.until(a, b), normal_form.weak_until(a, FALSE))))
        outermost = _outermost(a, "U")
        if outermost is None:
            # Every U is within a G F p or F G p.
            raise OutOfWork
        p, q = outermost.args
        weak = normal_form.weak_until(normal_form.substitute(a, {outermost: normal_form.weak_until(p, q)}), b)
        never = normal_form.weak_until(normal_form.substitute(a, {outermost: FALSE}), FALSE)
        return self.flat(
            normal_form.disjunction(
                (
                    normal_form.conjunction((normal_form.always_eventually(q), weak)),
                    normal_form.until(a, normal_form.disjunction((b, never))),
                )
            )
        )


@lru_cache(maxsize=4096)
def _push_next(formula: Formula) -> Formula:
    if formula.op == "and":
        return normal_form.conjunction(map(_push_next, formula.args))
    if formula.op == "or":
        return normal_form.disjunction(map(_push_next, formula.args))
    return normal_form.next_(formula)


def _outermost(formula: Formula, op: str) -> Formula | None:
    """Return the first of the outermost subformulas with operator ``op``, or None if there is no such subformula.

    Subformulas within ``G F p`` and ``F G p`` do not count.
    """
    if formula.op == op:
        return formula
    if formula.op in ("G", "F") or not contains(formula, op):
        return None
    return next(filter(None, (_outermost(argument, op) for argument in formula.args)), None)
