"""Ways out that can be taken at once: the fixes of rules, and what the messages of errors name, tried before."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.allowed import spoken_of
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Import, Module
from tltlc.limits import WORK
from tltlc.lint.rule import Edit, Finding
from tltlc.lint.scopes import keeping_scopes
from tltlc.record import record
from tltlc.source import SourceFile, Span

_INSTEAD: Final = re.compile(r"(?:did you mean|write|say) `([^`\n]+)`")
_IMPORT: Final = re.compile(r"add `(import [^`\n]+)`")
_DECLARE: Final = re.compile(r"declare (?:it|one)(?:, e\.g\.)?:? `((?:signal|entity|param) [^`\n]+)`")
_MOST: Final = 8
"""Of more errors, ways out are not tried."""

Errors = Callable[[SourceFile], Iterable[Diagnostic]]
"""What is wrong with a text."""


@record
class WayOut:
    """What can be done about a diagnostic, in a few words, and what it does to the text."""

    title: str
    diagnostic: Diagnostic
    edits: tuple[Edit, ...]


def of_findings(found: Iterable[Finding], module: Module) -> Iterator[WayOut]:
    """The fixes of rules in a module, as ``tltlc lint --fix`` applies them: comments keep what they allow.

    Where there are comments, each fix is tried once, and only so many are tried at all.
    """
    has_comments = bool(spoken_of(module))
    tried: dict[tuple[Edit, ...], tuple[Edit, ...] | None] = {}
    for finding in found:
        edits: tuple[Edit, ...] | None = finding.fix
        if has_comments and finding.fix:
            if finding.fix not in tried and len(tried) < WORK["fixes tried"]:
                tried[finding.fix] = keeping_scopes(module, finding.fix)
            edits = tried.get(finding.fix)
        if edits:
            # "remove it, or use it": the second is left to whoever writes.
            way_out = (finding.diagnostic.help or "mend it").splitlines()[0].partition(", or ")[0]
            yield WayOut(f"{way_out[0].upper()}{way_out[1:]}", finding.diagnostic, edits)


def of_messages(told: Iterable[Diagnostic], module: Module, errors: Errors) -> Iterator[WayOut]:
    """What these messages about a module name as a way out, where that leaves less to be mended."""
    candidates = [each for said in islice(told, _MOST) for each in _candidates(said, module)]
    if not candidates:
        return
    before = _wrong(module.source, errors)
    for way_out in candidates:
        (edit,) = way_out.edits
        text = module.source.text[: edit.span.start] + edit.text + module.source.text[edit.span.end :]
        if _is_less(_wrong(SourceFile(module.source.name, text), errors), before):
            yield way_out


def _wrong(source: SourceFile, errors: Errors) -> tuple[int, Counter[str]]:
    """How many errors of syntax there are, and all errors by their codes."""
    return len(parse(source)[1]), Counter(each.code for each in errors(source) if each.severity == "error")


def _is_less(left: tuple[int, Counter[str]], before: tuple[int, Counter[str]]) -> bool:
    """Whether fewer errors are left, and none of a new kind; what could be read again may be wrong in itself."""
    return left[0] < before[0] or (left[0] == before[0] and left[1] < before[1])


def _candidates(diagnostic: Diagnostic, module: Module) -> Iterator[WayOut]:
    label = next((each for each in diagnostic.labels if each.source.name == module.source.name), None)
    if label is None:
        return
    said = f"{label.message}\n{diagnostic.help or ''}"
    for match in _INSTEAD.finditer(said):
        yield WayOut(f"Write `{match[1]}`", diagnostic, (Edit(label.span, match[1]),))
    for match in _IMPORT.finditer(said):
        yield WayOut(f"Add `{match[1]}`", diagnostic, (_at_top(match[1], module),))
    for match in _DECLARE.finditer(said):
        yield WayOut(f"Declare `{match[1]}`", diagnostic, (_at_top(match[1], module),))


def _at_top(line: str, module: Module) -> Edit:
    """A line of its own, behind the imports, or before the first declaration and its documentation."""
    source = module.source
    newline = "\r\n" if "\r\n" in source.text else "\n"
    imports = [each for each in module.declarations if isinstance(each, Import)]
    if imports:
        number, _ = source.position(imports[-1].span.end)
        start = _line_end(source, number)
        return Edit(Span(start, start), f"{newline}{line}")
    first = min((each.span.start for each in module.declarations), default=len(source.text))
    number, _ = source.position(first)
    while number > 1 and source.line(number - 1).lstrip().startswith("///"):
        number -= 1
    start = _line_end(source, number) - len(source.line(number))
    return Edit(Span(start, start), f"{line}{newline}")


def _line_end(source: SourceFile, number: int) -> int:
    """The offset behind the last character of a line (from 1)."""
    start = 0
    for _ in range(number - 1):
        start = source.text.index("\n", start) + 1
    return start + len(source.line(number))
