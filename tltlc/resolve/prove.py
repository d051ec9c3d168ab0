"""Regenerates ``proved.json``: ``python -m tltlc.resolve.prove``.

The file holds the answers about the predicates of the standard library that need sympy, so that a
specification that uses only these never waits for it.
"""

from __future__ import annotations

from pathlib import Path

from tltlc.grammar.parser import parse
from tltlc.resolve.imports import standard_library
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.predicate_check import memory
from tltlc.resolve.program import resolve
from tltlc.source import SourceFile


def prove(library: Path) -> dict[str, bool]:
    """The answers for every predicate declared or used in a folder of libraries, sorted by question."""
    with memory.computed_anew() as answers:
        for path in sorted(library.glob("*.tltl")):
            module, _ = parse(SourceFile(str(path), path.read_text("utf-8")))
            resolve(module, ResolveOptions())
    return dict(sorted(answers.items()))


if __name__ == "__main__":
    memory.SHIPPED.write_text(memory.file_text(prove(standard_library())), "utf-8")
