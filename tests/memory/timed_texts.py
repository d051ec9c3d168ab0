"""Random specs with bounds for a clock that varies, as source texts, and random traces; each made from a seed."""

from __future__ import annotations

from random import Random
from typing import Final, NamedTuple

SIGNALS: Final = ("p", "q", "r")
DECLARATIONS: Final = "".join(f"signal {name}: bool\n" for name in SIGNALS)

FORMS: Final = {
    "a deadline from the start": "require eventually within {s} {f}",
    "a rule from the start": "require always for {s} {f}",
    "two rules from the start": "require always for {s} {p} require always for {t} {q}",
    "a rule in the end": "reach always for {s} {p}",
    "a rule in the end, after a goal": "reach {p} then (always for {s} {q})",
    "a rule in the end, after two goals": "reach {p} then {q} then (always for {s} {r})",
    "a response": "keep {p} implies eventually within {s} {q}",
    "a response in words": "keep within {s} of {p}, {q}",
    "a response once": "require within {s} of {p}, {f}",
    "a response at a later sample": "keep {p} implies next eventually within {s} {q}",
    "a response at a later sample, at the end": "keep {p} implies weak_next eventually within {s} {q}",
    "two responses to one": "keep {p} implies (eventually within {s} {q} and eventually within {t} {r})",
    "again and again": "keep eventually within {s} {q}",
    "a rule after an event": "keep {p} implies always for {s} {q}",
    "a rule after an event, later": "keep {p} implies next always for {s} {q}",
    "a rule after an event, later, at the end": "keep {p} implies weak_next always for {s} {q}",
    "a rule again and again": "keep always for {s} {q}",
    "a chain": "reach {p} then within {s} {f}",
    "a chain of three": "reach {p} then within {s} {q} then within {t} {f}",
    "a chain with an open link": "reach {p} then {q} then within {s} {f}",
    "a chain with a late open link": "reach {p} then within {s} {q} then {f}",
    "a chain at the same sample": "reach {p} and eventually within {s} {f}",
    "a chain by a deadline": "require eventually within {s} ({p} then within {t} {q})",
    "a forbidden chain": "avoid ({p} then within {s} {q})",
    "a forbidden chain at the same sample": "avoid {p} and eventually within {s} {q}",
    "a forbidden answer": "keep {p} implies not eventually within {s} {f}",
    "a forbidden deadline": "require not (eventually within {s} {f})",
    "a forbidden rule": "require not (always for {s} {f})",
    "a forbidden response": "require not always ({p} implies eventually within {s} {q})",
    "a choice": "require eventually within {s} {f} or always for {t} {p}",
    "a condition": "require (eventually within {s} {p}) implies ({q} then within {t} {r})",
    "an equivalence": "require (eventually within {s} {p}) iff (always for {t} {q})",
    "a window": "keep once within {s} {p} implies {q}",
    "a window of a rule": "keep historically for {s} {p} implies {q}",
    "a time": "keep time_since({p}) <= {s} implies time_holding({q}) < {t}",
    "a count since an event": "keep times_since({p}, {q}) <= 2",
    "a count in a window": "keep times_within({p}, {s}) <= 2",
    "a time in all since an event": "avoid total_time_since({p}, {q}) > {s}",
    "a time in all": "avoid total_time({p}) > {s}",
    "a time that is reached": "reach time_holding({p}) >= {s} and time_since({q}, 20 s) > {t}",
}
"""For each form with a timer, a clause: ``s`` and ``t`` are times, p, q and r about one sample, f about the future."""

_TIMES: Final = ("0.25 s", "0.5 s", "0.5 s", "0.75 s", "1 s", "1 s", "2.5 s", "0.1 s", "0.3 s", "100 ms", "1e-3 s")
_LENGTHS_S: Final = (0.0, 0.0, 0.125, 0.25, 0.25, 0.5, 0.5, 0.75, 1.0, 2.5, 0.1, 0.2, 1e-9, 1e-3, 3.0, 1e6)


class TimedTrace(NamedTuple):
    """Samples of all signals, and the length of each in seconds."""

    samples: list[dict[str, float]]
    lengths_s: list[float]


