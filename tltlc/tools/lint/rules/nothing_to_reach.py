"""TLT0420: a spec with a limit and without a goal, which does not say when it is judged."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.logic.formula import Formula
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.listed_names import listed_names
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each spec whose episodes are judged at the limit only because it has no goal."""
    for spec in view.specs:
        # A block without a limit gets TLT0419, and a settled spec gets a warning of the compiler.
        has_other_finding = spec.is_settled or spec.spec.limit_steps is None
        if _is_judged_at_limit(spec) and spec.spec.judge is None and not has_other_finding:
            label = spec.name_label(
                "it rewards an episode for lasting: progress is the share of its limit that has passed"
            )
            help_ = "add a goal with `reach`, or write `judge at limit` if you mean this"
            yield RuleFinding(f"`{spec.spec.name}` has no goal, so it is judged at its limit", (label,), help_)


def _is_judged_at_limit(spec: SpecView) -> bool:
    # Over infinite traces, a spec with a goal is also judged at its limit if the goal does not decide the spec.
    endless = spec.spec.semantics == "infinite"
    lasts = not endless or (spec.fspa.states[0].distance == 0 and not _has_recurrence(spec.spec.formula))
    return spec.fspa.judge == "limit" and lasts


def _has_recurrence(formula: Formula) -> bool:
    """Whether the formula requires something to happen again and again (`always eventually`)."""
    return any(part.op == "G" and part.args[0].op == "F" for part in formula.walk())


def join(group: Sequence[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return one finding for all of a file."""
    title = f"{len(group):,} specs have no goal, so they are judged at their limits: {listed_names(group)}"
    return (replace(group[0], title=title),)


RULE = LintRule("TLT0420", "note", check, lint_only=True, join=join)
