"""Pages of the examples and of the libraries: their texts, and what they declare."""

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
    """The example specs and the standard libraries, each with a list in front."""
    yield from _of_folder(EXAMPLES, "examples", "Examples", "Whole plans, each with a recorded trace beside it.")
    said = "What `import NAME` offers. The signals are what a game supplies, the params what a level may set."
    yield from _of_folder(LIBRARIES, "libraries", "Libraries", said)


def homes() -> dict[str, str]:
    """The pages of the files and of their folders."""
    found = {EXAMPLES: "examples/index.md", LIBRARIES: "libraries/index.md"}
    for folder, place in ((EXAMPLES, "examples"), (LIBRARIES, "libraries")):
        found |= {f"{folder}/{name}.tltl": f"{place}/{name}.md" for name in _names(folder)}
    return found


def _names(folder: str) -> list[str]:
    """The files of a folder, without those that only test another."""
    return sorted(path.stem for path in (ROOT / folder).glob("*.tltl") if not path.stem.endswith("_tests"))


def _of_folder(folder: str, place: str, title: str, said: str) -> Iterator[Page]:
    rows = []
    for name in _names(folder):
        source = read_source(ROOT / folder / f"{name}.tltl")
        module, _ = parse(source)
        declared = [line for declaration in module.declarations if (line := _row(source.text, declaration))]
        table = ["| | declares | |", "|---|---|---|", *declared]
        text = "\n".join([f"# {name}", "", *table, "", "## Source", "", "```tltl", source.text.rstrip(), "```", ""])
        yield Page(f"{place}/{name}.md", text, f"{folder}/{name}.md")
        rows.append(f"| [{name}]({name}.tltl) | {_comment(source.text) or _names_of(module.declarations)} |")
    text = "\n".join([f"# {title}", "", said, "", "| | |", "|---|---|", *rows, ""])
    yield Page(f"{place}/index.md", text, f"{folder}/index.md")


def _row(text: str, declaration: Declaration) -> str | None:
    if not isinstance(declaration, SpecDecl | PredicateDecl | LetDecl | SignalDecl | ParamDecl):
        return None
    head = declaration.name
    if isinstance(declaration, PredicateDecl | LetDecl | SignalDecl) and declaration.parameters:
        spans = [each.span for each in declaration.parameters]
        head += f"({', '.join(' '.join(text[span.start : span.end].split()) for span in spans)})"
    return f"| {_KINDS[type(declaration)]} | `{head}` | {' '.join(declaration.doc.split())} |"


def _comment(text: str) -> str:
    """What the first lines of a file say of it."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("// "):
            break
        lines.append(line.removeprefix("// ").strip())
    return " ".join(lines)


def _names_of(declarations: tuple[Declaration, ...]) -> str:
    return ", ".join(f"`{each.name}`" for each in declarations if isinstance(each, PredicateDecl))
