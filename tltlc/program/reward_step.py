"""The statements that compute the progress and the reward of one step, and whether the episode ends.

They do what :mod:`tltlc.monitor.progress_and_reward` does with its default options (Algorithm 1 of
Gutiérrez-Sánchez et al. 2024).
"""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.program.states import PROGRESS
from tltlc.program.tree import (
    Any,
    Assign,
    BinaryNumber,
    Compare,
    Declare,
    If,
    Int,
    Not,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
)

STEPS, STEPS_REAL, BEST, REWARD, DONE, ENDS, VIOLATED, SATISFIED = (
    *("steps", "steps_real", "best", "reward", "done", "ends", "violated", "satisfied"),
)
"""The variables of :func:`statements`.

- ``STEPS`` and ``STEPS_REAL`` are the number of this step, from 1, as an int and as a real number.
  ``ENDS`` says whether an episode ends when it enters the new state. ``VIOLATED`` and ``SATISFIED``
  say whether this is the verdict of the new state. The statements only read these variables.
- ``BEST`` is the best progress so far, and ``DONE`` says whether the episode is over. The
  statements read and assign them.
- ``REWARD`` is the reward of this step. The statements assign it.
"""
BEFORE = "before"
"""The best progress before this step."""


def statements(fspa: Fspa) -> tuple[Statement, ...]:
    """Return the statements that compute progress, reward and the end of the episode.

    The statements run after each transition of the automaton.
    """
    limit = fspa.limit_steps
    if fspa.registers and limit is None and fspa.judge == "limit" and not _may_be_satisfied(fspa):
        # No step makes progress.
        ends = (Assign(DONE, ProgramVariable(ENDS)),)
        return (Assign(REWARD, Real(0.0)), If(((Not(ProgramVariable(DONE)), ends),)))
    steps, zero = ProgramVariable(STEPS), Real(0.0)
    lines: list[Statement] = [] if fspa.judge == "goal" else _survived(limit)
    lines.append(Declare(BEFORE, "real", ProgramVariable(BEST)))
    lines.append(
        If(
            (
                (
                    Compare(">", ProgramVariable(PROGRESS), ProgramVariable(BEST)),
                    (Assign(BEST, ProgramVariable(PROGRESS)),),
                ),
            )
        )
    )
    gained = BinaryNumber("-", ProgramVariable(BEST), ProgramVariable(BEFORE))
    if limit is None:
        going_on: tuple[Statement, ...] = (Assign(REWARD, gained), Assign(DONE, ProgramVariable(ENDS)))
    else:
        whole = Real(float(limit))
        remaining = BinaryNumber("/", BinaryNumber("-", whole, ProgramVariable(STEPS_REAL)), whole)
        going_on = (
            Assign(REWARD, BinaryNumber("-", gained, Real(1 / limit))),
            If(
                ((ProgramVariable(VIOLATED), (Assign(REWARD, BinaryNumber("-", ProgramVariable(REWARD), remaining)),)),)
            ),
            Assign(DONE, Any((ProgramVariable(ENDS), Compare(">=", steps, Int(limit))))),
        )
    lines.append(If(((ProgramVariable(DONE), (Assign(REWARD, zero),)),), going_on))
    return tuple(lines)


def _may_be_satisfied(fspa: Fspa) -> bool:
    return any(state.verdict == "satisfied" for state in fspa.states)


def _survived(limit: int | None) -> list[Statement]:
    """Return statements that compute the progress of a spec that is judged at its limit of steps.

    The progress is the number of steps so far divided by the limit. It is 1 as soon as the spec is
    satisfied, and 0 as soon as it is violated. Without a limit, it is 0 until the spec is
    satisfied.
    """
    cases: list[tuple[ProgramExpression, tuple[Statement, ...]]] = [
        (ProgramVariable(SATISFIED), (Assign(PROGRESS, Real(1.0)),)),
    ]
    if limit is None:
        return [Declare(PROGRESS, "real"), If(tuple(cases), (Assign(PROGRESS, Real(0.0)),))]
    cases.append((ProgramVariable(VIOLATED), (Assign(PROGRESS, Real(0.0)),)))
    cases.append((Compare(">=", ProgramVariable(STEPS), Int(limit)), (Assign(PROGRESS, Real(1.0)),)))
    share = BinaryNumber("/", ProgramVariable(STEPS_REAL), Real(float(limit)))
    return [Declare(PROGRESS, "real"), If(tuple(cases), (Assign(PROGRESS, share),))]
