"""The readings of an English sentence: the clauses that it may mean."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice, pairwise, product
from typing import Any, Final

from tltlc.core.record import record, replace
from tltlc.grammar.english.alternatives import Alternatives
from tltlc.grammar.english.arguments import with_read_arguments
from tltlc.grammar.english.bounds import Bounds
from tltlc.grammar.english.contradictions import behind_its_count, behind_its_event, forbids_its_event, has_empty_option
from tltlc.grammar.english.counts_since import CountsSince
from tltlc.grammar.english.cut_off import strong_clause, uncut, without_cut_off
from tltlc.grammar.english.ends import end_of, with_end, with_last_seconds
from tltlc.grammar.english.events import Crossing, as_state
from tltlc.grammar.english.exceptions import Exceptions
from tltlc.grammar.english.extremes import Extremes
from tltlc.grammar.english.forms import Form, Part, forms
from tltlc.grammar.english.later_times import LaterTimes
from tltlc.grammar.english.ordinals import Ordinals
from tltlc.grammar.english.periods import Periods
from tltlc.grammar.english.rules import Reading, Rules
from tltlc.grammar.english.sentence_parser import SentenceParser, sentence_parser
from tltlc.grammar.english.tails import Tails
from tltlc.grammar.english.terminals import UNKNOWN, Term, known_terms, terms
from tltlc.grammar.english.timed_answers import TimedAnswers
from tltlc.grammar.english.toggles import Toggles
from tltlc.grammar.english.transitions import Transitions
from tltlc.grammar.english.two_events import TwoEvents
from tltlc.grammar.english.two_rules import TwoRules
from tltlc.grammar.english.windows import Windows
from tltlc.grammar.mistakes.sentences.states import State
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.grammar.mistakes.sentences.words import Words, phrases

_MOST_READINGS: Final = 4
"""The most readings that a help names."""
_LONGEST_PART: Final = 12
"""The most terminals of a condition in a sentence that is not understood."""
_FIRST: Final = ("BOOL", "ENUM", "INT", "REAL", "PREVIOUS_ENUM", "_LPAR")
"""The terminals with which such a condition begins."""
_EMPTY: Final = frozenset("it he she they we you your my has have had to do does did see so just will would".split())
"""Words that say nothing by themselves."""
_CONTENT: Final = frozenset((*_FIRST, UNKNOWN, "VALUE", "SIGN", "UNIT", "TIME_UNIT"))
"""The terminals that a sentence which is understood has in conditions and times alone."""
_TELLING: Final = frozenset("first second third fourth fifth exactly half average".split())
"""Words that no form says, and without which a sentence says something else."""
_LASTING: Final = frozenset("stays stay remains remain must should never".split())
"""Words of a condition alone that make it a rule for every step."""
_VERBS: Final = phrases(
    *("lasts", "takes", "goes", "follows", "is followed", "happens", "must", "may", "changes only", "only"),
    *("never twice", "never two", "never three"),
)
"""Words that need no `keep` before their sentence."""
_NEVER: Final = phrases("never drops", "never falls", "never rises", "never changes", "never goes", "never loses")
_IN_TIME: Final = phrases("within", "in any", "over")
_BEFORE_EVENTS: Final = frozenset(("while", "during", "between"))
"""Words that begin a rule of their own, and need no `keep` before them."""
_COMING: Final = ("come", "comes")
_FORBIDDING: Final = ("avoid", "never", "no")
_KEYWORDS: Final = ("reach", "keep", "avoid")
"""The words with which the rules of one line begin."""
_FEWEST_RULES: Final = 3
_BETWEEN: Final = (",", ";", "and", "but")
"""The words between two rules."""
_MOST: Final = 64
"""The most ways in which the parts of one phrase are put together."""


class Meanings(
    Tails,
    TwoRules,
    Exceptions,
    Toggles,
    Alternatives,
    CountsSince,
    TwoEvents,
    Ordinals,
    TimedAnswers,
    LaterTimes,
    Windows,
    Periods,
    Bounds,
    Extremes,
    Transitions,
):
    """The meanings of all rules of the grammar."""


@record
class Sentence:
    """The readings of a sentence; if there is none, ``limit`` may say why no clause can say it."""

    readings: tuple[Reading, ...] = ()
    limit: str = ""


def sentence(words: Words) -> Sentence:
    """Return the readings of a sentence; none if it is no sentence of the grammar.

    An exception from a limit on the last seconds excuses its own step, or those seconds.
    """
    read = _whole_sentence(words)
    end = end_of(words) if len(read.readings) == 1 else None
    excuse = _said_state(end.condition) if end is not None and end.excuses and end.time is None else None
    if excuse is None:
        return read
    return replace(read, readings=tuple(with_last_seconds(read.readings[0], excuse)))


def _whole_sentence(words: Words) -> Sentence:
    """Return the readings of a sentence.

    Several lines may be one sentence, or one for each line. Without lark, which the playground does not
    load, no sentence is read.
    """
    weak = _without_cut_off(words)
    if weak is not None:
        return weak
    typed, words = words, with_read_arguments(words, _said_condition)
    if words is not typed and is_valid((words.text,)):
        return Sentence((Reading((words.text,)),))
    whole = _sentence(words)
    is_verb = words.word(1) in (*_BEFORE_EVENTS, "no") or words.find(_VERBS)
    is_limit = words.find(_NEVER) is not None and words.find(_IN_TIME) is not None
    needs_no_keep = words.word(0) == "keep" and (is_verb or is_limit)
    if not whole.readings and not whole.limit and needs_no_keep:
        whole = _sentence(words[1:])
    if not whole.readings and not whole.limit and words.word(0) == "always" and words.word(1) in _BEFORE_EVENTS:
        whole = _sentence(words[1:])
    if whole.readings or whole.limit:
        return whole
    rules = [reading for _, reading in _rules(words)]
    if rules and all(rules):
        return Sentence((Reading(tuple(clause for rule in rules if rule for clause in rule.clauses)),))
    lines = words.lines()
    if len(lines) < 2:
        return whole if whole.limit else _with_end(words)
    sentences = [_sentence(line) for line in lines]
    if any(len(line.readings) != 1 for line in sentences):
        return whole
    return Sentence((Reading(tuple(clause for line in sentences for clause in line.readings[0].clauses)),))


def _without_cut_off(words: Words) -> Sentence | None:
    """Return the reading of a sentence that ends in `unless the recording ends`; None for other sentences."""
    before, clause = uncut(words), strong_clause(words)
    if before is None and not clause:
        return None
    if before is not None:
        readings = sentence(before).readings
        is_one = len(readings) == 1 and not readings[0].condition and len(readings[0].clauses) == 1
        clause = before.text if is_valid((before.text,)) else readings[0].clauses[0] if is_one else ""
    # Where the clock varies, a step may come so late that nothing was missing for the time.
    weak = without_cut_off(clause) if clause and not words.names.clock_varies else ""
    return Sentence((Reading((weak,)),) if weak and is_valid((weak,)) else ())


def _with_end(words: Words) -> Sentence:
    """Return the readings of a sentence whose end, such as `unless c`, no rule of the grammar has."""
    end = end_of(words)
    if end is None or (end.time is not None and words.word(0) in _FORBIDDING):
        return Sentence()  # what may excuse a second event is not what comes within a time
    if end.time is not None and end.time in f" {end.before.text} " and (shorter := _sentence(end.whole)).readings:
        return shorter
    condition = _said_state(end.condition)
    readings = sentence(end.before).readings if condition is not None else ()
    if len(readings) == 1 and readings[0].condition:
        return Sentence()  # it may mean something else, too
    ended = [with_end(reading, end, condition) for reading in readings if condition is not None]
    known = [reading for reading in ended if reading is not None and is_valid(reading.clauses)]
    is_all = len(known) == len(readings) or end.time is not None
    return Sentence(tuple(known) if is_all else ())


def _said_condition(words: Words) -> str:
    """Return the condition that words say; "" if they say none, or may say several."""
    state = _said_state(words)
    return "" if state is None else state.text


def _said_state(words: Words) -> State | None:
    parser = sentence_parser()
    terminals = terms(words, parser.vocabulary) if parser else None
    tree = parser.parse(terminals, "part") if parser and terminals else None
    values = _values(tree.children[0], Meanings(words.names)) if tree else []
    return as_state(values[0]) if len(values) == 1 else None


def unread_rule(words: Words) -> str:
    """Return which of several rules in one line is not understood, and the clauses of the others; "" if none is."""
    rules = _rules(words)
    unread = [text for text, reading in rules if reading is None]
    clauses = [f"`{clause}`" for _, reading in rules if reading is not None for clause in reading.clauses]
    if len(unread) != 1:
        return ""
    return f"write each rule on a line of its own: {' and '.join(clauses)}; `{unread[0]}` is not understood"


def _rules(words: Words) -> list[tuple[str, Reading | None]]:
    """Return the rules of `avoid a, keep b, and avoid c`, each with its reading; none if there are fewer.

    Each begins with its own keyword. The first of two rules may be meant otherwise: `keep a or b, reach c`.
    """
    starts = [at for at in words.outer() if words.word(at) in _KEYWORDS and (not at or words.word(at - 1) in _BETWEEN)]
    if len(starts) < _FEWEST_RULES or starts[0] or not any(words.word(at) in (",", ";") for at in range(len(words))):
        return []
    rules = []
    for start, stop in pairwise([*starts, len(words)]):
        while stop < len(words) and words.word(stop - 1) in _BETWEEN:
            stop -= 1
        rule = words[start:stop]
        readings = (Reading((rule.text,)),) if is_valid((rule.text,)) else _sentence(rule).readings
        rules.append((rule.text, readings[0] if len(readings) == 1 and not readings[0].condition else None))
    return rules


def sentence_forms(words: Words) -> tuple[Form, ...]:
    """Return the forms of clauses that a sentence without a reading may mean; none without lark."""
    parser = sentence_parser()
    if parser is None:
        return ()
    terminals = [term for term in known_terms(words, parser.vocabulary) if term.text not in _EMPTY]
    rules = Meanings(words.names)
    if any(term.kind == UNKNOWN or (term.kind == "BOOL" and term.declared is None) for term in terminals):
        return ()
    if any(one.kind == "UNIT" and other.text in ("of", "time") for one, other in pairwise(terminals)):
        return ()  # a share of the time
    if any(term.text in _TELLING for term in terminals):
        return ()  # no form says the number of an event
    parts: list[Part] = []
    at = 0
    while at < len(terminals):
        state, stop = _condition(parser, terminals, at, rules)
        if state is not None:
            parts.append(state)
        elif [term.kind for term in terminals[at : at + 2]] == ["NUMBER", "TIME_UNIT"]:
            parts.append(rules.duration(*terminals[at : at + 2]))
            stop = at + 2
        else:
            parts.append(terminals[at])
        at = stop
    if any(isinstance(part, Term) and part.kind in _CONTENT for part in parts):
        return ()  # no form would say all of it
    clauses = (form for form in forms(parts) if is_valid((form.clause,)))
    return tuple(form for form in clauses if not forbids_its_event((form.clause,)))


def _condition(parser: SentenceParser, terminals: Sequence[Term], start: int, rules: Rules) -> tuple[State | None, int]:
    """Return the longest condition that begins at an index, and where it ends; else None and the next index."""
    if terminals[start].kind not in _FIRST and terminals[start].text != "not":
        return None, start + 1
    for stop in range(min(len(terminals), start + _LONGEST_PART), start, -1):
        if terminals[stop - 1].kind in (UNKNOWN, "_COMMA"):
            continue
        tree = parser.parse(terminals[start:stop], "part")
        for state in _values(tree.children[0], rules) if tree else ():
            if isinstance(state, State):
                return state, stop
    return None, start + 1


def _sentence(words: Words) -> Sentence:
    parser = sentence_parser()
    terminals = terms(words, parser.vocabulary) if parser else None
    return sentence_of(parser, terminals, words) if parser and terminals else Sentence()


def sentence_of(parser: SentenceParser, terminals: Sequence[Term], words: Words) -> Sentence:
    """Return the readings of a sentence of these terminals; ``words`` has the names that its file declares."""
    tree = parser.parse(_never_first(terminals))
    if tree is None:
        return Sentence()
    unique: dict[tuple[str, ...], Reading] = {}
    rules = Meanings(words.names)
    rules.is_lasting = any(term.text in _LASTING for term in terminals)
    rules.is_again = any(term.text == "again" for term in terminals)
    rules.is_before = any(term.text == "before" for term in terminals)
    rules.is_coming = any(term.text in _COMING for term in terminals)
    rules.edges = frozenset(
        name.text for edge, name in pairwise(terminals) if edge.text in ("begins", "ends") and name.kind in _FIRST
    )
    for reading in _values(tree.children[0], rules):
        unique.setdefault(reading.clauses, reading)
    if len(unique) > _MOST_READINGS:
        return Sentence()
    if not any(term.text in ("reach", "sometime") for term in terminals):
        _drop_goals(unique)
    for key in [key for key in unique if len(key) == 1 and key[0].startswith("keep ")]:
        if later := behind_its_count(key[0]):
            reading = unique.pop(key)
            unique.setdefault((later,), replace(reading, clauses=(later,)))
    empty = [key for key in unique if len(key) == 1 and has_empty_option(key[0])]
    for key in empty if len(empty) < len(unique) else ():
        del unique[key]
    _label_once(unique)
    for clauses, reading in list(unique.items()):
        if forbids_its_event(clauses):
            del unique[clauses]
            later = behind_its_event(clauses[0]) if len(clauses) == 1 else ""
            if later:
                unique.setdefault((later,), replace(reading, clauses=(later,)))
    return Sentence(tuple(unique.values()), next(iter(rules.limits), ""))


def _label_once(found: dict[tuple[str, ...], Reading]) -> None:
    """Say when `once a, b` means the operator `once`, and when `once` is a word for `when`."""
    for key in [key for key in found if len(key) == 1 and key[0].startswith("keep once ")]:
        when = ("keep " + key[0].removeprefix("keep once "),)
        if when in found and not found[key].condition and not found[when].condition:
            operator = replace(found.pop(key), condition="if it is asked for again at every later step")
            found[when] = replace(found.pop(when), condition="if it is asked for at each of its steps alone")
            found[key] = operator


def _drop_goals(found: dict[tuple[str, ...], Reading]) -> None:
    """Drop the readings in which the second of two events is a goal: that of `no a between b and begins c`."""
    goals = [key for key in found if len(key) > 1 and key[-1].startswith("reach ")]
    if len(goals) < len(found):
        for key in goals:
            del found[key]


def _never_first(terminals: Sequence[Term]) -> list[Term]:
    """Return `never mode is menu` for `mode is never menu`, which denies all that follows: `or play`, `for 3 s`."""
    ordered = list(terminals)
    for at, (name, verb, never) in enumerate(zip(ordered, ordered[1:], ordered[2:], strict=False)):
        if name.kind == "ENUM" and (verb.text, never.text) == ("is", "never"):
            ordered[at : at + 3] = [never, name, verb]
    return ordered


def _values(node: Any, rules: Rules) -> list[Any]:
    """Return what a node of the tree may mean; equal meanings of an ambiguous node count once."""
    if isinstance(node, str):
        return [node.value]  # type: ignore[attr-defined]
    if node.data == "_ambig":
        return _unique([value for child in node.children for value in _values(child, rules)])
    function = getattr(rules, node.data)
    results: list[Any] = []
    for parts in islice(product(*(_values(child, rules) for child in node.children)), _MOST):
        value = function(*parts)
        if isinstance(value, list):
            results += value
        elif value is not None:
            results.append(value)
    return _unique(results)


def _unique(values: list[Any]) -> list[Any]:
    """Return the different values; the crossing of a limit is also read as the state behind it, which is left out."""
    crossed = [value.state for value in values if isinstance(value, Crossing)]
    different: list[Any] = []
    for value in values:
        if value not in different and value not in crossed:
            different.append(value)
    return different
