"""Replace bounded operators by timers: registers that count steps, so that a bound costs no states.

Each rule replaces a formula by an equivalent one over atoms that read a register. The proofs are in
``docs/semantics.md``, "Deadlines". In the rules, ``p`` and ``q`` are formulas without temporal
operators, ``f`` is any formula, and ``passed(n, p)`` holds where p last held n or more steps ago, or
never. Without a p, the steps count from the first sample.

========================  ==============================================================
where it stands           rule
========================  ==============================================================
at the first sample       ``F[m,n] f`` is ``!passed(n) U (passed(m) & f)``
at the first sample       ``G[m,n] f`` is ``passed(n) R (passed(m) -> f)``, or ``G !breach`` if there are more
at the first sample       ``F G[0,n] p`` is ``F(p has held for n steps | p & !X true)``
at the first sample       ``F(p & X F G[0,n] q)`` is ``F(p & X F G[0,n] (q & previously once p))``
at the first sample       ``G(p -> F[0,n] q)`` is ``G !late & G(due -> X true)``
at the first sample       ``G(p -> N F[0,n] q)`` is the same for ``previously p``
at the first sample       ``G(p -> G[0,n] q)`` is ``G !breach``: a p is at most n steps old, and not q
at the first sample       ``G !F(p & X F[0,n-1] q)`` is ``G !(q & p at most n steps ago)``, also for more goals
anywhere                  ``F(p & X F[0,n-1] f)`` is ``F(p & X(!passed(n, p) U f))``
anywhere                  ``F(p & F[0,n] f)`` is ``F(p & (!passed(n, p) U f))``
at the first sample       a long chain of the last two is ``F chain`` (:mod:`tltlc.resolve.chains`)
========================  ==============================================================
"""

from __future__ import annotations

from itertools import pairwise

from tltlc.logic.formula import (
    TRUE,
    Formula,
    always,
    and_,
    bound_of,
    bounded,
    eventually,
    implies,
    next_,
    not_,
    or_,
    rebuild,
    release,
    time_bound_of,
    until,
    weak_next,
)
from tltlc.resolve.chains import Link, Segment, after, at_a_goal, is_long, segments, timed_goals
from tltlc.resolve.timers import Reached, TimedGoal, TimerAtoms, Timers, in_time
from tltlc.resolve.unfolding import bounded_parts
from tltlc.resolve.windows import Window, is_present, window_of


def with_timers(formula: Formula, timers: Timers, *, many_rules: bool = False) -> Formula:
    """Return an equivalent formula in which timers replace the bounded operators that have a rule.

    ``formula`` is a whole clause, which is judged from the first sample on. ``many_rules`` says that
    the spec has several rules for a time from the first sample: then their formulas need no states,
    but do not know when their time is over.
    """
    try:
        return _StepRewriting(timers, many_rules).at_start(formula)
    except RecursionError:
        return formula  # Operators nest too deep: the bounds become states.


def rules_from_start(formula: Formula) -> int:
    """Return how many conjuncts of a clause are rules for a time from the first sample, ``G[m,n] f``."""
    conjuncts = formula.args if formula.op == "and" else (formula,)
    windows = [window for window in map(window_of, conjuncts) if window is not None]
    return sum(1 for window in windows if window.op == "G") + sum(1 for part in conjuncts if is_timed_rule(part))


