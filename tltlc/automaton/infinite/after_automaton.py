"""The after-automaton: its states are obligations, that is, what remains of the formula after the letters so far.

An *obligation* is a Boolean function of literals, of formulas with the outermost operator ``X``,
``U`` or ``W``, and of rigid formulas (:mod:`tltlc.automaton.infinite.normal_form`). It is stored
as a binary decision diagram (:class:`~tltlc.automaton.transitions.ObligationDiagrams`), so formulas
with the same function are one state.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.normal_form import conjunction, disjunction
from tltlc.automaton.transitions import FALSE, TRUE, ObligationDiagrams
from tltlc.automaton.work import OutOfWork
from tltlc.logic import formula as build
from tltlc.logic.bounded_operators import count_down, count_down_from
from tltlc.logic.formula import Formula

STEPS_PER_OBLIGATION: Final = 100
"""The steps of work that each successor of an obligation takes at least.

If an obligation has more successors than the work budget can pay for, the construction fails before
it lists them.
"""

_TEMPORAL: Final = ("U", "W", "X")


class ObligationAutomaton:
    """Computes obligations (what remains to be done), and what remains of them after a letter.

    A letter is the set of the atoms that hold at a sample. A function from the letter to the
    obligation that remains after the letter is a decision diagram in the table ``letters``. An
    obligation is a Boolean function in the table ``obligations``, and ``formulas[v]`` is the
    formula of its variable ``v``: an atom, a formula with the outermost operator ``X``, ``U`` or
    ``W``, or a rigid formula (``G F p`` or ``F G p``).

    Methods that build obligations raise :class:`~tltlc.automaton.diagrams.OutOfSteps` if an
    obligation becomes too large. Methods that build functions of letters also raise
    :class:`~tltlc.automaton.work.OutOfWork`.
    """

    def __init__(self, atoms: Sequence[str], letters: Diagrams[Any]) -> None:
        self.obligations = ObligationDiagrams()
        self.letters = letters
        self.formulas: list[Formula] = []
        self.atoms = tuple(atoms)
        self._atoms = {name: index for index, name in enumerate(atoms)}
        self._variables: dict[Formula, int] = {}
        self._of_formula: dict[Formula, int] = {}
        self._obligations: dict[Formula, int] = {}
        self._of_obligation: dict[int, int] = {FALSE: letters.leaf(FALSE), TRUE: letters.leaf(TRUE)}
        self._most_reached = letters.work.left // STEPS_PER_OBLIGATION
        self._both: dict[tuple[int, int], int] = {}
        self._either: dict[tuple[int, int], int] = {}
        self._sources: dict[int, Formula] = {FALSE: build.FALSE, TRUE: build.TRUE}

    def obligation(self, formula: Formula) -> int:
        """Return the obligation of a formula in the normal form of :mod:`tltlc.automaton.infinite.normal_form`."""
        obligation = self._obligations.get(formula)
        if obligation is not None:
            return obligation
        # Convert the shortest bound first, as over finite traces (`automaton/finite/successors.py`).
        chain = [formula, *count_down_from(formula, self._obligations)]
        for bound in chain[:-1]:
            self._variable(bound)
        for bound in reversed(chain):
            obligation = self._obligations[bound] = self._as_obligation(bound)
            known = self._sources.get(obligation)
            if known is None or _weight(bound) < _weight(known):
                self._sources[obligation] = bound
        assert obligation is not None
        return obligation

    def _as_obligation(self, formula: Formula) -> int:
        match formula.op:
            case "true":
                return TRUE
            case "false":
                return FALSE
            case "and" | "or":
                combine = self.obligations.both if formula.op == "and" else self.obligations.either
                result = self.obligation(formula.args[-1])
                for argument in reversed(formula.args[:-1]):
                    result = combine(self.obligation(argument), result)
                return result
            case "not":
                return self.obligations.node(self._variable(formula.args[0]), TRUE, FALSE)
        result = self.obligations.node(self._variable(formula), FALSE, TRUE)
        # This makes `p U q | q` and `p U q` one obligation, as over finite traces (`automaton/finite/successors.py`).
        for weaker in _weaker_subformulas(formula):
            result = self.obligations.both(result, self.obligation(weaker))
        for stronger in _stronger_subformulas(formula):
            result = self.obligations.either(result, self.obligation(stronger))
        return result

    def _variable(self, formula: Formula) -> int:
        number = self._variables.get(formula)
        if number is None:
            number = self._variables[formula] = len(self.formulas)
            self.formulas.append(formula)
        return number

    def after(self, obligation: int) -> int:
        """Return a decision diagram that maps each letter to the obligation that remains after the letter."""
        known = self._of_obligation
        if obligation in known:
            return known[obligation]
        absent, present = self.obligations.low, self.obligations.high
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
        """Return the result of :meth:`after` for an obligation, given the results for its two cofactors.

        ``absent`` is the result for the obligation with its first variable set to false,
        ``present`` with this variable set to true.
        """
        formula, letters = self.formulas[self.obligations.variable[obligation]], self.letters
        if formula.op == "atom":
            atom = self._atoms[formula.name]
            true, false = letters.leaf(TRUE), letters.leaf(FALSE)
            holds = self.both(letters.node(atom, false, true), present)
            return self.either(self.both(letters.node(atom, true, false), absent), holds)
        # Obligations are monotone in their temporal variables.
        return self.either(absent, self.both(self.of_formula(formula), present))

    def both(self, x: int, y: int) -> int:
        """Return the function whose value on each letter is the conjunction of the values of ``x`` and ``y``."""
        return self.letters.apply(self._with_counter(self.obligations.both), x, y, self._both)

    def either(self, x: int, y: int) -> int:
        """Return the function whose value on each letter is the disjunction of the values of ``x`` and ``y``."""
        return self.letters.apply(self._with_counter(self.obligations.either), x, y, self._either)

    def _with_counter(self, combine: Callable[[int, int], int]) -> Callable[[int, int], int]:
        """Return a function that calls ``combine`` and counts its distinct results.

        The function raises OutOfWork if there are more results than the work budget can pay for.
        """
        reached: set[int] = set()
        most = self._most_reached

        def counted(one: int, other: int) -> int:
            result = combine(one, other)
            reached.add(result)
            if len(reached) > most:
                raise OutOfWork
            return result

        return counted

    def of_formula(self, formula: Formula) -> int:
        """Return a decision diagram that maps each letter to what remains of a formula after the letter."""
        step = self._of_formula.get(formula)
        if step is None:
            step = self._of_formula[formula] = self._expand(formula)
        return step

    def _expand(self, formula: Formula) -> int:
        letters = self.letters
        match formula.op:
            case "true" | "false":
                return letters.leaf(TRUE if formula.op == "true" else FALSE)
            case "atom":
                return letters.node(self._atoms[formula.name], letters.leaf(FALSE), letters.leaf(TRUE))
            case "not":
                return letters.node(self._atoms[formula.args[0].name], letters.leaf(TRUE), letters.leaf(FALSE))
            case "and" | "or":
                combine = self.both if formula.op == "and" else self.either
                result = self.of_formula(formula.args[-1])
                for argument in reversed(formula.args[:-1]):
                    result = combine(self.of_formula(argument), result)
                return result
            case "X":
                return letters.leaf(self.obligation(formula.args[0]))
            case "U" | "W":
                left, right = map(self.of_formula, formula.args)
                return self.either(right, self.both(left, letters.leaf(self.obligation(formula))))
        # Rigid formulas do not change with time.
        return letters.leaf(self.obligation(formula))

    # --- obligations as formulas ------------------------------------------------------------------

    def formula(self, obligation: int) -> Formula:
        """Return a formula that is equivalent to an obligation.

        If :meth:`obligation` has converted formulas to this obligation, returns the smallest of
        them. Otherwise makes a formula from the decision diagram of the obligation.
        """
        known = self._sources.get(obligation)
        if known is None:
            obligations = self.obligations
            variable = self.formulas[obligations.variable[obligation]]
            absent, present = self.formula(obligations.low[obligation]), self.formula(obligations.high[obligation])
            if variable.op == "atom":
                negative = build.not_(variable)
                known = disjunction((conjunction((variable, present)), conjunction((negative, absent))))
            else:
                known = disjunction((absent, conjunction((variable, present))))
            self._sources[obligation] = known
        return known

    def replace_temporal(self, obligation: int, change: Callable[[Formula], int], memo: dict[int, int]) -> int:
        """Return the obligation with each temporal formula replaced by the obligation ``change(formula)``.

        ``memo`` caches results; pass the same dict only to calls with the same ``change``.
        """
        if obligation in (FALSE, TRUE):
            return obligation
        result = memo.get(obligation)
        if result is None:
            obligations = self.obligations
            formula = self.formulas[obligations.variable[obligation]]
            absent = self.replace_temporal(obligations.low[obligation], change, memo)
            present = self.replace_temporal(obligations.high[obligation], change, memo)
            if formula.op == "atom":
                holds = self.obligation(formula)
                fails = self.obligation(build.not_(formula))
                result = obligations.either(obligations.both(holds, present), obligations.both(fails, absent))
            else:
                result = obligations.either(absent, obligations.both(change(formula), present))
            memo[obligation] = result
        return result


def _weaker_subformulas(formula: Formula) -> Iterator[Formula]:
    """Yield some temporal subformulas that a temporal formula implies, such as ``F b`` for ``F(a & X F b)``."""
    if formula.op == "X" and formula.args[0].op == "and" and (shorter := count_down(formula)):
        yield shorter
    left, right = formula.args if formula.op in ("U", "W") else (None, None)
    if formula.op == "W" and right is build.FALSE and left is not None and left.op in _TEMPORAL:
        yield left
    if formula.op == "U" and left is build.TRUE and right is not None and right.op == "and":
        later = (part.args[0] if part.op == "X" else part for part in right.args)
        yield from (part for part in later if part.op == "U" and part.args[0] is build.TRUE)


def _stronger_subformulas(formula: Formula) -> Iterator[Formula]:
    """Yield some temporal subformulas that imply a temporal formula, such as ``b U c`` for ``a U (b U c)``."""
    if formula.op == "X" and formula.args[0].op == "or" and (shorter := count_down(formula)):
        yield shorter
    left, right = formula.args if formula.op in ("U", "W") else (None, None)
    if right is not None and right.op in _TEMPORAL:
        yield right
    if formula.op == "W" and right is build.FALSE and left is not None and left.op == "or":
        later = (part.args[0] if part.op == "X" else part for part in left.args)
        yield from (part for part in later if part.op == "W" and part.args[1] is build.FALSE)


def _weight(formula: Formula) -> int:
    return sum(1 for _ in formula.walk())
