"""Advice on a clause that the spec does not need: leave it out, and say when to judge if that changes."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.judge import default_judge, judge_of
from tltlc.resolve.spec import Part
from tltlc.tools.lint.file_view import SpecView


def leave_out(part: Part, left: Sequence[Part], spec: SpecView) -> str:
    """Return the advice to leave a clause out, which is one of the parts; ``left`` are those that remain."""
    if changes_judge(part, left, spec):
        return f"leave it out and say `judge at {spec.fspa.judge}`"
    return "leave it out"


def changes_judge(part: Part, left: Sequence[Part], spec: SpecView) -> bool:
    """Whether a spec without a part, of which these parts are left, would be judged at another moment.

    A spec is judged at its limit if each of its parts alone would be, so a part that would be changes nothing.
    """
    if spec.spec.judge is not None or spec.spec.semantics == "infinite":
        return False
    if default_judge(part.unbounded or part.formula) == "limit":
        return False
    return judge_of(left) != judge_of(spec.spec.parts)
