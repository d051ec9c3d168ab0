"""The advice to leave out a clause that the spec does not need.

If that changes when the spec is judged, the advice says what to write instead.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.judge import default_judge, judge_of
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.file_view import SpecView


def leave_out(part: Conjunct, left: Sequence[Conjunct], spec: SpecView) -> str:
    """Return the advice to leave out ``part``. ``left`` are the parts that remain."""
    if changes_judge(part, left, spec):
        return f"leave it out and say `judge at {spec.fspa.judge}`"
    return "leave it out"


def changes_judge(part: Conjunct, left: Sequence[Conjunct], spec: SpecView) -> bool:
    """Whether leaving out ``part``, so that ``left`` remain, changes when the spec is judged.

    A spec is judged at its limit if each of its parts alone would be. So leaving out a part that is
    judged at the limit changes nothing.
    """
    if spec.spec.judge is not None or spec.spec.semantics == "infinite":
        return False
    if default_judge(part.unbounded or part.formula) == "limit":
        return False
    return judge_of(left) != judge_of(spec.spec.parts)
