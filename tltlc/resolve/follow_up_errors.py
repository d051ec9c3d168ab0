"""Find errors that may be mere consequences of syntax errors, because a part of the text was not parsed."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import DECLARATIONS, SYNONYMS, closest_word
from tltlc.grammar.lexer import Token, tokenize
from tltlc.grammar.module import Module
from tltlc.grammar.tree import SpecDecl, TestDecl

_NO_SUCH_ATOM: Final = "TLT0209"
_WRONG_TEST: Final = ("TLT0217", "TLT0218")
_NO_CLOCK: Final = "TLT0313"
_NO_SUCH_NAME: Final = ("TLT0201", "TLT0208")
_NAMING: Final = ("signal", "entity", "param", "predicate", "let", "spec")


@record
class UnparsedParts:
    """What the parser may have missed in the text ``source``, which has syntax errors.

    ``names`` has all names in the unparsed parts, and ``declared`` those that these parts seem to
    declare. ``any_name`` and ``clock`` say whether they may declare any name, as an import does, or the
    clock, and ``clauses`` whether a spec lacks clauses. ``lines`` are the numbers of the lines that
    have an unparsed part or a syntax error. ``tests`` has, for each parsed test, the span of the spec's
    name, because a diagnostic about the whole test has its label there.
    """

    names: frozenset[str]
    declared: frozenset[str]
    any_name: bool
    clock: bool
    clauses: bool
    lines: frozenset[int]
    tests: frozenset[Span]
    source: SourceFile

    def may_explain(self, diagnostic: Diagnostic) -> bool:
        """Whether an error may be due to something that an unparsed part contains.

        This may be the declaration of a name, an atom of a spec, the clock, the ``expect`` of a test, or
        a param that an option sets.
        """
        if not diagnostic.labels or diagnostic.code == _NO_SUCH_ATOM:
            # The atom may belong to a clause that is being written.
            return True
        label = diagnostic.labels[0]
        if label.source == self.source and self.source.position(label.span.start)[0] in self.lines:
            return True
        if diagnostic.code == _NO_CLOCK:
            return self.clock
        if diagnostic.code in _WRONG_TEST:
            # A label on the whole test means that the test has no `expect`. The user may be writing it now.
            return self.clauses or label.span in self.tests
        if diagnostic.code in _NO_SUCH_NAME:
            return self.any_name or not self._words(diagnostic).isdisjoint(self.names)
        # A name of a library may have another declaration in the text.
        return not self._words(diagnostic).isdisjoint(self.declared)

    def _words(self, diagnostic: Diagnostic) -> set[str]:
        """Return the words at the places in the text to which a diagnostic points."""
        labels = [label for label in diagnostic.labels if label.source == self.source]
        return {word for label in labels for word in re.findall(r"[\w.]+", self.source.slice(label.span))}


def independent_errors(
    module: Module, syntax_errors: Sequence[Diagnostic], diagnostics: Sequence[Diagnostic]
) -> tuple[Diagnostic, ...]:
    """Return the syntax errors of a module, and the errors among ``diagnostics`` that they cannot explain.

    ``diagnostics`` are those of resolving the parts that were parsed. The errors are in the order of the
    text; those in other files come last.
    """
    unparsed = unparsed_parts(module, syntax_errors)
    errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity == "error"]
    errors = [*syntax_errors, *(error for error in errors if not unparsed.may_explain(error))]

    def place(error: Diagnostic) -> tuple[bool, int]:
        label = error.labels[0]
        return label.source != module.source, label.span.start if label.source == module.source else 0

    return tuple(sorted(errors, key=place))


def unparsed_parts(module: Module, syntax_errors: Sequence[Diagnostic]) -> UnparsedParts:
    """Find out what the parts of a module's text may contain that are not in its declarations."""
    unparsed = list(_unparsed_tokens(module))
    declared = list(_declared_names(unparsed))
    # A line outside of specs that does not begin with a known keyword may be any declaration.
    unknown = any(part.begins and not part.in_block and part.keyword is None for part in unparsed)
    keywords = {part.keyword for part in unparsed}
    # A spec without a name, or with a name in another form, has a made-up name.
    specs = (declaration for declaration in module.declarations if isinstance(declaration, SpecDecl))
    made_up = any(module.source.slice(spec.name_span) != spec.name for spec in specs)
    places = [*(part.token.start for part in unparsed), *(error.labels[0].span.start for error in syntax_errors)]
    tests = (declaration for declaration in module.declarations if isinstance(declaration, TestDecl))
    return UnparsedParts(
        names=frozenset(part.token.text for part in unparsed if part.token.type == "NAME"),
        declared=frozenset(filter(None, declared)),
        any_name=unknown or made_up or "import" in keywords or None in declared,
        clock=unknown or "clock" in keywords,
        clauses=any(part.in_block for part in unparsed),
        lines=frozenset(module.source.position(place)[0] for place in places),
        tests=frozenset(test.spec.span for test in tests),
        source=module.source,
    )