class TimedTexts:
    """Makes specs; times are multiples of 1/8 s if ``eighths``."""

    def __init__(self, random: Random, *, eighths: bool = False) -> None:
        self._random = random
        self._times = [f"{n / 8} s" for n in (1, 2, 2, 3, 4, 8, 11)] if eighths else _TIMES

    def form(self, form: str, *, plain: bool) -> str:
        """Return a clause of one of the ``FORMS``; if ``plain``, all its parts are signals."""
        p, q, r = self._random.sample(SIGNALS, 3) if plain else (self._state(2) for _ in range(3))
        f = r if plain else self._future(2)
        return FORMS[form].format(p=p, q=q, r=r, f=f, s=self.time(), t=self.time())

    def clauses(self) -> str:
        """Return one or two clauses: of the ``FORMS``, or of Boolean combinations of bounds."""
        random = self._random
        return " ".join(
            f"{random.choice(('require', 'require', 'keep', 'reach', 'avoid'))} {self._boolean(random.randint(0, 2))}"
            if random.random() < 0.3
            else self.form(random.choice(tuple(FORMS)), plain=random.random() < 0.5)
            for _ in range(random.choice((1, 1, 2)))
        )

    def chain(self, goals: int) -> str:
        """Return a sequence of signals, most with a time, some of them by a deadline."""
        random, text = self._random, self._random.choice(SIGNALS)
        for _ in range(goals - 1):
            within = f"within {self.time()} " if random.random() < 0.85 else ""
            text += f" then {within}{random.choice(SIGNALS)}"
        return f"(eventually within {self.time()} ({text}))" if random.random() < 0.3 else f"({text})"

    def time(self) -> str:
        """Return a time above 0 s."""
        return self._random.choice(self._times)

    def _state(self, depth: int) -> str:
        """Return a formula about the trace so far."""
        random, kind = self._random, self._random.randrange(12)
        if depth <= 0 or kind < 5:
            return random.choice(SIGNALS)
        inner = self._state(depth - 1)
        if kind == 5:
            return f"(not {inner})"
        if kind == 6:
            return f"({inner} {random.choice(('and', 'or', 'implies', 'iff'))} {self._state(depth - 1)})"
        if kind == 7:
            return f"(once within {self.time()} {inner})"
        if kind == 8:
            return f"(historically for {self.time()} {inner})"
        if kind == 9:
            function = random.choice(("time_since", "time_holding", "total_time"))
            maximum = random.choice(("", ", 10 s"))
            return f"({function}({inner}{maximum}) {random.choice(('<', '<=', '>', '>='))} {self.time()})"
        if kind == 10:
            return f"({inner} since {self._state(depth - 1)})"
        return f"({random.choice(('previously', 'begins', 'ends', 'once', 'historically'))} {inner})"

    def _future(self, depth: int) -> str:
        """Return a formula about the rest of the trace."""
        random, kind = self._random, self._random.randrange(9)
        if depth <= 0 or kind < 3:
            return self._state(1)
        inner = self._future(depth - 1)
        if kind == 3:
            return f"({random.choice(('next', 'weak_next', 'eventually', 'always', 'not'))} {inner})"
        if kind == 4:
            return f"({inner} {random.choice(('and', 'or', 'until', 'release'))} {self._future(depth - 1)})"
        if kind == 5:
            return f"({self._state(1)} then {inner})"
        if kind == 6:
            return f"(eventually ({self._state(1)} and eventually within {self.time()} {inner}))"
        return f"({self._state(1)} then within {self.time()} {inner})"

    def _boolean(self, depth: int) -> str:
        """Return a Boolean combination of bounds, in brackets."""
        random, kind = self._random, self._random.randrange(5)
        if depth > 0 and kind == 0:
            return f"(not {self._boolean(depth - 1)})"
        if depth > 0 and kind <= 2:
            connective = random.choice(("and", "or", "implies", "iff"))
            return f"({self._boolean(depth - 1)} {connective} {self._boolean(depth - 1)})"
        before = random.choice(("", "", "", "", "next ", "weak_next "))
        bound = random.choice(("eventually within", "always for"))
        return random.choice(
            (
                f"({before}{bound} {self.time()} {self._future(1)})",
                f"({self._state(1)} then within {self.time()} {self._future(1)})",
                f"(within {self.time()} of {self._state(1)}, {self._future(1)})",
                f"(always ({self._state(1)} implies {before}{bound} {self.time()} {self._state(1)}))",
            )
        )


def timed_trace(random: Random, length: int, *, exclusive: bool = False) -> TimedTrace:
    """Return a trace in which atoms hold seldom, often or in runs, and deadlines are met, missed and jumped over.

    If ``exclusive``, p and q do not hold together.
    """
    chances = [random.choice((0.1, 0.3, 0.7, 0.95)) for _ in SIGNALS]
    stays = random.choice((0.0, 0.5, 0.8))
    lengths_s = random.sample(_LENGTHS_S, random.choice((1, 2, 4, len(_LENGTHS_S))))
    arbitrary = random.choice((0.0, 0.0, 0.3))
    samples: list[dict[str, float]] = []
    for _ in range(length):
        sample = {name: float(random.random() < chance) for name, chance in zip(SIGNALS, chances, strict=True)}
        if samples:
            sample = {name: samples[-1][name] if random.random() < stays else sample[name] for name in sample}
        samples.append({**sample, "q": 0.0} if exclusive and sample["p"] else sample)
    return TimedTrace(
        samples,
        [random.uniform(0, 1.5) if random.random() < arbitrary else random.choice(lengths_s) for _ in samples],
    )
