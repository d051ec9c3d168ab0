"""TLT0419: a spec without a limit."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each spec without a limit in a file that is about episodes.

    Such a file has a spec with a limit, with `judge at`, or with a level. The specs of other files may
    be for recordings alone, which need no limit. There is no finding for a spec of the form
    `spec NAME = FORMULA`, which cannot have a limit.
    """
    if any(map(_is_for_episodes, view.specs)):
        for spec in view.specs:
            if spec.spec.limit_steps is None and spec.declaration.block:
                yield _finding(spec)


def _is_for_episodes(spec: SpecView) -> bool:
    return any(setting is not None for setting in (spec.spec.limit_steps, spec.spec.judge, spec.spec.level))


def _finding(spec: SpecView) -> RuleFinding:
    if spec.fspa.judge == "limit":
        message = "it is judged at its limit, so without one an episode makes no progress by lasting"
    else:
        message = "an episode that never gets there never ends, and a fast player gets no more than a slow one"
    if spec.spec.clock_varies:
        help_ = "say how many samples an episode may have, such as `limit 20000 steps`; recorded play needs no limit"
    else:
        example = "limit 3000 steps" if spec.spec.clock_s is None else "limit 5 min"
        help_ = f"say how long an episode may last, such as `{example}`; recorded play needs no limit"
    return RuleFinding(f"`{spec.spec.name}` has no limit", (spec.name_label(message),), help_)


RULE = LintRule("TLT0419", "note", check, lint_only=True)
