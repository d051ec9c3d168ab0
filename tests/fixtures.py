"""Handwritten automata, for tests that must not depend on the construction of automata."""

from __future__ import annotations

from tltlc.automaton.fspa import Edge, Fspa, Guard, State
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When
from tltlc.logic.formula import FALSE, TRUE, always, and_, atom, eventually, not_, then
from tltlc.resolve import spec


def cover_and_hide() -> Fspa:
    """Return the automaton of Fig. 3 of the paper, with exclusive goals and a limit of 400 steps.

    The three goals are button 1, button 2 and the exit. The states are: 0 the whole formula, 1
    button 1 is pressed, 2 the trap, 3 both buttons are pressed, 4 the exit is reached.
    """
    a, b, c, p = "near(s1)", "near(s2)", "near(exit)", "alive"
    goal = always(atom(p))
    third = and_(eventually(atom(c)), goal)
    second = and_(then(atom(b), atom(c)), goal)
    whole = and_(then(atom(a), then(atom(b), atom(c))), goal)
    dead = Guard(not_(atom(p)), (((3, False),),))
    safe = Guard(atom(p), (((3, True),),))
    return Fspa(
        name="cover_and_hide",
        doc="Button 1, then button 2, then the exit, without dying.",
        formula=whole,
        level="cover_and_hide",
        limit_steps=400,
        judge="goal",
        semantics="finite",
        tags=("paper",),
        clock_s=0.05,
        signals=(
            *(spec.Signal("distance", "length", 0.0, None, "", (entity,)) for entity in ("s1", "s2", "exit")),
            spec.Signal("health", "ratio", 0.0, 1.0),
        ),
        params=(spec.Param("level_size", "length", 20.0, 2.0, 10_000.0),),
        atoms=(
            *(spec.Atom("near", near(f"distance({entity})"), "", (entity,)) for entity in ("s1", "s2", "exit")),
            spec.Atom(p, SignalValue("health"), "The character has health left."),
        ),
        exclusive=((0, 1, 2),),
        states=(
            State(0, whole, False, "pending", 3),
            State(1, second, False, "pending", 2),
            State(2, FALSE, False, "violated", None),
            State(3, third, False, "pending", 1),
            State(4, goal, True, "holding", 0),
        ),
        edges=(
            Edge(0, 0, _stay(0, a)),
            Edge(0, 1, _advance(0, a)),
            Edge(0, 2, dead),
            Edge(1, 1, _stay(1, b)),
            Edge(1, 2, dead),
            Edge(1, 3, _advance(1, b)),
            Edge(2, 2, Guard(TRUE, ((),))),
            Edge(3, 2, dead),
            Edge(3, 3, _stay(2, c)),
            Edge(3, 4, _advance(2, c)),
            Edge(4, 2, dead),
            Edge(4, 4, safe),
        ),
        spec_size=3,
    )


def near(distance: str, close: float = 1.0, far: str = "level_size") -> Expression:
    """Return the closeness, Eq. 2 of the paper, for a ``distance`` signal.

    It is 1 at distance 0, 0 at distance ``close``, and -1 from the distance of the param ``far``
    on.
    """
    d, reach, one = SignalValue(distance), ParamValue(far), Const(1.0)
    share = Op("/", (Op("-", (reach, d)), Op("-", (reach, Const(close)))))
    return When(
        (
            (Condition("<", (d, Const(close))), Op("-", (one, Op("/", (d, Const(close)))))),
            (Condition("<=", (d, reach)), Op("-", (Op("^", (share, Const(2.0))), one))),
        ),
        Const(-1.0),
    )


def _advance(goal: int, name: str) -> Guard:
    return Guard(and_(atom(name), atom("alive")), (((goal, True), (3, True)),))


def _stay(goal: int, name: str) -> Guard:
    """Return the guard "alive and not at the goal".

    ``goal`` is the index of the atom ``name``. Because the goals are exclusive, being at another
    goal also implies the guard. So each of the two other goals gives a prime.
    """
    other_goals = [((other, True), (3, True)) for other in range(3) if other != goal]
    primes = sorted([((goal, False), (3, True)), *other_goals])
    return Guard(and_(not_(atom(name)), atom("alive")), tuple(primes))