class Rewriting:
    """Replaces bounded operators by timers. Subclasses have the rules for a fixed clock and for one that varies.

    The rules return None for a formula that they do not cover.
    """

    def __init__(self, timers: TimerAtoms) -> None:
        self._atoms = timers
        self._inside: dict[Formula, Formula] = {}

    def stay(self, node: Formula, before: Formula) -> Formula | None:
        """Return ``F node``, where ``node`` asks to stay in a state for a time; ``before`` must hold all this time."""
        raise NotImplementedError

    def from_start(self, node: Formula) -> Formula | None:
        """Return a bounded operator, or a chain of them, whose time counts from the first sample."""
        raise NotImplementedError

    def response(self, clause: tuple[Formula, ...]) -> Formula | None:
        """Return ``G`` of a disjunction that says what must follow an event."""
        raise NotImplementedError

    def anchored(self, body: Formula, reached: Reached | None) -> Formula:
        """Return the body of ``F body``, in which a bounded operator may count from the samples of its conjuncts.

        ``reached`` holds at the samples that ``F`` may choose. It is None if ``F`` may choose any.
        """
        raise NotImplementedError

    def dual(self, inner: Formula, operand: Formula) -> Formula | None:
        """Return the bounded operator that ``!inner`` is, applied to the negated ``operand``."""
        raise NotImplementedError

    def timed_link(self, rest: Formula) -> Link | None:
        """Return a bounded operator that asks for the next goal of a chain; None for any other formula."""
        raise NotImplementedError

    def _long_chain(self, node: Formula) -> Formula | None:
        """Return ``node`` with atoms for its long segments; None if it is no long chain."""
        is_chain = node.op == "F" and is_long(self._segments(node.args[0]))
        return eventually(self._chain(node.args[0])[0]) if is_chain else None

    def _segments(self, body: Formula) -> list[Segment]:
        return segments(body, self.fits, self.timed_link)

    def _chain(self, body: Formula, first: Reached | None = None) -> tuple[Formula, list[TimedGoal] | None]:
        """Return the body of ``F body`` with atoms for its long segments, and the goals of the first if it is long.

        ``first`` must hold at its first goal; None if that may come at any sample.
        """
        timers, parts = self._atoms, self._segments(body)
        if not is_long(parts):
            return self.anchored(body, first), None
        firsts = [first]
        for segment, following in pairwise(parts):
            firsts.append(after(segment, following.goals[0].low, timers, firsts[-1]))
        outside, rest = dict(self._inside), parts[-1].rest
        rest = None if rest is None else self.inside(rest)
        for segment, before in zip(reversed(parts), reversed(firsts), strict=True):
            goals = timed_goals(segment, timers, before) if is_long([segment]) else None
            if goals is not None:
                chain = timers.chain(goals)
                result = chain if rest is None else and_(chain, rest)
            else:
                if rest is not None and segment.rest is not None:
                    self._inside[segment.rest] = rest
                result = self.anchored(segment.body, before if before is first else None)
            rest = at_a_goal(result, segment.goals[0].low)
        self._inside = outside
        return result, goals

    def fits(self, *formulas: Formula) -> bool:
        """Whether a timer can be about these formulas: they have no temporal operators, and are not too large."""
        return all(map(is_present, formulas)) and self._atoms.fits(*formulas)

    def at_start(self, node: Formula) -> Formula:
        """Return a formula that is equivalent to ``node`` at the first sample."""
        if not _is_bounded(node):
            return node
        if node.op in ("and", "or", "not", "implies", "iff"):
            return rebuild(node, tuple(self.at_start(operand) for operand in node.args))
        if node.op == "G":
            return self._invariant(node)
        known = self.from_start(node)
        if known is None and node.op == "F":
            known = self._stay_after(node.args[0], TRUE)
        return self.inside(node) if known is None else known

    def _stay_after(self, body: Formula, before: Formula) -> Formula | None:
        """Return ``F body``, where the last goal of a sequence asks to stay in a state for a time.

        ``before`` holds where the goals in front of ``body`` have come.
        """
        stay = self.stay(body, before)
        if stay is not None:
            return stay
        parts = body.args if body.op == "and" else (body,)
        temporal = [part for part in parts if not is_present(part)]
        present = and_(*(part for part in parts if part not in temporal))
        if len(temporal) != 1 or present is TRUE:
            return None
        later = temporal[0].op == "X"
        following = temporal[0].args[0] if later else temporal[0]
        goal = and_both(present, before)
        if following.op != "F" or not self.fits(goal):
            return None
        rest = self._stay_after(following.args[0], self._atoms.earlier(int(later), goal))
        return None if rest is None else eventually(and_(present, next_(rest) if later else rest))

    def _invariant(self, node: Formula) -> Formula:
        """Return ``G body`` with timers: a response or a rule for some time after an event, or several of them."""
        clauses = self._clauses(node.args[0])
        responses = [self.response(clause) for clause in clauses]
        if all(response is None for response in responses):
            return self.inside(node)
        return and_(
            *(
                self.inside(always(or_(*clause))) if response is None else response
                for clause, response in zip(clauses, responses, strict=True)
            )
        )

    def _clauses(self, body: Formula) -> list[tuple[Formula, ...]]:
        """Return disjunctions whose conjunction is ``body``; each is a tuple of its parts.

        Only disjunctions that have a rule need to be found, so anything else stays one part.
        """
        if body.op == "and":
            return [clause for part in body.args for clause in self._clauses(part)]
        if body.op == "implies" and is_present(body.args[0]):
            return [(negated(body.args[0]), *clause) for clause in self._clauses(body.args[1])]
        if body.op == "or":
            present = tuple(part for part in body.args if is_present(part))
            temporal = [part for part in body.args if part not in present]
            if len(temporal) == 1:
                return [(*present, *clause) for clause in self._clauses(temporal[0])]
        if body.op == "not" and (pushed := self._pushed(body.args[0])) is not None:
            return self._clauses(pushed)
        return [(body,)]

    def _pushed(self, inner: Formula) -> Formula | None:
        """Return ``!inner`` with the negation moved to the operands; None if ``inner`` has no time or no such form."""
        if is_present(inner):
            return None
        operands = tuple(negated(operand) for operand in inner.args)
        if inner.op in ("and", "or"):
            return (or_ if inner.op == "and" else and_)(*operands)
        if inner.op == "implies":
            return and_(inner.args[0], operands[1])
        if inner.op in ("X", "N"):
            operand = self._pushed(inner.args[0]) or operands[0]
            return (weak_next if inner.op == "X" else next_)(operand)
        dual = self.dual(inner, operands[0])
        return None if dual is None else self._atoms.in_place_of(inner, dual)

    def inside(self, node: Formula) -> Formula:
        """Return a formula that is equivalent to ``node`` at every sample."""
        if not _is_bounded(node):
            return node
        known = self._inside.get(node)
        if known is None:
            if node.op == "F":
                known = eventually(self.anchored(node.args[0], None))
            else:
                known = rebuild(node, tuple(self.inside(operand) for operand in node.args))
                if node.op in ("F[]", "G[]"):
                    known = self._atoms.in_place_of(node, known)
            self._inside[node] = known
        return known


