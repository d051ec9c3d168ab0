"""Make pages of the examples and of the libraries: their texts, and lists of their declarations."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from docs_site.page import ROOT, Page
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Declaration, LetDecl, ParamDecl, PredicateDecl, SignalDecl, SpecDecl
from tltlc.io.files import read_source

EXAMPLES: Final = "examples"
LIBRARIES: Final = "stdlib_predicates"

_KINDS: Final[dict[type, str]] = {
    SpecDecl: "spec",
    PredicateDecl: "predicate",
    LetDecl: "let",
    SignalDecl: "signal",
    ParamDecl: "param",
}


def pages() -> Iterator[Page]:
    """Yield the pages and the indexes of the examples and of the standard libraries."""
    yield from _pages_of_folder(EXAMPLES, "examples", "Examples", "Whole plans, each with a recorded trace beside it.")
    summary = "What `import NAME` offers. The signals are what a game supplies, the params what a level may set."
    yield from _pages_of_folder(LIBRARIES, "libraries", "Libraries", summary)


def homes() -> dict[str, str]:
    """Return the URIs of the pages that stand for the files and their folders, by path."""
    uris = {EXAMPLES: "examples/index.md", LIBRARIES: "libraries/index.md"}
    for folder, place in ((EXAMPLES, "examples"), (LIBRARIES, "libraries")):
        uris |= {f"{folder}/{name}.tltl": f"{place}/{name}.md" for name in _names(folder)}
    return uris


def _names(folder: str) -> list[str]:
    """Return the names of the files of a folder, without files that only test another file."""
    return sorted(path.stem for path in (ROOT / folder).glob("*.tltl") if not path.stem.endswith("_tests"))


def _pages_of_folder(folder: str, place: str, title: str, summary: str) -> Iterator[Page]:
    rows = []
    for name in _names(folder):
        source = read_source(ROOT / folder / f"{name}.tltl")
        module, _ = parse(source)
        rows_of_declarations = [line for declaration in module.declarations if (line := _row(source.text, declaration))]
        table = ["| | declares | |", "|---|---|---|", *rows_of_declarations]
        text = "\n".join([f"# {name}", "", *table, "", "## Source", "", "```tltl", source.text.rstrip(), "```", ""])
        yield Page(f"{place}/{name}.md", text, f"{folder}/{name}.md")
        rows.append(f"| [{name}]({name}.tltl) | {_comment(source.text) or _names_of(module.declarations)} |")
    text = "\n".join([f"# {title}", "", summary, "", "| | |", "|---|---|", *rows, ""])
    yield Page(f"{place}/index.md", text, f"{folder}/index.md")


def _row(text: str, declaration: Declaration) -> str | None:
    if not isinstance(declaration, SpecDecl | PredicateDecl | LetDecl | SignalDecl | ParamDecl):
        return None
    head = declaration.name
    if isinstance(declaration, PredicateDecl | LetDecl | SignalDecl) and declaration.parameters:
        spans = [parameter.span for parameter in declaration.parameters]
        head += f"({', '.join(' '.join(text[span.start : span.end].split()) for span in spans)})"
    return f"| {_KINDS[type(declaration)]} | `{head}` | {' '.join(declaration.doc.split())} |"


def _comment(text: str) -> str:
    """Return the comment at the start of a file; empty if there is none."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("// "):
            break
        lines.append(line.removeprefix("// ").strip())
    return " ".join(lines)


def _names_of(declarations: tuple[Declaration, ...]) -> str:
    return ", ".join(f"`{declaration.name}`" for declaration in declarations if isinstance(declaration, PredicateDecl))
