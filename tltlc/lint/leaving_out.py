"""Advice on a clause that the spec does not need: leave it out, and say when to judge if that changes."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.judge import judge_of
from tltlc.lint.view import SpecView
from tltlc.resolve.spec import Part


def leave_out(left: Sequence[Part], spec: SpecView) -> str:
    """Return the advice to leave a clause out; ``left`` are the parts of the spec that remain."""
    if changes_judge(left, spec):
        return f"leave it out and say `judge at {spec.fspa.judge}`"
    return "leave it out"


def changes_judge(left: Sequence[Part], spec: SpecView) -> bool:
    """Whether a spec with these of its parts alone would be judged at another moment."""
    if spec.spec.judge is not None or spec.spec.semantics == "infinite":
        return False
    return judge_of(left) != judge_of(spec.spec.parts)
