"""Compute the transition of a formula or an obligation: what remains to be done after one letter.

Each temporal operator has an expansion law on finite traces:
``F p = p | X F p``, ``G p = p & N G p``, ``p U q = q | p & X(p U q)``,
``p W q = q | p & N(p W q)``, ``p R q = q & (p | N(p R q))``, ``p M q = q & (p | X(p M q))``.
``X p`` and ``N p`` leave the obligation p; if the trace ends, ``X p`` rejects and ``N p`` accepts.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.transitions import ACCEPT, FALSE, REJECT, TRUE, TransitionDiagrams
from tltlc.logic.bounded_operators import count_down, count_down_from
from tltlc.logic.formula import Formula


class Successors:
    """Computes the transitions of obligations and of formulas, in one table of decision diagrams.

    The formulas must be in negation normal form. An obligation says what remains to be done, as a
    Boolean function of variables; a variable is an int. ``formulas[v]`` is the formula of variable
    ``v``: an atom, or a formula whose outermost operator is temporal. A variable can also be a
    state of a smaller automaton that was built for a part of the formula (:meth:`new_state`). Then
    ``formulas[v]`` is None, and ``stands_for[v]`` is the obligation that remains in this state.
    """

    __slots__ = (
        "_atom_index",
        "_obligation_of",
        "_of_formula",
        "_of_obligation",
        "_of_state",
        "_variables",
        "diagrams",
        "formulas",
        "stands_for",
    )

    def __init__(self, atoms: Sequence[str], diagrams: TransitionDiagrams) -> None:
        self.diagrams = diagrams
        self.formulas: list[Formula | None] = []
        self.stands_for: dict[int, int] = {}
        self._variables: dict[Formula, int] = {}
        self._atom_index = {name: index for index, name in enumerate(atoms)}
        self._obligation_of: dict[Formula, int] = {}
        self._of_formula: dict[Formula, int] = {}
        self._of_state: dict[int, int] = {}
        self._of_obligation: dict[int, int] = {FALSE: REJECT, TRUE: ACCEPT}

    def number_variables(self, formula: Formula) -> None:
        """Give each temporal subformula of a formula the next free variable, in the order of the formula.

        The variables of a subformula are then next to each other, which keeps the decision diagrams
        small: for a conjunction of six formulas ``G(a -> F b)``, their operations take a third of
        the steps.
        """
        for part in formula.walk():
            if part.is_temporal:
                self.variable(part)

    def obligation(self, formula: Formula) -> int:
        """Return the obligation of a formula: its Boolean function over atoms and temporal subformulas."""
        known = self._obligation_of.get(formula)
        if known is not None:
            return known
        # Convert the shortest bound first, so that long bounds need no deep recursion. Before that, number the
        # variables from the longest bound to the shortest.
        chain = [formula, *count_down_from(formula, self._obligation_of)]
        for bound in chain[:-1]:
            self.variable(bound)
        for bound in reversed(chain):
            known = self._obligation_of[bound] = self._as_obligation(bound)
        assert known is not None
        return known

    def _as_obligation(self, formula: Formula) -> int:
        op = formula.op
        diagrams = self.diagrams
        if op == "and" or op == "or":
            combine, result = (diagrams.obligations.both, TRUE) if op == "and" else (diagrams.obligations.either, FALSE)
            for argument in reversed(formula.args):
                result = combine(self.obligation(argument), result)
            return result
        if op == "true" or op == "false":
            return TRUE if op == "true" else FALSE
        if op == "not":
            return diagrams.obligations.node(self.variable(formula.args[0]), TRUE, FALSE)
        result = diagrams.obligations.node(self.variable(formula), FALSE, TRUE)
        for weaker in _weaker_subformulas(formula):
            result = diagrams.obligations.both(result, self.obligation(weaker))
        for stronger in _stronger_subformulas(formula):
            result = diagrams.obligations.either(result, self.obligation(stronger))
        return result

    def variable(self, formula: Formula) -> int:
        """Return the variable of an atom or a temporal formula; a formula without a variable gets the next free one."""
        number = self._variables.get(formula)
        if number is None:
            number = self._variables[formula] = len(self.formulas)
            self.formulas.append(formula)
        return number

    def new_state(self, stands_for: int) -> int:
        """Return a new obligation, a single variable, that represents a state of a smaller automaton.

        The smaller automaton was built for a part of the formula. ``stands_for`` is the obligation
        that remains in the state. Call :meth:`define_state` next to set the transition of the new
        obligation.
        """
        variable = len(self.formulas)
        self.formulas.append(None)
        self.stands_for[variable] = stands_for
        return self.diagrams.obligations.node(variable, FALSE, TRUE)

    def define_state(self, state: int, transition: int) -> None:
        """Set the transition of an obligation that :meth:`new_state` returned."""
        self._of_state[self.diagrams.obligations.variable[state]] = transition

    def of_obligation(self, obligation: int) -> int:
        """Return the transition of an obligation: a decision diagram that maps each letter to what remains after it.

        Each leaf also says whether a trace that ends with the letter is accepted.
        """
        known = self._of_obligation
        if obligation in known:
            return known[obligation]
        absent, present = self.diagrams.obligations.low, self.diagrams.obligations.high
        # An explicit stack replaces recursion: obligations are as deep as bounds are long.
        stack = [obligation]
        while stack:
            node = stack[-1]
            missing = [child for child in (present[node], absent[node]) if child not in known]
            if missing:
                stack += missing
                continue
            stack.pop()
            if node not in known:
                known[node] = self._by_variable(node, known[absent[node]], known[present[node]])
        return known[obligation]

    def _by_variable(self, obligation: int, absent: int, present: int) -> int:
        """Return the transition of an obligation, given the transitions of its two cofactors.

        ``absent`` is the transition of the obligation with its first variable set to false,
        ``present`` with this variable set to true.
        """
        diagrams = self.diagrams
        variable = diagrams.obligations.variable[obligation]
        formula = self.formulas[variable]
        if formula is None:
            return diagrams.disjoin(absent, diagrams.conjoin(self._of_state[variable], present))
        if formula.op == "atom":
            holds = self.of_formula(formula)
            fails = diagrams.node(self._atom_index[formula.name], ACCEPT, REJECT)
            return diagrams.disjoin(diagrams.conjoin(holds, present), diagrams.conjoin(fails, absent))
        # In negation normal form obligations are monotone in their temporal variables, so `absent` implies `present`.
        return diagrams.disjoin(absent, diagrams.conjoin(self.of_formula(formula), present))

    def of_formula(self, formula: Formula) -> int:
        """Return the transition of a formula in negation normal form, as :meth:`of_obligation` describes it."""
        known = self._of_formula
        result = known.get(formula)
        if result is not None:
            return result
        stack = [formula]
        while stack:
            node = stack[-1]
            if node in known:
                stack.pop()
                continue
            # The operand of X or N is the obligation that remains: its transition is not needed here.
            missing = [] if node.op in ("X", "N") else [argument for argument in node.args if argument not in known]
            if missing:
                stack.extend(missing)
            else:
                stack.pop()
                known[node] = self._expand(node)
        return known[formula]

    def _expand(self, formula: Formula) -> int:
        op, args, known, diagrams = formula.op, formula.args, self._of_formula, self.diagrams
        conjoin, disjoin = diagrams.conjoin, diagrams.disjoin
        if op == "atom":
            return diagrams.node(self._atom_index[formula.name], REJECT, ACCEPT)
        if op == "not":
            return diagrams.node(self._atom_index[args[0].name], ACCEPT, REJECT)
        if op == "true":
            return ACCEPT
        if op == "false":
            return REJECT
        if op == "and" or op == "or":
            operate = conjoin if op == "and" else disjoin
            result = known[args[-1]]
            for argument in reversed(args[:-1]):
                result = operate(known[argument], result)
            return result
        if op == "X" or op == "N":
            return diagrams.leaf((self.obligation(args[0]), int(op == "N")))
        again = diagrams.leaf((self.obligation(formula), int(op in "GWR")))
        if op == "F":
            return disjoin(known[args[0]], again)
        if op == "G":
            return conjoin(known[args[0]], again)
        left, right = known[args[0]], known[args[1]]
        if op in "UW":
            return disjoin(right, conjoin(left, again))
        if op in "RM":
            return conjoin(right, disjoin(left, again))
        raise ValueError(f"not in negation normal form: {op}")


# The obligation of a temporal formula includes the subformulas that imply it or that it implies. So `p U q | q` and
# `p U q` are one obligation, and so are `F(p & X F q) | F q` and `F q`. For n nested untils, or n goals in sequence,
# this gives n obligations instead of 2^n. `G(a -> F[0,n] b)` counts down many bounds at once: only the shortest stays.


def _weaker_subformulas(formula: Formula) -> list[Formula]:
    """Return some temporal subformulas that a temporal formula implies, such as ``F b`` for ``F(a & X F b)``."""
    op, args = formula.op, formula.args
    if op in ("X", "N") and args[0].op == "and" and (shorter := count_down(formula)):
        return [shorter]
    if op in ("G", "R", "M") and args[-1].is_temporal:
        return [args[-1]]
    if op == "F" and args[0].op == "and":
        later = (part.args[0] if part.op == "X" else part for part in args[0].args)
        return [part for part in later if part.op == "F"]
    return []


def _stronger_subformulas(formula: Formula) -> list[Formula]:
    """Return some temporal subformulas that imply a temporal formula, such as ``G b`` for ``a U G b``."""
    op, args = formula.op, formula.args
    if op in ("X", "N") and args[0].op == "or" and (shorter := count_down(formula)):
        return [shorter]
    if op in ("F", "U", "W") and args[-1].is_temporal:
        return [args[-1]]
    if op == "G" and args[0].op == "or":
        later = (part.args[0] if part.op == "N" else part for part in args[0].args)
        return [part for part in later if part.op == "G"]
    return []