@record
class _UnparsedToken:
    """A token that is in no declaration.

    ``begins`` says whether it is the first one on its line, or comes after a closing brace. ``keyword``
    is the keyword of a declaration that it is, or is likely to be meant as. ``in_block`` says whether it
    is inside a spec or test of which other parts were parsed.
    """

    token: Token
    begins: bool
    keyword: str | None
    in_block: bool


def _unparsed_tokens(module: Module) -> Iterator[_UnparsedToken]:
    """Yield the tokens outside of all declarations, clauses and lines of tests, without braces."""
    source, parsed, blocks = module.source, list[Span](), list[Span]()
    for declaration in module.declarations:
        if isinstance(declaration, SpecDecl) and declaration.block:
            head_end, items = declaration.name_span.end, [clause.span for clause in declaration.clauses]
        elif isinstance(declaration, TestDecl):
            head_end, items = declaration.spec.span.end, [item.span for item in declaration.items]
        else:
            parsed.append(declaration.span)
            continue
        blocks.append(declaration.span)
        parsed += [Span(declaration.span.start, head_end), *items]
    is_parsed, is_in_block = _membership(parsed), _membership(blocks)
    line, before = 0, ""
    for token in tokenize(source.text).tokens[:-1]:
        last_line, line = line, source.position(token.start)[0]
        begins = line != last_line or before == "RBRACE"
        before = token.type
        if token.type not in ("LBRACE", "RBRACE") and not is_parsed(token.start):
            yield _UnparsedToken(token, begins, _keyword(token.text, begins), is_in_block(token.start))


def _membership(spans: list[Span]) -> Callable[[int], bool]:
    """Return a function that says whether an offset is in one of some spans, which do not overlap."""
    in_order = sorted(spans, key=lambda span: span.start)
    starts = [span.start for span in in_order]

    def is_member(offset: int) -> bool:
        index = bisect_right(starts, offset) - 1
        return index >= 0 and offset < in_order[index].end

    return is_member


def _keyword(word: str, begins: bool) -> str | None:
    """Return the keyword of a declaration that a word is or, if a line begins with it, is likely to be meant as."""
    if word in DECLARATIONS or not begins:
        return word if word in DECLARATIONS else None
    return SYNONYMS["declaration"].get(word.lower()) or closest_word(word, tuple(DECLARATIONS))


def _declared_names(unparsed: Iterable[_UnparsedToken]) -> Iterator[str | None]:
    """Yield the names after the keywords of declarations, and None for a keyword without a name."""
    current: str | None = None
    is_nameless = False
    for part in unparsed:
        if part.keyword is not None:
            if is_nameless:
                yield None
            current = part.keyword if part.keyword in _NAMING else None
            is_nameless = current is not None
        elif current and part.token.type == "NAME" and part.token.text != "in":
            yield part.token.text
            current, is_nameless = "entity" if current == "entity" else None, False
        elif current and part.token.type == "COMMA":
            if is_nameless:
                yield None
            is_nameless = True
        else:
            current = None
    if is_nameless:
        yield None
