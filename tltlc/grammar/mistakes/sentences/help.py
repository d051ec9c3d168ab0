"""Help with a clause that cannot be parsed by the clauses that its English sentence may mean."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, replacement_fix
from tltlc.grammar.english.clauses import plain_text
from tltlc.grammar.english.contradictions import forbids_its_event
from tltlc.grammar.english.doubts import is_english_alone, takes_one_reading
from tltlc.grammar.english.ends import last_seconds
from tltlc.grammar.english.gaps import sentence_with_gaps
from tltlc.grammar.english.notes import form_notes, notes, reading_notes
from tltlc.grammar.english.readings import sentence, sentence_forms, unread_rule
from tltlc.grammar.english.rules import Reading
from tltlc.grammar.english.terminals import CALLED
from tltlc.grammar.lexer import END, tokenize
from tltlc.grammar.mistakes.clauses import is_own_line
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_rewrite import REAL_TIME
from tltlc.grammar.mistakes.parse_failure import ParseFailure
from tltlc.grammar.mistakes.rephrasing import span_of
from tltlc.grammar.mistakes.sentences.changes import keeps_values
from tltlc.grammar.mistakes.sentences.limits import counts_in_periods
from tltlc.grammar.mistakes.sentences.names import is_imperative, with_names
from tltlc.grammar.mistakes.sentences.reading import (
    KEYWORDS,
    LONGEST,
    ReadAgain,
    by_patterns,
    is_mended,
    mended,
    sentence_words,
)
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.grammar.mistakes.sentences.vocabulary import DIRECTLY_AFTER, LASTING, UNLESS
from tltlc.grammar.mistakes.sentences.words import Words, phrases
from tltlc.grammar.past_words import SYNONYMS

_AND_NEVER: Final = phrases("and never", "but never")
"""Words before what must not come up to a step, or from it on."""
_ENGLISH_ALONE: Final = (
    *DIRECTLY_AFTER,
    *phrases(
        "since",
        "requires",
        "needs",
        "falls below",
        "drops below",
        "goes below",
        "rises above",
        "goes above",
        "before ends",
        "again only",
        "only again",
        "again until",
        "again till",
        "again before",
        "is never",
        "is out",
        "again",
        "is gone",
        "in first",
        "in the first",
        "of start",
        "at the end",
        "of the start",
    ),
)
"""Words whose meaning in English is not that of an operator, or more than that of a comparison."""
_WITHOUT_REQUIRE: Final = phrases(
    *("change", "changes", "stay", "stays", "remain", "remains", "until within", "at the end"),
    *("until first", "until the first", "before first", "before the first"),
)
"""Words of a sentence behind `require` that need no `require`, which asks for something at the first step alone."""
_DENIED_TWICE: Final = phrases("and no", "or no", "nor")
"""Words before a second thing that is denied, which `not` before both does not say."""
_GOALS: Final = ("reach ", "require eventually ")
"""What clauses begin with that ask for something once, as verbs do."""
_TIMED: Final = (" implies always for ", " implies eventually ", "time_holding(")
"""What an exception behind it may end, or excuse at its start alone."""
_UNITS: Final = frozenset((*REAL_TIME, "step", "steps"))


def sentence_help(
    failure: ParseFailure,
    diagnostic: Diagnostic,
    *,
    is_explained: bool,
    read_again: ReadAgain | None,
    reads_sentences: bool,
) -> Diagnostic:
    """Return the error for a clause with the fix that its English sentence suggests, and what to know of that fix.

    ``is_explained`` says that the error is about a mistake in a clause of the language. Without
    ``reads_sentences``, patterns alone make the fix.
    """
    read = _with_reading if reads_sentences else by_patterns
    helped = read(failure, diagnostic, is_explained=is_explained, read_again=read_again)
    piece = span_of(failure.tokens[:-1]) if len(failure.tokens) > 1 else None
    edits = helped.fixes[0].edits if helped.fixes else ()
    if piece is None or len(edits) != 1 or edits[0].span != piece or len(failure.tokens) > LONGEST:
        return helped
    known = notes(edits[0].text, declared_names(failure.source), failure.source.slice(piece))
    return replace(helped, help="\n".join((*([helped.help] if helped.help else []), *known))) if known else helped


def _with_reading(
    failure: ParseFailure, diagnostic: Diagnostic, *, is_explained: bool, read_again: ReadAgain | None
) -> Diagnostic:
    """Return the error for a clause with the fix that its English sentence suggests, if it has one reading.

    A sentence with several readings gets them in the help, and no fix. ``is_explained`` says that the error is
    about a mistake in a clause of the language.
    """
    known = by_patterns(failure, diagnostic, is_explained=is_explained, read_again=read_again)
    if failure.start != "clause" or failure.tokens[-1].type != END or not 2 < len(failure.tokens) <= LONGEST:
        return known
    if not (failure.tokens[0].text in KEYWORDS or is_own_line(failure)):
        return known
    if known.code == "TLT0110" and "declare " in (known.help or ""):
        return known  # the help says what to declare
    is_whole = bool(known.fixes) and is_mended(failure, known.fixes[0])
    words = sentence_words(failure)
    is_english = (
        words.find(_ENGLISH_ALONE) is not None
        or is_english_alone(words)
        or any(map(counts_in_periods, (words, with_names(words))))
        or (is_whole and _may_miss(failure, known.fixes[0], words))
    )
    if not is_english and (
        (is_whole and not _is_foreign(known.fixes[0], failure)) or _has_readings(failure, known.help or "")
    ):
        return known
    is_until_in_time = words.find(phrases("until")) is not None and words.find(phrases("within")) is not None
    is_at_place = words.word(1) in ("at", "the", "in", "for") or words.find(_WITHOUT_REQUIRE) or is_until_in_time
    if words.word(0) == "require" and is_at_place:
        words = words[1:]
    if not words or words.word(0) == "require":
        return known
    read = sentence(words)
    if not read.readings and not read.limit:
        read = sentence(with_names(words))
    if not read.readings and not read.limit and (unread := unread_rule(words) or unread_rule(with_names(words))):
        return replace(known, help=unread, fixes=())
    is_goal = bool(read.readings) and all(reading.clauses[0].startswith(_GOALS) for reading in read.readings)
    if is_imperative(words) and words.word(0) not in KEYWORDS and not is_goal and not read.limit:
        return known
    if is_whole and not is_english and (len(read.readings) != 1 or _is_same(read.readings[0], failure, known.fixes[0])):
        return known
    if read.readings and " ".join(read.readings[0].clauses) != words.text:
        return _with_readings(failure, known, read.readings)
    if read.limit and not read.readings:
        return replace(known, help=read.limit, fixes=())
    return known if is_whole or read.readings else _with_forms(failure, known, words)


def _with_forms(failure: ParseFailure, diagnostic: Diagnostic, words: Words) -> Diagnostic:
    """Return the error for a sentence that is not understood with the forms that it may mean in the help."""
    is_general = not diagnostic.fixes and diagnostic.code in ("TLT0101", "TLT0107")
    if not is_general or failure.clock_varies or _is_particular(failure, diagnostic.help):
        return diagnostic
    offered = sentence_forms(words) or sentence_forms(with_names(words))
    if not offered:
        return _with_gaps(diagnostic, words)
    known = form_notes(" ".join(form.clause for form in offered), declared_names(failure.source))
    listed = "".join(("\n", *(f"`{form.clause}`: {form.says}\n" for form in offered), *(f"{note}\n" for note in known)))
    return replace(diagnostic, help=f"write one of these, if it says what you mean:{listed.rstrip()}")


def _with_gaps(diagnostic: Diagnostic, words: Words) -> Diagnostic:
    """Return the error for a sentence with the clauses that it may mean, and letters for unknown words."""
    read = sentence_with_gaps(words)
    valid = [reading for reading in read.sentence.readings if is_valid(reading.clauses)] if read else []
    if read is None or not valid:
        return diagnostic
    meant = [f"{_quoted(reading.clauses)} {reading.condition}".rstrip() for reading in valid]
    gaps = " and ".join(f"for `{gap.text}` in place of `{gap.letter}`" for gap in read.gaps)
    conditions = "condition" if len(read.gaps) == 1 else "conditions"
    return replace(diagnostic, help=f"write {', or '.join(meant)}, with your {conditions} {gaps}")


def _is_particular(failure: ParseFailure, help_: str | None) -> bool:
    """Whether a help is about this sentence: it has a name of the file, in a clause that can be parsed or in a part."""
    names = declared_names(failure.source).names
    texts = [text for text in (help_ or "").split("`")[1::2] if names.keys() & {t.text for t in tokenize(text).tokens}]
    return any(text.split(" ")[0] not in KEYWORDS or is_valid((text,)) for text in texts)


def _is_foreign(fix: Fix, failure: ParseFailure) -> bool:
    """Whether a fix leaves words of other languages, at which the next error would be: `==` of an enum, `prev(x)`."""
    names, tokens = declared_names(failure.source).names, tokenize(mended(failure, fix)).tokens
    return any(
        token.type in ("EQUALS", "UNEQUAL")
        or (token.text in SYNONYMS and token.text not in names)
        or (token.text in CALLED and token.type == "NAME" and following.text == "(")
        or (token.text == "is" and following.text in ("on", "off"))
        for token, following in pairwise(tokens)
    )


def _may_miss(failure: ParseFailure, fix: Fix, words: Words) -> bool:
    """Whether a fix takes one of two readings.

    It compares a value with that of the step before from some step on, or while something holds, and the first such
    step may not be meant. Or it says how long something lasts `unless` something else comes, which may also end that
    time, or `after` something, which may itself last. Or it counts what comes before the condition of its rule, too,
    or leaves a condition out of what it counts, or of its rule. Or an exception may excuse the last seconds. Or it
    asks for a step of what play must finish with.
    """
    text = mended(failure, fix)
    answer = text.partition(" implies ")[2]
    is_new = "times(" not in words.text
    is_counted = is_new and "times(" in answer and any(sign in answer for sign in (" <= ", " < "))
    is_joined = is_new and text.startswith("keep times(") and " and " in text
    is_compared = (" implies always " in text or " implies eventually within " in text) and "previous(" in text
    is_same = words.find(LASTING) is not None and keeps_values(text.partition(" implies ")[2])
    is_denied = " implies always for " in text and " not " in text and words.find(phrases("after")) is not None
    is_never = words.find(_AND_NEVER) is not None and " and always not " in answer
    return (
        words.word(0) == "finish"
        or is_never
        or forbids_its_event((text,))
        or ("\n" in text and " implies " not in text.partition("\n")[0] and words.find(phrases("implies")) is not None)
        or " next after " in text
        or (" or " in text.partition("time_holding(")[2].partition(") ")[0] and words.find(phrases("or")) is not None)
        or (words.find(_DENIED_TWICE) is not None and " and not " in text)
        or (words.find(UNLESS) is not None and bool(last_seconds(text)))
        or is_compared
        or is_counted
        or is_joined
        or is_same
        or is_denied
        or takes_one_reading(text, words)
        or (words.find(UNLESS) is not None and any(part in text for part in _TIMED))
    )


def _is_same(reading: Reading, failure: ParseFailure, fix: Fix) -> bool:
    """Whether a fix leaves the clauses of a reading, apart from blanks and brackets."""
    return plain_text(" ".join(reading.clauses)) == plain_text(mended(failure, fix))


def _has_readings(failure: ParseFailure, help_: str) -> bool:
    """Whether a help names two forms in the words of the file; clauses among them can be parsed."""
    names = declared_names(failure.source).names
    texts = {text for text in help_.split("`")[1::2] if not text.isidentifier()}
    texts = {text for text in texts if text.split(" ")[0] not in KEYWORDS or is_valid((text,))}
    used = [{token.text for token in tokenize(text).tokens if token.type == "NAME"} - _UNITS for text in texts]
    return sum(bool(known) and known <= names.keys() for known in used) > 1


def _with_readings(failure: ParseFailure, diagnostic: Diagnostic, found: tuple[Reading, ...]) -> Diagnostic:
    """Return the error with the reading of a sentence as its fix, or with its readings in the help."""
    valid = [
        reading
        for reading in found
        if is_valid(reading.clauses) and not failure.lacks_fixed_clock(" ".join(reading.clauses))
    ]
    span = span_of(failure.tokens[:-1])
    if not valid or "//" in failure.source.slice(span):
        return diagnostic
    texts = [_quoted(reading.clauses) for reading in valid]
    if len(valid) > 1 or valid[0].condition:
        described = [f"{text} {reading.condition}".rstrip() for text, reading in zip(texts, valid, strict=True)]
        known = reading_notes(" ".join(valid[0].clauses), declared_names(failure.source), failure.source.slice(span))
        return replace(diagnostic, help="\n".join((f"write {', or '.join(described)}", *known)), fixes=())
    indent = failure.source.text[: span.start].rpartition("\n")[2]
    separator = f"\n{indent}" if not indent.strip() else " "
    fix = replacement_fix(failure.source, span, separator.join(valid[0].clauses))
    return replace(diagnostic, help=f"write {texts[0]}", fixes=(replace(fix, title=f"Write {texts[0]}"),))


def _quoted(clauses: tuple[str, ...]) -> str:
    """Return clauses in a help: ``keep a`` and ``reach b`` in quotes of code."""
    return " and ".join(f"`{clause}`" for clause in clauses)
