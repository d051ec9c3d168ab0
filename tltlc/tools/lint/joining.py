"""Join findings that say the same of several names, for people who read a list."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Severity
from tltlc.tools.lint.rules import rules


def joined(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics with those of a rule that can be joined as the rule joins them (``LintRule.join``).

    Findings are joined if they have the same code, file and severity. The result stands where the first one stood.
    """
    joins = {rule.code: rule.join for rule in rules() if rule.join is not None}
    groups: dict[tuple[str, SourceFile, Severity], list[Diagnostic]] = {}
    for diagnostic in (kept := [*diagnostics]):
        if diagnostic.code in joins:
            groups.setdefault(_key(diagnostic), []).append(diagnostic)

    def shown() -> Iterator[Diagnostic]:
        for diagnostic in kept:
            if diagnostic.code not in joins:
                yield diagnostic
            elif diagnostic is (group := groups[_key(diagnostic)])[0]:
                yield from joins[diagnostic.code](group) if len(group) > 1 else group

    return tuple(shown())


def _key(diagnostic: Diagnostic) -> tuple[str, SourceFile, Severity]:
    return diagnostic.code, diagnostic.labels[0].source, diagnostic.severity
