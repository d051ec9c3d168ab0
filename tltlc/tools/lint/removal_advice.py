"""The help text of diagnostics about a clause that the spec does not need.

An episode is judged either as soon as it reaches the goal of the spec, or only at its limit of
steps. The clauses decide which, unless there is a ``judge`` clause. So if removing a clause would
change this, the help names the ``judge`` clause to add.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.default_judge import default_judge, judge_of
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.file_view import SpecView


def removal_help(part: Conjunct, remaining: Sequence[Conjunct], spec: SpecView) -> str:
    """Return the advice to remove the clause ``part``; ``remaining`` are the clauses that are then left."""
    if changes_judge(part, remaining, spec):
        return f"leave it out and write `judge at {spec.fspa.judge}`"
    return "leave it out"


def changes_judge(part: Conjunct, remaining: Sequence[Conjunct], spec: SpecView) -> bool:
    """Whether removing the clause ``part`` changes when the spec is judged: at its goal or at its limit.

    ``remaining`` are the clauses that are then left. A ``judge`` clause, or infinite traces, settle
    the question; then the result is False. Without them, a spec is judged at its limit if each of
    its clauses alone would be. So the result is also False if ``part`` alone would be judged at its
    limit.
    """
    if spec.spec.judge is not None or spec.spec.semantics == "infinite":
        return False
    if default_judge(part.unbounded or part.formula) == "limit":
        return False
    return judge_of(remaining) != judge_of(spec.spec.parts)