class _StepRewriting(Rewriting):
    """The rules for bounds in steps."""

    def __init__(self, timers: Timers, many_rules: bool) -> None:
        super().__init__(timers)
        self._timers, self._many_rules = timers, many_rules

    def stay(self, node: Formula, before: Formula) -> Formula | None:
        window = window_of(node)
        if window is None or window.op != "G" or window.low or window.high == 0:
            return None
        state = and_both(window.body, before)
        return stay_for(state, self._timers.held(window.high, state)) if self.fits(state) else None

    def from_start(self, node: Formula) -> Formula | None:
        window = window_of(node)
        return self._long_chain(node) if window is None else self._window_from_start(window)

    def _window_from_start(self, window: Window) -> Formula:
        timers = self._timers
        if window.high == 0:
            return self.at_start(window.body)
        begun = timers.passed(window.low) if window.low else None
        if window.op == "F":
            first = Reached(timers.between(window.low, window.high), f"within {timers.time(window.high)}")
            body, goals = self._chain(window.body, first)
            is_over = timers.passed(window.high) if goals is None else timers.lost(goals, window.high)
            return until(not_(is_over), body if begun is None else and_(begun, body))
        if self._many_rules and self.fits(window.body):
            rule = always(not_(timers.breach_from_start(window.low, window.high, window.body)))
            return and_(next_(TRUE), rule) if window.exists else rule
        body = self.inside(window.body)
        result = release(timers.lasted(window.high), body if begun is None else implies(begun, body))
        return and_(next_(TRUE), result) if window.exists else result

    def response(self, clause: tuple[Formula, ...]) -> Formula | None:
        temporal = [part for part in clause if not is_present(part)]
        if len(clause) == 1 and clause[0].op == "not" and clause[0].args[0].op == "F":
            return self._never(clause[0].args[0])
        if len(temporal) != 1:
            return None
        request = and_(*(negated(part) for part in clause if part is not temporal[0]))
        window = window_of(temporal[0])
        if window is None and temporal[0].op == "N" and self.fits(request):
            # A request at the last sample asks for nothing, so it counts from the sample after it.
            window, request = window_of(temporal[0].args[0]), self._timers.previous(request)
        if window is None or window.low > 1 or window.high == 0:
            return None
        if window.op == "G" and window.body.op == "not" and not is_present(window.body) and not window.exists:
            goal = bounded("F[]", window.low, window.high, window.body.args[0])
            return self._never(eventually(and_both(goal, request)))
        if not self.fits(request, window.body):
            return None
        if window.op == "F":
            due, late = self._timers.response(request, window.body, window.low, window.high)
            return and_(always(not_(late)), always(implies(due, next_(TRUE))))
        rule = always(not_(self._timers.breach(window.low, window.high, request, window.body)))
        return and_(rule, always(implies(self._timers.now(request), next_(TRUE)))) if window.exists else rule

    def _never(self, node: Formula) -> Formula | None:
        """Return ``G !node`` for a chain ``node``: that its last goal never comes in time."""
        parts = self._segments(node.args[0])
        if is_long(parts):
            return not_(self.at_start(node))  # `G !F f` is `!F f`.
        if len(parts) != 1 or parts[0].rest is not None or len(parts[0].goals) < 2:
            return None
        return always(not_(timed_goals(parts[0], self._timers, None)[-1].event))

    def dual(self, inner: Formula, operand: Formula) -> Formula | None:
        bound = bound_of(inner)
        if bound is None:
            return None
        return bounded("G[]" if inner.op == "F[]" else "F[]", bound.low, bound.high, operand)

    def timed_link(self, rest: Formula) -> Link | None:
        window = window_of(rest)
        if window is None or window.op != "F" or not window.low <= 1 <= window.high:
            return None
        return Link(window.low, window.high, window.body)

    def anchored(self, body: Formula, reached: Reached | None) -> Formula:
        parts = body.args if body.op == "and" else (body,)
        temporal = [part for part in parts if not is_present(part)]
        window = window_of(temporal[0]) if len(temporal) == 1 else None
        present = [part for part in parts if part not in temporal]
        if window is None or window.op != "F" or window.low > 1 or window.high == 0 or not present:
            return self.inside(body)
        anchor, event_words = and_(*present), self._timers.text(and_(*present))
        if reached is not None:
            anchor, event_words = and_(anchor, reached.formula), f"{event_words} {reached.words}"
        if not self.fits(anchor):
            return self.inside(body)
        words = in_time(window.low, self._timers.time(window.high), event_words)
        recent = self._timers.recent(window.low, window.high, anchor, event_words)
        goal = self.anchored(window.body, Reached(recent, words))
        waiting = until(not_(self._timers.passed(window.high, anchor, event_words)), goal)
        return and_(*present, next_(waiting) if window.low else waiting)


def stay_for(state: Formula, held: Formula) -> Formula:
    """Return that ``state`` has held for a time, which ``held`` says, or holds at the last sample."""
    return eventually(or_(held, and_(state, not_(next_(TRUE)))))


def and_both(formula: Formula, condition: Formula) -> Formula:
    """Return ``formula & condition``; the formula alone where the condition is TRUE."""
    return formula if condition is TRUE else and_(formula, condition)


def is_timed_rule(formula: Formula) -> bool:
    """Whether a formula is a rule for a time in seconds, ``G f`` with a :class:`~tltlc.logic.formula.TimeBound`."""
    return formula.op == "G[]" and time_bound_of(formula) is not None


def negated(formula: Formula) -> Formula:
    """Return the negation of a formula, without a double negation."""
    return formula.args[0] if formula.op == "not" else not_(formula)


def _is_bounded(node: Formula) -> bool:
    return any(True for _ in bounded_parts(node))
