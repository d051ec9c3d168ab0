"""The phrases that designers type, and what becomes of them: compiled, helped, or not."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Literal

from tltlc import Fspa, TltlError, compile_text
from tltlc.core.record import record
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.parser import parse
from tltlc.io.toml_text import parse as parse_toml
from tltlc.pipeline import compile_source
from tltlc.resolve.resolution import resolve
from tltlc.tools.diff.relation import compare
from tltlc.tools.explain.explanation import explain
from tltlc.tools.lint.run import lint
from tltlc.tools.lint.scopes import apply_edits

FOLDER = Path(__file__).parent / "phrases"
MOST_ROUNDS = 3
"""The most fixes that are applied to one phrase, each for another error."""
_KEYWORDS = ("reach", "keep", "avoid", "require", "limit")
NO_CLAUSE = ("no clause can say", "no short clause can say")
"""What the help of an ``unsayable`` phrase says."""

Kind = Literal["right", "helped", "named", "not helped", "warned", "wrong"]


@record
class Phrase:
    """A phrase as typed, the clauses that were meant, and their formula.

    ``also`` has other clauses that the phrase may mean; either reading is right. ``explain`` is what
    ``tltlc explain`` says of the clauses that were meant. ``in_words``, in the phrases of later
    writers, is what was meant, in plain English, written together with the phrase. An ``unsayable``
    phrase means what no clause can say; it has no ``meant``, ``formula`` and ``explain``. ``outcome``
    is the kind of its ``Outcome``. ``clock`` takes the place of the prelude's: formulas with a long time at a fast
    clock take half a minute to compare.
    """

    source: str
    prelude: str
    typed: str
    outcome: Kind
    meant: str = ""
    formula: str = ""
    explain: str = ""
    also: tuple[str, ...] = ()
    in_words: str = ""
    unsayable: bool = False
    clock: str = ""


@record
class Outcome:
    """What becomes of a phrase, and the text that it ends as.

    ``right``: it compiles as it stands to what is meant. ``helped``: it does after the fixes that are
    offered first. ``named``: a help names several clauses with what each says, and what is meant is
    among them. ``warned``: it ends as something else, but the linter says so. ``wrong``: it ends as
    something else, and nothing says so. ``not helped``: an error is left that offers no fix.
    An automaton that is too large is such an error, too. An ``unsayable`` phrase is ``helped`` if it
    is offered no fix, and its help says that no clause can say it; it is ``wrong`` if it compiles.
    """

    kind: Kind
    text: str
    message: str = ""


def phrases() -> Iterator[Phrase]:
    for path in sorted(FOLDER.glob("*.toml")):
        for entry in parse_toml(SourceFile(path.name, path.read_text()), "TLT0001", "")["phrase"]:
            also = entry.pop("also", ())
            yield Phrase(source=path.stem, also=(also,) if isinstance(also, str) else tuple(also), **entry)


def prelude(name: str) -> str:
    return (FOLDER / "preludes" / f"{name}.tltl").read_text()


def spec_text(phrase: Phrase, clauses: str) -> str:
    declarations = prelude(phrase.prelude)
    if phrase.clock:
        declarations, count = re.subn(r"^clock .*$", f"clock {phrase.clock}", declarations, count=1, flags=re.MULTILINE)
        assert count == 1
    return f"{declarations}spec s {{\n{clauses.strip()}\n}}\n"


def errors(source: SourceFile) -> list[Diagnostic]:
    """Return the errors of a text, in the order in which they are shown."""
    module, syntax_errors = parse(source)
    diagnostics = (*syntax_errors, *resolve(module).diagnostics)
    return [diagnostic for diagnostic in diagnostics if diagnostic.severity == "error"]


def fix(text: str) -> tuple[str, list[Diagnostic]]:
    """Apply the fixes that are offered first, at most ``MOST_ROUNDS``; also return the errors that are left."""
    for _ in range(MOST_ROUNDS):
        source = SourceFile("a.tltl", text)
        left = errors(source)
        fixes = [diagnostic.fixes[0] for diagnostic in left if diagnostic.fixes]
        if not fixes:
            return text, left
        text = apply_edits(source, fixes[0].edits).text
    return text, errors(SourceFile("a.tltl", text))


@cache
def automaton(text: str) -> Fspa:
    (fspa,) = compile_text(text)
    return fspa


def sentence(text: str) -> str:
    """Return what ``tltlc explain`` says of the only spec of a text."""
    return explain(automaton(text)).english


def is_equivalent(one: str, other: str) -> bool:
    """Whether two texts have specs with the same limit that are known to accept the same traces."""
    a, b = automaton(one), automaton(other)
    is_same = one == other or compare(a, b, feasible_only=True).relation == "equivalent"
    return a.limit_steps == b.limit_steps and is_same


def warnings(text: str) -> set[str]:
    """Return the codes of what the compiler and the linter say of a text that compiles."""
    compiled = compile_source(SourceFile("a.tltl", text))
    findings = (finding.diagnostic for finding in lint(SourceFile("a.tltl", text)))
    return {diagnostic.code for diagnostic in (*compiled.diagnostics, *findings)}


def _is_named(phrase: Phrase, text: str, left: list[Diagnostic]) -> bool:
    """Whether each clause that is meant is one that a help names, or one of the text."""
    quoted = [quote for error in left for quote in (error.help or "").split("`")[1::2]]
    helps = [quote for quote in quoted if quote.split(" ")[0] in _KEYWORDS]
    body = text.partition("spec s {\n")[2].splitlines()
    known = [*helps, *(line.strip() for line in body if line.strip().split(" ")[0] in _KEYWORDS)]

    def is_known(clause: str) -> bool:
        return clause in known or any(_means(phrase, clause, other) for other in known)

    readings = [reading.strip().splitlines() for reading in (phrase.meant, *phrase.also)]
    return bool(helps) and any(all(is_known(line.strip()) for line in lines) for lines in readings if lines)


def _means(phrase: Phrase, one: str, other: str) -> bool:
    try:
        return is_equivalent(spec_text(phrase, one), spec_text(phrase, other))
    except TltlError:
        return False


def outcome(phrase: Phrase) -> Outcome:
    typed = spec_text(phrase, phrase.typed)
    text, left = fix(typed)
    if left:
        is_limit = any(limit in (error.help or "") for limit in NO_CLAUSE for error in left)
        if phrase.unsayable and text == typed and is_limit:
            return Outcome("helped", text, left[0].help or "")
        kind: Kind = "named" if _is_named(phrase, text, left) else "not helped"
        return Outcome(kind, text, f"{left[0].title}; {left[0].help}")
    try:
        automaton(text)
    except TltlError as error:
        return Outcome("not helped", text, str(error))
    if phrase.unsayable:
        return Outcome("wrong", text, sentence(text))
    readings = [spec_text(phrase, clauses) for clauses in (phrase.meant, *phrase.also)]
    if any(is_equivalent(text, reading) for reading in readings):
        return Outcome("right" if text == typed else "helped", text, sentence(text))
    new = warnings(text) - warnings(readings[0])
    return Outcome("warned" if new else "wrong", text, ", ".join(sorted(new)) or sentence(text))
