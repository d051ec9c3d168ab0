"""Suggest how to write a clause whose words the language does not know, although it can be parsed."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, replacement_fix
from tltlc.grammar.english.changed_arguments import change_of
from tltlc.grammar.english.readings import sentence
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.sentences.calls import FOREIGN, with_own_calls
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.grammar.mistakes.sentences.vocabulary import ENGLISH
from tltlc.grammar.mistakes.sentences.words import words_of

_CODES: Final = ("TLT0110", "TLT0201", "TLT0301", "TLT0302")
"""The errors that words of other languages cause: `mode == chase`, `prev(mode)`, `a` compared with a bool."""
_BEFORE_CONDITIONS: Final = [[word] for word in ("keep", "avoid", "reach", "require", "and", "or", "implies", "then")]
"""Words behind which a comparison needs no brackets."""
_LONGEST: Final = 60
_LONGEST_TEXT: Final = 1000
_BRACKETS: Final = str.maketrans("", "", "()")


def with_whole_clause(diagnostic: Diagnostic, source: SourceFile, span: Span) -> Diagnostic:
    """Return the error in a clause with a fix for the whole clause, if its own fix would leave another error."""
    label = diagnostic.labels[0] if diagnostic.labels else None
    if label is not None and label.source == source and (changed := _with_changed_number(diagnostic, source, span)):
        return changed
    if diagnostic.code not in _CODES or label is None or label.source != source or len(diagnostic.labels) > 1:
        return diagnostic
    if diagnostic.code == "TLT0110" and "declare " in (diagnostic.help or ""):
        return diagnostic  # the help says what to declare
    if diagnostic.code == "TLT0201" and source.slice(label.span) not in FOREIGN:
        return diagnostic  # a name that nothing declares
    clause = SourceFile(source.name, source.slice(span), source.kind)
    tokens = tokenize(clause.text).tokens[:-1] if len(clause.text) <= _LONGEST_TEXT else ()
    if not 0 < len(tokens) <= _LONGEST or "//" in clause.text:
        return diagnostic
    words = with_own_calls(words_of(clause, declared_names(source), tokens, ENGLISH))
    readings = sentence(words).readings
    if len(readings) != 1 or readings[0].condition or not is_valid(readings[0].clauses):
        return diagnostic
    text = " ".join(readings[0].clauses)
    if diagnostic.code == "TLT0201" and source.slice(label.span) in {token.text for token in tokenize(text).tokens}:
        return diagnostic  # the name is still there
    mended = source.slice(span)
    for edit in diagnostic.fixes[0].edits[:1] if diagnostic.fixes else ():
        mended = source.text[span.start : edit.span.start] + edit.text + source.text[edit.span.end : span.end]
    if plain_text(text) in (plain_text(mended), plain_text(source.slice(span))):
        return diagnostic
    quoted = " and ".join(f"`{clause}`" for clause in readings[0].clauses)
    fix = replacement_fix(source, span, " ".join(readings[0].clauses))
    return replace(diagnostic, help=f"write {quoted}", fixes=(replace(fix, title=f"Write {quoted}"),))


def _with_changed_number(diagnostic: Diagnostic, source: SourceFile, clause: Span) -> Diagnostic | None:
    """Return the error at the number of `begins round` with a fix that says where it changes; None for others."""
    number = diagnostic.labels[0].span
    name, before = source.slice(number), source.text[clause.start : number.start].rstrip()
    edge = next((word for word in ("begins", "ends") if before.endswith(word)), "")
    declared = declared_names(source).names.get(name)
    if diagnostic.code != "TLT0301" or not edge or declared is None or declared.type in ("bool", "enum"):
        return None
    before = before.removesuffix(edge)
    condition = change_of(name, declared)
    if before.split()[-1:] not in _BEFORE_CONDITIONS or " or " in condition:
        is_argument = before.rstrip().endswith(("(", ",")) and source.text[number.end :].lstrip().startswith((")", ","))
        condition = condition if is_argument else f"({condition})"
    text = f"{before}{condition}{source.text[number.end : clause.end]}"
    if not condition or "//" in text:
        return None
    shown = f"write `{' '.join(text.split())}` if each new value of `{name}` counts"
    fix = replacement_fix(source, clause, text)
    return replace(diagnostic, help=f"{shown}, or {diagnostic.help}", fixes=(fix,))


def plain_text(text: str) -> str:
    """Return a clause without blanks and brackets, and with words for the signs of operators."""
    words = text.replace("&&", " and ").replace("||", " or ").replace("->", " implies ").replace("=>", " implies ")
    return "".join(words.replace("!=", "≠").replace("!", " not ").translate(_BRACKETS).split())
