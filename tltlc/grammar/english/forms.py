"""Forms of clauses for the conditions of a sentence that has no reading, each with what it says."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from itertools import pairwise
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import ATOM, State

_MOST_FORMS: Final = 4
"""The most forms that a help names."""
_CONDITIONAL: Final = frozenset("if when whenever while during once after every each for on upon given at".split())
"""Words before the condition of a rule."""
_BEHIND: Final = frozenset("if when whenever while during once after unless until till since only".split())
"""Words between an answer and the condition of its rule."""
_IMPLICATIONS: Final = frozenset(("implies", "->", "=>"))
"""Words between the condition of a rule and its answer."""
_PAIRED: Final = frozenset("between both either neither exactly precisely to".split())
"""Words whose meaning no form has."""
_MODALS: Final = ("must", "should", "may", "can", "will", "shall")
_UNCLEAR: Final = frozenset(
    "again longer may allowed end ends least more less but second further another right directly "
    "immediately straight just".split()
)
"""Words beside two conditions that the forms would take for their opposite, or leave out."""
_INEXPRESSIBLE: Final = frozenset(
    "unless except otherwise else changes change changing toggles toggle flips flip switches switch "
    "alternate half".split()
)
"""Words for exceptions, for two cases, for changes and shares, which no form has."""
_PAST_WORDS: Final = frozenset("last past previous".split())
"""Words before a time that lies behind each step."""
_WHOLE: Final = frozenset("for always throughout whole no not never during".split())
"""Words that may ask for every step of such a time, or for none."""
_EDGES: Final = ("begins", "ends")
_BEGUN: Final = ("begins ", "ends ")
_BEGINNINGS: Final = frozenset("begins begin starts start becomes".split())
_NEGATIONS: Final = frozenset("no not never avoid without cannot can't don't mustn't nor".split())

_DENIED_BEHIND: Final = frozenset(("not", "never", "cannot", "can't", "mustn't", "off", "wait", "waits"))
"""Words behind a condition that say that it must not hold."""
_ONLY: Final = frozenset("only without unless until till before".split())
"""Words with which a sentence that forbids something says when it is allowed."""
_PROHIBITIONS: Final = frozenset(("avoid", "never", "no", "cannot", "can't"))


@record
class Form:
    """A clause, and what it says of the conditions in it."""

    clause: str
    says: str


@record
class _Pattern:
    """A form with places for conditions, a time ``T`` and a number ``n``, and the words of sentences that it may suit.

    ``t`` is the condition of a rule, ``r`` its answer, and ``p`` the answer without a word such as
    `never` before it; ``a``, ``b`` and ``c`` are conditions in their order.
    """

    clause: str
    says: str
    cues: str


_ONE: Final = (
    _Pattern("reach {a}", "{a} at some step", "reach get find at some point be finish end"),
    _Pattern("keep {a}", "{a} at every step", "keep always must stay stays be all only"),
    _Pattern("avoid {p}", "{p} at no step", "avoid never no not without cannot can must"),
    _Pattern("keep {a} implies always {a}", "from the first {a} on, {a} at every step", "once stays stay again ever"),
    _Pattern("require eventually always {a}", "{a} at the last step", "end last finish finally final"),
)
_ONE_IN_TIME: Final = (
    _Pattern("require eventually within {T} {a}", "{a} at some step of the first {T}",
             "within in by before reach under"),
    _Pattern("reach time_holding({a}) >= {T}", "{a} for {T} in a row, once", "reach for hold holds stay survive"),
    _Pattern("avoid time_holding({p}) > {T}", "{p} never for more than {T} in a row",
             "avoid never no more longer most max than exceed"),
    _Pattern("keep begins {a} implies always for {T} {a}", "{a} lasts at least {T} each time",
             "least lasts last each every stays stay for once"),
    _Pattern("keep time_holding(not {a}) <= {T}", "{a} again at most {T} after its last step",
             "every each least per again"),
    _Pattern("require always for {T} {a}", "{a} at every step of the first {T}", "first start for beginning"),
    _Pattern("avoid (begins {p}) then within {T} (begins {p})", "two beginnings of {p} are more than {T} apart",
             "between two twice again cooldown wait apart"),
)  # fmt: skip
_ONE_COUNTED: Final = (
    _Pattern("reach times({a}) >= {n}", "{a} begins at least {n} times", "reach least least collect do get must"),
    _Pattern("keep times({p}) <= {n}", "{p} begins at most {n} times", "most more avoid max only up than keep"),
)
_TWO: Final = (
    _Pattern("keep {t} implies {r}", "at each step with {t}, {r}",
             "when if while whenever during then means implies only must at"),
    _Pattern("keep {t} implies eventually {r}", "at every step with {t}, {r} then or later",
             "when if whenever after then once follow followed eventually must later"),
    _Pattern("keep {t} implies always {r}", "from the first {t} on, {r} at every step",
             "after once from stays stay always never ever no"),
    _Pattern("keep {p} implies once {t}", "{p} only after {t}, or at the same step",
             "only before after first without needs requires"),
    _Pattern("require {r} weak_until {t}", "{r} at every step before {t}, which need not come", "until till before"),
    _Pattern("require {r} until {t}", "{r} at every step before {t}, which must come", "until till"),
    _Pattern("keep {r} or {t}", "{r} at each step without {t}", "unless except"),
    _Pattern("reach {a} then {b}", "{a} at some step, and {b} at a later one", "reach then after get and finally"),
    _Pattern("reach {a} and {b}", "both at one step", "reach and with while get"),
)  # fmt: skip
_TWO_IN_TIME: Final = (
    _Pattern("keep {t} implies eventually within {T} {r}", "at every step with {t}, {r} then or at most {T} later",
             "when if whenever after within in then must later by under each every"),
    _Pattern("keep {p} implies once within {T} {t}", "{p} only at most {T} after {t}",
             "only ago last before since earlier"),
    _Pattern("reach {a} then within {T} {b}", "{a} at some step, and {b} at most {T} later", "reach then within get"),
    _Pattern("keep {t} implies always for {T} {r}", "from each step with {t} on, {r} for {T}",
             "for stays stay keep lasts after no never avoid when"),
    _Pattern("keep begins {t} implies always for {T} {r}", "from each beginning of {t} on, {r} for {T}",
             "for stays stay keep lasts after no never avoid starts begins"),
    _Pattern("keep time_holding({t}) >= {T} implies {r}", "once {t} has held for {T} in a row, {r}",
             "for when if whenever been longer than after"),
    _Pattern("keep {p} implies time_holding({t}) >= {T}", "{p} only when {t} has held for {T} in a row",
             "only for unless until after without been"),
    _Pattern("keep {t} implies not time_holding({p}) > {T}", "while {t}, {p} never for more than {T} in a row",
             "while during never more longer than most avoid"),
)  # fmt: skip
_TWO_COUNTED: Final = (
    _Pattern("keep {t} implies times({r}) >= {n}", "at each step with {t}, {r} has begun at least {n} times",
             "when if before least only after"),
    _Pattern("keep {t} implies times({r}) <= {n}", "at each step with {t}, {r} has begun at most {n} times",
             "when if most more never than before"),
    _Pattern("keep times({t}) >= {n} implies {r}", "once {t} has begun {n} times, {r} at every step",
             "after once when times if"),
)  # fmt: skip
_THREE: Final = (
    _Pattern("reach {a} then {b} then {c}", "one after the other", "reach then"),
    _Pattern("keep {t} implies ({r} weak_until {c})", "from each {t} on, {r} at every step before {c}",
             "until till between"),
    _Pattern("keep begins {t} implies ({r} weak_until {c})",
             "from each beginning of {t} on, {r} at every step before {c}",
             "until till between"),
    _Pattern("keep begins {t} implies ({r} weak_until ({c} or not {t}))",
             "from each beginning of {t} on, {r} at every step before {c}, and no longer than {t}",
             "until till between"),
    _Pattern("keep {a} implies (not {c} since {b})", "{a} only if {b} has been since the last {c}",
             "since"),
    _Pattern("keep {a} implies previously (not {a} since ({b} and not {a}))",
             "each {a} needs a {b} after the {a} before, and before its own step",
             "since"),
    _Pattern("keep {a} implies {b} or previously (not {a} since ({b} and not {a}))",
             "each {a} needs a {b} after the {a} before, or at its own step",
             "since"),
    _Pattern("keep {t} and {c} implies {r}", "at each step with {t} and {c}, {r}",
             "while during unless"),
)  # fmt: skip
PAST: Final[Mapping[str, Sequence[_Pattern]]] = {
    "event answer time": (
        _Pattern("keep {t} implies once within {T} {r}", "at each step with {t}, {r} then or at most {T} before", ""),
    ),
    "event time answer": (
        _Pattern("keep once within {T} {t} implies {r}", "at each step at most {T} after {t}, {r}", ""),
    ),
    "answer event time": (
        _Pattern("keep {p} implies once within {T} {t}", "{p} only at most {T} after {t}, or at the same step", ""),
        _Pattern("keep once within {T} {t} implies {r}", "at each step at most {T} after {t}, {r}", ""),
    ),
}
"""Maps the order of two conditions and a time such as `in the last 3 s` to the forms, which look back."""
PATTERNS: Final[Mapping[tuple[int, bool, bool], Sequence[_Pattern]]] = {
    (1, False, False): _ONE,
    (1, True, False): _ONE_IN_TIME,
    (1, False, True): _ONE_COUNTED,
    (2, False, False): _TWO,
    (2, True, False): _TWO_IN_TIME,
    (2, False, True): _TWO_COUNTED,
    (3, False, False): _THREE,
}
"""Maps the number of conditions, and whether there is a time and a count, to the forms."""

Part = State | Duration | Term
"""A part of a sentence: a condition, a time, or another word."""


def forms(parts: Sequence[Part]) -> tuple[Form, ...]:
    """Return the forms that a sentence may mean, the likeliest first; () if its parts suit none."""
    parts = _with_edges(parts)
    conditions = [at for at, part in enumerate(parts) if isinstance(part, State)]
    durations = [part for part in parts if isinstance(part, Duration)]
    words = [part.text for part in parts if isinstance(part, Term)]
    numbers = [text for text in map(_count, _with_next(words)) if text]
    key = (len(conditions), bool(durations), bool(numbers))
    if len([part for part in parts if isinstance(part, Term) and part.kind == "NUMBER"]) > len(numbers):
        return ()
    if not _INEXPRESSIBLE.isdisjoint(words):
        return ()
    if numbers and not _NEGATIONS.isdisjoint(words) and "more" not in words:
        return ()  # `never 3 times` allows two
    if len(conditions) > 1 and not numbers and not _UNCLEAR.isdisjoint(words):
        return ()
    if key not in PATTERNS or len(durations) > 1 or len(numbers) > 1 or not set(words).isdisjoint(_PAIRED):
        return ()
    slots = _slots(parts, conditions)
    texts = {name: state.at(ATOM) for name, state in slots.items()}
    texts.update(T=durations[0].text if durations else "", n=numbers[0] if numbers else "")
    cues = set(words)
    if key == (2, True, False) and not _PAST_WORDS.isdisjoint(words):
        return _past_forms(parts, slots, texts)
    known = [p for p in PATTERNS[key] if words[:1] not in (["keep"], ["avoid"]) or not p.clause.startswith("reach")]
    known = [pattern for pattern in known if _keeps_words(pattern, cues, slots)]
    if not cues.isdisjoint(_NEGATIONS | _DENIED_BEHIND):
        known = [pattern for pattern in known if _denies(pattern, cues, texts)]
    ranked = sorted(known, key=lambda pattern: -len(cues & set(pattern.cues.split())))
    fitting = [pattern for pattern in ranked if cues & set(pattern.cues.split())]
    if not fitting and len(conditions) < 3:
        fitting = known[:3]
    quoted = {name: f"`{text}`" if name not in "Tn" else text for name, text in texts.items()}
    in_steps = any(duration.is_steps for duration in durations)
    if texts.get("r", "").startswith("time_holding("):  # it may begin in that time, and then last
        fitting = [p for p in fitting if "{T} {r}" not in p.clause]
    fitting = [p for p in fitting if not (in_steps and "time_holding" in p.clause)]  # which is a time in seconds
    all_forms = (Form(p.clause.format(**texts), p.says.format(**quoted)) for p in fitting)
    return tuple({form.clause: form for form in all_forms}.values())[:_MOST_FORMS]


def _denies(pattern: _Pattern, words: Set[str], texts: Mapping[str, str]) -> bool:
    """Whether a form of a sentence that forbids something forbids it, too, or says when alone it is allowed."""
    if pattern.clause.startswith("keep {p} implies once"):
        return not words.isdisjoint(_ONLY)
    clause = pattern.clause.format(**texts)
    is_goal = clause.startswith(("reach not ", "require eventually within"))
    return not is_goal and (clause.startswith("avoid ") or "not " in clause or "times(" in clause)


def _past_forms(parts: Sequence[Part], slots: Mapping[str, State], texts: Mapping[str, str]) -> tuple[Form, ...]:
    """Return the forms of `whenever a, b in the last 3 s`; () if each step of that time may be meant."""
    words = {part.text for part in parts if isinstance(part, Term)}
    conditions = [at for at, part in enumerate(parts) if isinstance(part, State)]
    time = next(at for at, part in enumerate(parts) if isinstance(part, Duration))
    is_event_first = slots["t"] == _signed(parts, conditions[0])
    if not _WHOLE.isdisjoint(words) or time < conditions[0] or texts["r"].startswith("time_holding("):
        return ()
    if time > conditions[1]:
        order = "event answer time" if is_event_first else "answer event time"
    else:
        order = "event time answer" if is_event_first else ""
    quoted = {name: text if name == "T" else f"`{text}`" for name, text in texts.items()}
    return tuple(Form(p.clause.format(**texts), p.says.format(**quoted)) for p in PAST.get(order, ()))


def _with_edges(parts: Sequence[Part]) -> list[Part]:
    """Return the parts with `begins` and `ends` as part of the condition behind them."""
    joined: list[Part] = []
    for part in parts:
        before = joined[-1] if joined else None
        if isinstance(part, State) and isinstance(before, Term) and before.text in _EDGES:
            joined[-1] = State(f"{before.text} {part.at(ATOM)}")
        else:
            joined.append(part)
    return joined


def _keeps_words(pattern: _Pattern, words: Set[str], slots: Mapping[str, State]) -> bool:
    """Whether a form keeps what the words of a sentence say about time, and about where a condition begins."""
    is_begun = "begins {" in pattern.clause
    event = slots.get("t", slots.get("a"))
    if is_begun and event is not None and event.text.startswith(_BEGUN):
        return False  # the condition is a beginning already
    if not is_begun and not words.isdisjoint(_BEGINNINGS):
        return False  # a beginning that belongs to no condition
    is_held = "always for" in pattern.clause or "time_holding" in pattern.clause
    if is_held and "within" in words and "for" not in words:
        return False  # one step of that time is enough
    if "time_holding({t})" in pattern.clause and event is not None and event.text.startswith(_BEGUN):
        return False  # a beginning is one step
    answer = slots.get("r")
    is_denied = answer is not None and answer.text.startswith("not ") and not words.isdisjoint(_PROHIBITIONS)
    if is_denied and "eventually" in pattern.clause:
        return False  # one step without it is not enough
    same = slots.get("a") == slots.get("c")
    return not (("since {b})" in pattern.clause and same) or ("since ({b}" in pattern.clause and not same))


def _slots(parts: Sequence[Part], conditions: Sequence[int]) -> dict[str, State]:
    """Return the conditions by the letters of their places."""
    states = {at: _signed(parts, at) for at in conditions}
    plain = {at: part for at in conditions if isinstance(part := parts[at], State)}
    slots = dict(zip("abc", states.values(), strict=False))
    if len(conditions) < 2:
        return {**slots, "p": plain[conditions[0]]}
    first, second = conditions[:2]
    between = {part.text for part in parts[first:second] if isinstance(part, Term)}
    before = {part.text for part in parts[:first] if isinstance(part, Term)}
    is_denied = bool(between & _DENIED_BEHIND) and not between & {"then", "and"}
    is_behind = (bool(between & _BEHIND) or is_denied) and not before & _CONDITIONAL and not between & _IMPLICATIONS
    event, answer = (second, first) if is_behind else (first, second)
    slots.update(t=states[event], r=states[answer], p=plain[answer])
    return slots


def _signed(parts: Sequence[Part], at: int) -> State:
    """Return the condition at an index; its opposite if `never` stands before it, or `must not` behind it."""
    state, before = parts[at], _word(parts, at - 1)
    assert isinstance(state, State)
    behind = _word(parts, at + 2) if _word(parts, at + 1) in _MODALS else _word(parts, at + 1)
    return state.negated() if before in _NEGATIONS or behind in _DENIED_BEHIND else state


def _word(parts: Sequence[Part], at: int) -> str:
    """Return the word at an index; "" for a condition, a time, and outside the sentence."""
    part = parts[at] if 0 <= at < len(parts) else None
    return part.text if isinstance(part, Term) else ""


def _with_next(words: Sequence[str]) -> Iterator[tuple[str, str]]:
    yield from pairwise([*words, ""])


def _count(pair: tuple[str, str]) -> str:
    """Return the number of `3 times` and `twice`; "" for other words."""
    word, following = pair
    often = {"once": "", "twice": "2", "thrice": "3"}
    return word if word.isdecimal() and following in ("times", "time", "x") else often.get(word, "")
