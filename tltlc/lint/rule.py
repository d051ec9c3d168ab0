"""What a rule is, and what it finds."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from tltlc.diagnostics.diagnostic import Diagnostic, Label, Severity
from tltlc.record import record
from tltlc.source import Span

if TYPE_CHECKING:
    from tltlc.lint.view import View


@record
class Edit:
    """Another text in place of what a span of the file covers."""

    span: Span
    text: str


Fix = tuple[Edit, ...]
"""Edits that do not change what any spec of the file asks of the game."""


@record
class Remark:
    """What a rule has to say, fields as of :class:`~tltlc.diagnostics.diagnostic.Diagnostic`; with a fix or none."""

    title: str
    labels: tuple[Label, ...]
    help: str
    fix: Fix = ()


@record
class Rule:
    """A rule: the page of ``code`` says what it finds, what to write instead, and why.

    ``check`` is a pure function from a file to remarks.  ``supersedes`` are codes that say less of the same place: they
    are left out where one of their labels covers a remark of this rule.
    """

    code: str
    severity: Severity
    check: Callable[[View], Iterable[Remark]]
    supersedes: tuple[str, ...] = ()


@record
class Finding:
    """A diagnostic, and the fix that makes it go away or none."""

    diagnostic: Diagnostic
    fix: Fix = ()
