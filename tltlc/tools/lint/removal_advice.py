"""The help of diagnostics about a clause that the spec does not need.

Removing the clause may change whether the spec is judged at its goal or at its limit. Then the help
names the ``judge`` clause with which the spec is still judged as before.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.default_judge import default_judge, judge_of
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.file_view import SpecView


def removal_help(part: Conjunct, remaining: Sequence[Conjunct], spec: SpecView) -> str:
    """Return the advice to remove ``part``, after which the conjuncts ``remaining`` are left."""
    if changes_judge(part, remaining, spec):
        return f"leave it out and write `judge at {spec.fspa.judge}`"
    return "leave it out"


def changes_judge(part: Conjunct, remaining: Sequence[Conjunct], spec: SpecView) -> bool:
    """Whether removing ``part``, which leaves ``remaining``, changes when the spec is judged.

    False if the spec has a ``judge`` clause, or is over infinite traces. Also False if ``part``
    alone would be judged at its limit: a spec is judged at its limit if each of its conjuncts alone
    would be, so the removal changes nothing.
    """
    if spec.spec.judge is not None or spec.spec.semantics == "infinite":
        return False
    if default_judge(part.unbounded or part.formula) == "limit":
        return False
    return judge_of(remaining) != judge_of(spec.spec.parts)
