"""The types of lint rules and their findings."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from tltlc.core.record import record
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix, Label, Severity

if TYPE_CHECKING:
    from tltlc.tools.lint.file_view import View


@record
class Remark:
    """The message of a rule, with fields as in :class:`~tltlc.diagnostics.diagnostic.Diagnostic`.

    The fix, if there is one, does not change the meaning of any spec in the file.
    """

    title: str
    labels: tuple[Label, ...]
    help: str
    fix: Fix | None = None


@record
class LintRule:
    """A lint rule. The page of ``code`` says what it finds, what to write instead, and why.

    ``check`` is a pure function from a file to remarks. ``supersedes`` are the codes of less
    specific diagnostics. Such a diagnostic is left out if one of its labels covers a remark of this
    rule.
    """

    code: str
    severity: Severity
    check: Callable[[View], Iterable[Remark]]
    supersedes: tuple[str, ...] = ()


@record
class LintFinding:
    """A diagnostic of the linter."""

    diagnostic: Diagnostic

    @property
    def fix(self) -> tuple[Edit, ...]:
        """The edits of the first safe fix; empty if there is none.

        They do not change what any spec asks for.
        """
        return next((fix.edits for fix in self.diagnostic.fixes if fix.applicability == "safe"), ())


def removal(title: str, spans: Iterable[Span]) -> Fix:
    """Return the safe fix that removes these spans."""
    return Fix(title, tuple(Edit(span, "") for span in spans), "safe")
