"""Comments that silence findings: ``// tltlc: allow TLT0421``, with a reason behind the codes where there is one.

At the end of a line or on lines of its own above it, for what is found on that line, and in a clause or declaration
that begins or ends there; behind the end of a spec, for all of it; before the first declaration, for the whole file.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, Label, Severity
from tltlc.grammar.tree import Clause, Comment, Declaration, Module, SpecDecl
from tltlc.lint.removal import without
from tltlc.lint.rule import Edit, Finding
from tltlc.lint.view import View
from tltlc.record import record
from tltlc.source import SourceFile, Span

CODE: Final = "TLT0427"
SEVERITY: Final[Severity] = "warning"
_COMMENT: Final = re.compile(r"//(?!/)\s*tltlc\s*:\s*allow\b")
_MEANT: Final = re.compile(r"//+\s*tltlc\s*:\s*(?:allow\b|\w+\s+TLT[0-9]{4}\b)")
_CODES: Final = re.compile(r"[\s,]*(TLT[0-9]{4})\b")


@record
class Allowed:
    """A code that a comment allows, and where it says so; ``lines`` is None for the whole file."""

    code: str
    source: SourceFile
    span: Span
    lines: range | None
    comment: Comment


def silenced(view: View, found: Iterable[Finding]) -> list[Finding]:
    """The findings that no comment silences, of the file where they are; and one for each code that the file itself
    allows in vain.
    """
    allowed = [each for loaded in view.modules for each in _allowed(loaded.module)]
    used: set[Allowed] = set()
    left: list[Finding] = []
    for finding in found:
        silencing = [each for each in allowed if _silences(each, finding.diagnostic)]
        used.update(silencing)
        if not silencing:
            left.append(finding)
    own = [each for each in allowed if each.source is view.source]
    judged = [each for each in own if each not in used and not _speaks_of_any(_undecided(view), each)]
    needless = [each for each in judged if CODE not in map(_code, _codes(each.comment))]
    kept = [each.comment for each in own if each not in needless]
    left += [_in_vain(each, each.comment in kept) for each in needless]
    left += [_without_code(each, view.source) for each in _comments(view.module) if not any(_codes(each))]
    return left + [_misspelt(each, view.source) for each in view.module.comments if _is_misspelt(each)]


def _comments(module: Module) -> list[Comment]:
    return [comment for comment in module.comments if _COMMENT.match(comment.text)]


def _allowed(module: Module) -> Iterator[Allowed]:
    for comment in _comments(module):
        lines = _lines(module, comment)
        for match in _codes(comment):
            start = comment.span.start
            span = Span(start + match.start(1), start + match.end(1))
            yield Allowed(match[1], module.source, span, lines, comment)


def _codes(comment: Comment) -> Iterator[re.Match[str]]:
    """The codes right behind ``allow``; what follows them is the reason."""
    head = _COMMENT.match(comment.text)
    place = head.end() if head else len(comment.text)
    while match := _CODES.match(comment.text, place):
        yield match
        place = match.end()


def _code(match: re.Match[str]) -> str:
    return match[1]


def _lines(module: Module, comment: Comment) -> range | None:
    """The lines that a comment speaks of, None for the whole file."""
    line = _line(module, comment)
    if line is None:
        return None
    for lines in _statements(module):
        if line in (lines[0], lines[-1]):
            return lines
    blocks = (_rows(module, each) for each in module.declarations if isinstance(each, SpecDecl))
    return next((rows for rows in blocks if rows[-1] == line), range(line, line + 1))


def _statements(module: Module) -> Iterator[range]:
    """The lines of each clause and of each declaration that is no block."""
    for declaration in module.declarations:
        for node in declaration.clauses if isinstance(declaration, SpecDecl) else (declaration,):
            yield _rows(module, node)


def _rows(module: Module, node: Clause | Declaration) -> range:
    first, _ = module.source.position(node.span.start)
    last, _ = module.source.position(node.span.end)
    return range(first, last + 1)


def _line(module: Module, comment: Comment) -> int | None:
    """The line that a comment stands on, or above."""
    source, start = module.source, comment.span.start
    first = min((declaration.span.start for declaration in module.declarations), default=len(source.text))
    if start < first:
        return None
    line, column = source.position(start)
    if source.line(line)[: column - 1].strip():
        return line
    last, _ = source.position(len(source.text))
    below = (number for number in range(line + 1, last + 1) if not _is_comment(source.line(number)))
    return next(below, line)


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith("//")


def _silences(allowed: Allowed, diagnostic: Diagnostic) -> bool:
    label = diagnostic.labels[0] if diagnostic.labels else None
    if diagnostic.code != allowed.code or label is None or label.source != allowed.source:
        return False
    return allowed.lines is None or label.source.position(label.span.start)[0] in allowed.lines


def _undecided(view: View) -> list[range]:
    """The lines of the specs that no trace satisfies, or every one: until they are mended, most rules say nothing."""
    found = [spec.declaration.span for spec in view.specs if spec.fspa.states[0].verdict in ("violated", "satisfied")]
    return [range(view.source.position(span.start)[0], view.source.position(span.end)[0] + 1) for span in found]


def _speaks_of_any(places: Iterable[range], allowed: Allowed) -> bool:
    lines = allowed.lines
    return any(lines is None or (lines[0] in place or lines[-1] in place) for place in places)


def _in_vain(each: Allowed, is_kept: bool) -> Finding:
    """``is_kept``: the comment still allows something else, and is left to the author."""
    where = "in this file" if each.lines is None else "on its line"
    title = f"this allows {each.code}, which is not found {where}"
    label = Label(each.source, each.span)
    fix = () if is_kept else (Edit(without(each.source, each.comment.span), ""),)
    return Finding(Diagnostic(CODE, title, (label,), "remove it", SEVERITY), fix)


def _without_code(comment: Comment, source: SourceFile) -> Finding:
    title, way_out = "this comment allows nothing", "name a code, e.g. `// tltlc: allow TLT0419`"
    return Finding(Diagnostic(CODE, title, (Label(source, comment.span),), way_out, SEVERITY))


def _is_misspelt(comment: Comment) -> bool:
    return bool(_MEANT.match(comment.text)) and not _COMMENT.match(comment.text)


def _misspelt(comment: Comment, source: SourceFile) -> Finding:
    title, way_out = "this comment allows nothing", "write `// tltlc: allow`, with two slashes, and the code behind it"
    return Finding(Diagnostic(CODE, title, (Label(source, comment.span),), way_out, SEVERITY))
