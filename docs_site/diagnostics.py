"""Make a page for each diagnostic code, a page that lists the codes by family, and the table of the lint rules."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import Any, Final

from docs_site.page import Page
from tltlc.diagnostics import code_pages
from tltlc.tools.lint import allow
from tltlc.tools.lint.rules import rules

FOLDER: Final = "tltlc/diagnostics/pages"

FAMILIES: Final = {
    "TLT00": "Files and imports",
    "TLT01": "Syntax",
    "TLT02": "Names",
    "TLT03": "Types, units and values",
    "TLT04": "Warnings and lint",
    "TLT05": "Automata",
    "TLT06": "Artefacts, traces and tests",
    "TLT07": "Commands and the project file",
    "TLT08": "Levels, episodes, policies and training",
    "TLT09": "Suites, demonstrations and Table I",
}
"""The title of each family of codes, by its first five characters."""


def pages() -> Iterator[Page]:
    """Yield the list of all codes, then the page of each code."""
    yield Page("diagnostics/index.md", _index(), f"{FOLDER}/index.md")
    for code in code_pages.codes():
        yield Page(_uri(code), code_pages.page(code), f"{FOLDER}/{code}.md")


def navigation() -> list[Any]:
    """Return the entries of the pages for the navigation of MkDocs, by family."""
    return [
        "diagnostics/index.md",
        *({FAMILIES[family]: [{code: _uri(code)} for code in members]} for family, members in _families()),
    ]


def homes() -> dict[str, str]:
    """Return the URIs of the pages that stand for the codes' files and their folder, by path."""
    return {FOLDER: "diagnostics/index.md"} | {f"{FOLDER}/{code}.md": _uri(code) for code in code_pages.codes()}


def _index() -> str:
    lines = [
        "# Diagnostics",
        "",
        f"Every message of `tltlc` has one of these {len(code_pages.codes())} codes. `tltlc explain TLT0305` shows the",
        "page of a code in the terminal.",
    ]
    for family, members in _families():
        lines += ["", f"## {FAMILIES[family]}", "", "| code | means |", "|---|---|"]
        lines += [f"| {code} | {_title(code)} |" for code in members]
    return "\n".join(lines) + "\n"


def lint_rules() -> str:
    """Return a table of the lint rules with links to their pages in the project, for pages in ``docs/guides/``."""
    severities = {**{rule.code: rule.severity for rule in rules()}, allow.CODE: allow.SEVERITY}
    lines = ["| code | severity | finds |", "|---|---|---|"]
    for code, severity in sorted(severities.items()):
        lines.append(f"| [{code}](../../{FOLDER}/{code}.md) | {severity} | {_title(code)} |")
    return "\n".join(lines) + "\n"


def _title(code: str) -> str:
    return code_pages.title(code).replace("|", "&#124;")


def _families() -> Iterator[tuple[str, list[str]]]:
    return ((family, [*members]) for family, members in groupby(code_pages.codes(), key=lambda code: code[:5]))


def _uri(code: str) -> str:
    return f"diagnostics/{code}.md"
