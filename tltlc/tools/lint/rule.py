"""The types of lint rules and their findings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from tltlc.core.record import record
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix, Label, Severity

if TYPE_CHECKING:
    from tltlc.tools.lint.file_view import FileView


@record
class RuleFinding:
    """What a rule reports: a :class:`~tltlc.diagnostics.diagnostic.Diagnostic` without code and severity.

    :func:`~tltlc.tools.lint.run.findings` adds the code and the severity of the rule. A fix must
    not change the meaning of any spec in the file.
    """

    title: str
    labels: tuple[Label, ...]
    help: str
    fix: Fix | None = None


@record
class LintRule:
    """A lint rule. The documentation page of its code says what it finds, and what to write instead.

    ``check`` is a pure function from a file to findings. ``supersedes`` lists the codes of less
    specific diagnostics. Such a diagnostic is dropped if each of its labels covers a label of a finding
    that supersedes it, unless the diagnostic is more severe than the finding. ``lint_only`` is for rules
    about training, names or sizes: ``tltlc check``, which asks whether a spec means what was meant,
    leaves their findings out. ``join`` replaces several findings in a file by fewer that say the same
    (:func:`tltlc.tools.lint.joining.joined`).
    """

    code: str
    severity: Severity
    check: Callable[[FileView], Iterable[RuleFinding]]
    supersedes: tuple[str, ...] = ()
    lint_only: bool = False
    join: Callable[[Sequence[Diagnostic]], tuple[Diagnostic, ...]] | None = None


@record
class LintFinding:
    """A diagnostic that the linter reports: from a rule, from the compiler, or about a comment."""

    diagnostic: Diagnostic

    @property
    def fix(self) -> tuple[Edit, ...]:
        """The edits of the diagnostic's first safe fix; () if there is none.

        A safe fix does not change the meaning of any spec.
        """
        return next((fix.edits for fix in self.diagnostic.fixes if fix.applicability == "safe"), ())


def removal_fix(title: str, spans: Iterable[Span]) -> Fix:
    """Return a safe fix that deletes these spans."""
    return Fix(title, tuple(Edit(span, "") for span in spans), "safe")
