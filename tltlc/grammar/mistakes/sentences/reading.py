"""Read a clause that cannot be parsed by patterns of English sentences, and suggest the clauses that say the same."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix, replacement_fix
from tltlc.grammar import lalr
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import END, Token, tokenize
from tltlc.grammar.mistakes.clauses import is_own_line
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.parse_failure import ParseFailure
from tltlc.grammar.mistakes.rephrasing import span_of
from tltlc.grammar.mistakes.sentences.calls import with_own_calls, without_braces
from tltlc.grammar.mistakes.sentences.changes import CHANGES
from tltlc.grammar.mistakes.sentences.goals import goal_of
from tltlc.grammar.mistakes.sentences.kinds import is_event
from tltlc.grammar.mistakes.sentences.logic import equality_fix, logic_fix
from tltlc.grammar.mistakes.sentences.names import is_imperative, with_names
from tltlc.grammar.mistakes.sentences.requests import request_of
from tltlc.grammar.mistakes.sentences.rules import Clauses, rule_of
from tltlc.grammar.mistakes.sentences.states import AND, state_of
from tltlc.grammar.mistakes.sentences.stretches import stretch_rule_of
from tltlc.grammar.mistakes.sentences.two_readings import both_readings
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.grammar.mistakes.sentences.vocabulary import ENGLISH, FILLERS, NEVER, PROHIBITIONS, SUBJECTS
from tltlc.grammar.mistakes.sentences.words import Words, phrases, words_of
from tltlc.grammar.tables import load

_JOINTS: Final = phrases("and", ",", ", and", "but", ", but", ";", ".", "without", "while")
_STOPS: Final = phrases(";", ".")
_RULES_BEHIND: Final = phrases(", never", ", no", ", without", "with")
_CARRIED: Final = phrases("and bring it", "and carry it", "and bring them", "and take it")
"""Words between a thing and the place at which it must be held."""
_CLEAR: Final = phrases("infinitely often")
"""Words of sentences whose help in the language would miss what is meant."""
_HEADINGS: Final = ("scenario", "feature", "background", "example")
_RULE_LABELS: Final = (*PROHIBITIONS, *phrases("not", "always", "eventually", "forbidden", "illegal", "disallowed"))
"""What says before a colon what must be, and so is no label."""
_FORMS: Final = "begin with what must be: `reach a`, `keep a`, `avoid a`, `keep a implies b`"
LONGEST: Final = 60
"""The most tokens of a sentence; a longer clause is hardly one."""
_LONGEST_CHECKED: Final = 500
"""Fewer tokens than these are read again with the fix of their error."""
KEYWORDS: Final = ("reach", "keep", "avoid", "require", "limit")


ReadAgain = Callable[[SourceFile, Sequence[Token], lalr.UnexpectedTokenError, str], Diagnostic]
"""Returns the error for a piece of a text, as :func:`~tltlc.grammar.mistakes.messages.unexpected_token` does."""


def by_patterns(
    failure: ParseFailure, diagnostic: Diagnostic, *, is_explained: bool, read_again: ReadAgain | None
) -> Diagnostic:
    """Return the error for a clause with the fix that its English sentence suggests, if it has one reading.

    The error stays as it is if its fix leaves no error, or if the sentence is unclear. ``is_explained``
    says that the error is about a mistake in a clause of the language: then its help stays, too.
    """
    if failure.start != "clause" or failure.tokens[-1].type != END:
        return diagnostic
    if len(failure.tokens) > LONGEST:
        is_end = (
            len(failure.tokens) < _LONGEST_CHECKED
            and diagnostic.fixes
            and not _leads_on(failure, diagnostic.fixes[0], read_again)
        )
        return replace(diagnostic, fixes=()) if is_end else diagnostic
    if failure.tokens[0].text.lower() in _HEADINGS and failure.tokens[1].text == ":":
        at = Span(failure.tokens[0].start, failure.tokens[0].start)
        fix = Fix("Write `//` before it", (Edit(at, "// "),))
        return replace(diagnostic, help="write `//` before it: a heading is a comment", fixes=(fix,))
    if not diagnostic.fixes and (fix_ := logic_fix(failure) or equality_fix(failure)):
        return replace(diagnostic, help=f"write `{fix_.edits[0].text}`", fixes=(fix_,))
    words = sentence_words(failure)
    if words.word(0) == "require" or not (failure.tokens[0].text in KEYWORDS or is_own_line(failure)):
        return diagnostic
    if not words.find(FILLERS):
        is_spelt = (with_names(words).text != words.text or _compares_bools(words)) and _read(words) is not None
        if diagnostic.fixes and is_mended(failure, diagnostic.fixes[0]) and not is_spelt:
            return diagnostic
        if not diagnostic.fixes and failure.tokens[0].text in KEYWORDS and is_explained:
            is_spelt = with_names(words).text != words.text
            is_clear = (
                is_spelt
                or words.find(_CLEAR)
                or _is_change(words)
                or (words.word(0) == "avoid" and stretch_rule_of(words))
                or (words.word(0) == "reach" and words.find(_RULES_BEHIND))
            )
            if not is_clear and not _is_quoted(_read(words), diagnostic.help or ""):
                return diagnostic
    clauses = _read(words) if words else None
    if clauses is None and diagnostic.fixes and not _leads_on(failure, diagnostic.fixes[0], read_again):
        diagnostic = replace(diagnostic, help=diagnostic.help or _FORMS, fixes=())
    span = span_of(failure.tokens[:-1])
    if clauses is None and not diagnostic.fixes and failure.tokens[0].text not in KEYWORDS:
        return replace(diagnostic, help=both_readings(words) or both_readings(with_names(words)) or diagnostic.help)
    if clauses is None or "//" in failure.source.slice(span):
        return diagnostic
    text = " ".join(clauses)
    if text == " ".join(failure.source.slice(span).split()):
        return diagnostic  # the error is about a name or a value
    if failure.lacks_fixed_clock(text) or not is_valid(clauses):
        return diagnostic
    quoted = " and ".join(f"`{clause}`" for clause in clauses)
    has_both = diagnostic.help is not None and quoted in diagnostic.help
    indent = failure.source.text[: span.start].rpartition("\n")[2]
    separator = f"\n{indent}" if not indent.strip() else " "
    fix = replacement_fix(failure.source, span, separator.join(clauses))
    return replace(
        diagnostic,
        help=diagnostic.help if has_both else f"write {quoted}",
        fixes=(replace(fix, title=f"Write {quoted}"),),
    )


def _leads_on(failure: ParseFailure, fix: Fix, read_again: ReadAgain | None, rounds: int = 2) -> bool:
    """Whether a fix of a piece, and the fixes of what is left, lead to a text without a syntax error.

    Without ``read_again``, the piece is one that is read again itself; then the answer is true.
    """
    if read_again is None or is_mended(failure, fix):
        return True
    piece, source = span_of(failure.tokens[:-1]), failure.source
    text, end = "", 0
    for edit in sorted(fix.edits, key=lambda edit: edit.span.start):
        text += source.text[end : edit.span.start] + edit.text
        end = edit.span.end
    changed = SourceFile(source.name, text + source.text[end:], "text")
    stop = piece.end + len(changed.text) - len(source.text)
    tokens = [token for token in tokenize(changed.text).tokens if piece.start <= token.start and token.end <= stop]
    tokens = [token for token in tokens if token.type != END]
    tokens.append(Token(END, "", stop, stop))
    try:
        lalr.run(load(), failure.start, tokens, Builder(changed, {}))
    except lalr.UnexpectedTokenError as error:
        following = read_again(changed, tokens, error, failure.start)
        if not following.fixes or not rounds:
            return False
        again = ParseFailure(changed, tokens, error, failure.start)
        return _leads_on(again, following.fixes[0], read_again, rounds - 1)
    return True


def _is_quoted(clauses: Clauses | None, help_: str) -> bool:
    """Whether a help names what ends, in time, a condition that is the only clause of a sentence."""
    if clauses is None or len(clauses) > 1 or " implies eventually within " not in clauses[0]:
        return False
    return any(clauses[0].endswith(text) for text in help_.split("`")[1::2] if " not " in text)


def _compares_bools(words: Words) -> bool:
    """Whether a sentence compares the name of a bool with a condition in brackets: `alive == (hp > 0)`."""
    signs = [at for at, word in enumerate(words) if word.type == "EQUALS" and at]
    return any(is_event(words[at - 1 : at]) and words[at + 1 : at + 2].text == "(" for at in signs)


def _is_change(words: Words) -> bool:
    """Whether a sentence says how a number changes, and not by how much or to what value."""
    found = words.find(CHANGES)
    following = "" if found is None else words.word(found[0] + len(found[1]))
    stop = 0 if found is None else found[0] + len(found[1])
    return found is not None and (stop == len(words) or following in ("while", "during", "when", "if"))


def is_mended(failure: ParseFailure, fix: Fix) -> bool:
    """Whether a fix leaves no syntax error in the piece; always true for a fix that is not within the piece."""
    piece = span_of(failure.tokens[:-1])
    if not all(piece.start <= edit.span.start and edit.span.end <= piece.end for edit in fix.edits):
        return True
    body = mended(failure, fix)
    source = SourceFile("", f"spec s {{ {body} }}", "text")
    lexed = tokenize(source.text)
    try:
        lalr.run(load(), "module", lexed.tokens, Builder(source, lexed.docs))
    except lalr.UnexpectedTokenError:
        return False
    return True


def mended(failure: ParseFailure, fix: Fix) -> str:
    """Return the text of the piece after a fix."""
    piece = span_of(failure.tokens[:-1])
    text, end = "", piece.start
    for edit in sorted(fix.edits, key=lambda edit: edit.span.start):
        text += failure.source.text[end : edit.span.start] + edit.text
        end = edit.span.end
    return text + failure.source.text[end : piece.end]


def sentence_words(failure: ParseFailure) -> Words:
    """Return the words of a piece of a spec, without a label before them and a stop behind them."""
    words = words_of(failure.source, declared_names(failure.source), failure.tokens[:-1], ENGLISH)
    while words and words[-1].text in (".", ";", "!") and len(words) > 1:
        words = words[:-1]
    return without_braces(with_own_calls(_without_label(words)))


def _without_label(words: Words) -> Words:
    """Return the words after a label such as `bonus:`, if a clause follows."""
    found = words.find([(":",)])
    if found is None:
        return words
    is_condition = words.word(0) in ("if", "when", "whenever", "while", "after", "once", "all", "any")
    label = words[: found[0]]
    is_rule = any(word.is_name or word.type == "NUMBER" for word in label)
    is_label = not is_rule and tuple(word.text for word in label) not in _RULE_LABELS
    rest = words[found[0] + 1 :]
    return rest if is_label or (rest.word(0) in KEYWORDS and not is_condition) else words


def _read(words: Words) -> Clauses | None:
    """Return the clauses of a sentence, first with its words as they are, then with the names that they spell."""
    clauses = _sentence(words)
    return clauses if clauses is not None else _request(words)


def _request(words: Words) -> Clauses | None:
    named = with_names(words)
    if words.find(_CARRIED):
        states = [state_of(part) for part in named.split(phrases("and"))]
        held = [state.at(AND) for state in states if state is not None]
        return (f"reach {' and '.join(held)}",) if len(held) == len(states) == 2 else None
    is_verb = is_imperative(words) and words.word(0) not in KEYWORDS
    for known in (words, named) if named.text != words.text else (words,):
        clauses = (_sentence(known) if known is not words else None) or request_of(known, is_imperative=is_verb)
        if clauses is not None:
            return clauses
    return None


def _sentence(words: Words) -> Clauses | None:
    return (
        _own_clause(words) or _operators(words) or _goals(words) or _joined(words) or rule_of(words) or goal_of(words)
    )


def _operators(words: Words) -> Clauses | None:
    """Return the clauses of `eventually a and always b`: one for each operator."""
    parts = words.split(phrases("and"))
    keywords = {"eventually": "reach", "always": "keep"}
    if len(parts) < 2 or not all(part.word(0) in keywords for part in parts):
        return None
    states = [state_of(part[1:]) for part in parts]
    known = [
        f"{keywords[part.word(0)]} {state.text}" for part, state in zip(parts, states, strict=True) if state is not None
    ]
    return tuple(known) if len(known) == len(parts) else None


def _goals(words: Words) -> Clauses | None:
    """Return the clauses of `reach a and reach b`, perhaps with `in any order` behind them."""
    end = words.find_last(phrases("in any order", "in whatever order"))
    if end is not None and end[0] + len(end[1]) == len(words):
        words = words[: end[0]]
    parts = words.split(phrases("and reach", ", reach", ", and reach"))
    if len(parts) < 2 or words.word(0) != "reach":
        return None
    states = [state_of(part.without([("reach",)])) for part in parts]
    known = [state for state in states if state is not None]
    return tuple(f"reach {state.text}" for state in known) if len(known) == len(states) else None


def _own_clause(words: Words) -> Clauses | None:
    """Return a clause that can be parsed as it stands."""
    if _compares_bools(words):
        return None
    return (words.text,) if words.word(0) in KEYWORDS and is_valid((words.text,)) else None


def _joined(words: Words) -> Clauses | None:
    """Return the clauses of two sentences that a word joins: `reach the exit and never be seen`."""
    joint = _joint(words)
    if joint is None:
        return None
    left, right = words[: joint[0]], words[joint[0] + len(joint[1]) :]
    first = _unconditional(left)
    if first is None:
        return None
    if joint[1] == ("without",):
        if left.find(phrases("and", "or", "then", ",")) or words.word(0) not in ("reach", "keep"):
            return None  # it may be about the last goal alone
        state = state_of(right.without(phrases("ever", "being", "ever being")))
        return None if state is None else (*first, f"avoid {state.text}")
    second = _sentence(right)
    is_forbidden = right.phrase(0, PROHIBITIONS) and first[0].startswith("avoid ")
    if second is not None and is_forbidden and joint[1] not in _STOPS and not second[0].startswith("avoid "):
        return None  # the condition of `no a and no b while c` is about both
    return None if second is None else (*first, *second)


def _joint(words: Words) -> tuple[int, tuple[str, ...]] | None:
    """Return where a sentence ends, and another begins with its own keyword or `never`; None if there is one alone."""
    start = 1
    while found := words.find(_JOINTS, start):
        at, joint = found
        following = words[at + len(joint) :].without(SUBJECTS)
        is_forbidding = bool(following.phrase(0, PROHIBITIONS))
        begins = following.word(0) in KEYWORDS and words.word(0) not in ("reach", "keep")
        if joint == ("without",) or is_forbidding or begins:
            return found
        start = at + len(joint)
    return None


def _unconditional(words: Words) -> Clauses | None:
    """Return the clauses of a sentence without a condition, which could apply to the next sentence, too."""
    if words.word(0) in KEYWORDS:
        own = _own_clause(words)
        if own is not None:
            return None if words.find(phrases("implies", "or", "until", "->")) else own
    goal = goal_of(words)
    if goal is not None:
        return goal
    is_plain = words.word(0) in ("avoid", "no") or bool(words.phrase(0, NEVER))
    return rule_of(words) if is_plain else None
