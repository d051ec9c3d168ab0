"""Find the diagnostics that ``allow`` comments silence, and the comments that have silenced one.

:mod:`tltlc.grammar.allow_comments` describes the comments, such as ``// tltlc: allow TLT0421``.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.allow_comments import Allowance, allowances
from tltlc.grammar.module import Module


def drop_silenced(modules: Iterable[Module], reported: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics, without the warnings and notes that a comment in the same file silences."""
    diagnostics = tuple(reported)
    if not diagnostics:
        return diagnostics
    comments = AllowIndex(modules)
    return tuple(
        diagnostic for diagnostic in diagnostics if diagnostic.severity == "error" or not comments.silences(diagnostic)
    )


class AllowIndex:
    """The codes that comments in some modules allow, and which of these codes have silenced a diagnostic.

    The comments are indexed by the clauses and declarations that they apply to, so that a lookup
    does not search all comments.
    """

    def __init__(self, modules: Iterable[Module]) -> None:
        self._files: dict[SourceFile, _FileAllowances] = {}
        for module in modules:
            file_allowances = tuple(allowances(module))
            if file_allowances:
                self._files[module.source] = _FileAllowances(file_allowances)

    def allowances(self, source: SourceFile) -> Sequence[Allowance]:
        """Return the codes that the comments of one file allow, in the order of the text."""
        file = self._files.get(source)
        return file.allowances if file else ()

    def silences(self, diagnostic: Diagnostic) -> bool:
        """Return whether a comment silences a diagnostic, judged by its code and first label.

        Mark each comment that silences the diagnostic as used.
        """
        label = diagnostic.labels[0] if diagnostic.labels else None
        file = self._files.get(label.source) if label else None
        return label is not None and file is not None and file.silences(diagnostic.code, label.span.start)

    def has_silenced(self, allowance: Allowance) -> bool:
        """Whether an allowed code has silenced a diagnostic, in a call of :meth:`silences`."""
        return id(allowance) in self._files[allowance.source].used


class _FileAllowances:
    """The diagnostic codes that the comments of one file allow, indexed by statement."""

    def __init__(self, allowances: tuple[Allowance, ...]) -> None:
        self.allowances = allowances
        self.used: set[int] = set()
        self._answers: dict[tuple[str, Span | None], bool] = {}
        self._by_statement: dict[Span | None, list[dict[str, list[Allowance]]]] = {}
        # Comments that apply to the same line share one tuple of statements, so its id stands for the line.
        codes_by_line: dict[int, dict[str, list[Allowance]]] = {}
        for allowance in allowances:
            codes = codes_by_line.get(id(allowance.statements))
            if codes is None:
                codes = codes_by_line[id(allowance.statements)] = {}
                for statement in (None,) if allowance.statements is None else allowance.statements:
                    self._by_statement.setdefault(statement, []).append(codes)
            codes.setdefault(allowance.code, []).append(allowance)
        self._statements = _StatementSpans(statement for statement in self._by_statement if statement is not None)

    def silences(self, code: str, offset: int) -> bool:
        """Return whether a comment allows a code at an offset of the file; mark all such comments as used."""
        # The end of a statement is inclusive: an offset right after its last character belongs to it, too.
        statements = {None, *self._statements.spans_at(offset), *self._statements.spans_at(offset - 1)}
        # A list, not a generator: `any` must not stop before all comments are marked.
        is_allowed = [self._allow(code, statement) for statement in statements]
        return any(is_allowed)

    def _allow(self, code: str, statement: Span | None) -> bool:
        """Return whether a comment allows a code in a statement; mark all such comments as used.

        The statement None means the whole file.
        """
        if (code, statement) not in self._answers:
            allowances = [
                allowance for codes in self._by_statement.get(statement, ()) for allowance in codes.get(code, ())
            ]
            self.used.update(map(id, allowances))
            self._answers[code, statement] = bool(allowances)
        return self._answers[code, statement]


class _StatementSpans:
    """The spans of statements, searched by an offset in the text.

    Two spans may overlap only if one contains the other.
    """

    def __init__(self, spans: Iterable[Span]) -> None:
        self._spans = sorted(spans, key=lambda span: (span.start, -span.end))
        self._starts = [span.start for span in self._spans]
        self._outer: list[int] = []
        """For each span, the index in ``_spans`` of the smallest span that contains it, or -1."""
        open_: list[int] = []
        for index, span in enumerate(self._spans):
            while open_ and self._spans[open_[-1]].end <= span.start:
                open_.pop()
            self._outer.append(open_[-1] if open_ else -1)
            open_.append(index)

    def spans_at(self, offset: int) -> Iterator[Span]:
        """Yield the spans that contain an offset, innermost first."""
        index = bisect_right(self._starts, offset) - 1
        while index >= 0:
            if offset < self._spans[index].end:
                yield self._spans[index]
            index = self._outer[index]
