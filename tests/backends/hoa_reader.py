"""A strict reader of the Hanoi omega-automata format, version 1, after http://adl.github.io/hoaf/.

It reads one automaton, deterministic or not, without universal branching and with explicit labels on edges.  It
raises ValueError for everything that the format does not allow.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

LARGEST = 2**31 - 1
_TOKEN = re.compile(
    r"""(?P<string>"(?:\\.|[^\\"])*")
    |(?P<header>[a-zA-Z_][0-9a-zA-Z_-]*:)
    |(?P<word>[a-zA-Z_][0-9a-zA-Z_-]*)
    |(?P<int>(?:0|[1-9][0-9]*)(?![0-9a-zA-Z_]))
    |(?P<alias>@[0-9a-zA-Z_-]+)
    |(?P<mark>--(?:BODY|END)--)
    |(?P<sign>[\[\]{}()!&|])""",
    re.VERBOSE | re.DOTALL,
)
_ESCAPE = re.compile(r'\\(?:(["\\])|u([0-9a-f]{4})|U([0-9a-f]{8}))|([^\\])', re.DOTALL)

Letter = Sequence[bool]
Expression = Callable[[Sequence[bool]], bool]


@dataclass
class Edge:
    label: Expression
    target: int
    sets: frozenset[int]


@dataclass
class State:
    name: str | None
    sets: frozenset[int]
    edges: list[Edge] = field(default_factory=list)


@dataclass
class Hoa:
    """An automaton: the items of the header, and the states by number."""

    starts: list[int] = field(default_factory=list)
    atoms: list[str] = field(default_factory=list)
    aliases: dict[str, Expression] = field(default_factory=dict)
    sets: int = -1
    accepts: Expression = bool
    acceptance: str = ""
    acceptance_name: str = ""
    properties: list[str] = field(default_factory=list)
    strings: dict[str, list[str]] = field(default_factory=dict)
    count: int | None = None
    states: dict[int, State] = field(default_factory=dict)
    comments: list[str] = field(default_factory=list)

    def edges_taken(self, state: int, letter: Letter) -> list[tuple[int, frozenset[int]]]:
        """Return the targets of the edges that a letter takes, each with its acceptance sets."""
        here = self.states[state]
        return [(edge.target, edge.sets | here.sets) for edge in here.edges if edge.label(letter)]

    def run(self, trace: Iterable[Letter]) -> int | None:
        """Return the last state of the only run on a finite trace, or None if there is no run."""
        (state,) = self.starts
        for letter in trace:
            taken = self.edges_taken(state, letter)
            if not taken:
                return None
            ((state, _),) = taken
        return state

    def accepts_lasso(self, prefix: Sequence[Letter], cycle: Sequence[Letter]) -> bool:
        """Whether a run on ``prefix`` and then ``cycle`` forever exists and satisfies the acceptance condition."""
        state = self.run(prefix)
        rounds: list[frozenset[int]] = []
        first_rounds: dict[int, int] = {}
        while state is not None and state not in first_rounds:
            first_rounds[state] = len(rounds)
            marks: frozenset[int] = frozenset()
            for letter in cycle:
                taken = self.edges_taken(state, letter)
                if not taken:
                    return False
                ((state, sets),) = taken
                marks |= sets
            rounds.append(marks)
        if state is None:
            return False
        recurring = frozenset().union(*rounds[first_rounds[state] :])
        return self.accepts([number in recurring for number in range(self.sets)])


def read(text: str) -> Hoa:
    """Parse a text that is exactly one automaton."""
    return _Reader(text).automaton()


class _Reader:
    def __init__(self, text: str) -> None:
        self.hoa = Hoa()
        self.tokens = [*self._tokens(text), ("end", "")]
        self.at = 0

    def _tokens(self, text: str) -> Iterable[tuple[str, str]]:
        at = 0
        while at < len(text):
            if text[at] in " \t\n\r":
                at += 1
            elif text.startswith("/*", at):
                end = self._comment_end(text, at)
                self.hoa.comments.append(text[at:end])
                at = end
            else:
                match = _TOKEN.match(text, at)
                if match is None:
                    raise ValueError(f"no token: {text[at : at + 20]!r}")
                yield str(match.lastgroup), match.group()
                at = match.end()

    @staticmethod
    def _comment_end(text: str, start: int) -> int:
        depth = 0
        for match in re.compile(r"/\*|\*/").finditer(text, start):
            depth += 1 if match.group() == "/*" else -1
            if depth == 0:
                return match.end()
        raise ValueError("a comment without an end")

    # --- tokens ---

    def peek(self) -> tuple[str, str]:
        return self.tokens[self.at]

    def take(self, kind: str, text: str | None = None) -> str:
        actual, token = self.tokens[self.at]
        if actual != kind or (text is not None and token != text):
            raise ValueError(f"{token!r} where {text or kind} should be")
        self.at += 1
        return token

    def take_if(self, text: str) -> bool:
        if self.peek() == ("sign", text):
            self.at += 1
            return True
        return False

    def number(self, below: int = LARGEST + 1) -> int:
        value = int(self.take("int"))
        if value >= min(below, LARGEST + 1):
            raise ValueError(f"{value} is too large")
        return value

    def string(self) -> str:
        inside = self.take("string")[1:-1]
        pieces = list(_ESCAPE.finditer(inside))
        if "".join(piece.group() for piece in pieces) != inside:
            raise ValueError(f"an escape that is none: {inside!r}")
        return "".join(piece[1] or piece[4] or chr(int(piece[2] or piece[3], 16)) for piece in pieces)

    # --- the header ---

    def automaton(self) -> Hoa:
        self.take("header", "HOA:")
        self.take("word", "v1")
        seen: set[str] = set()
        while self.peek()[0] == "header":
            name = self.take("header")
            if name in seen and name not in ("Start:", "Alias:", "properties:"):
                raise ValueError(f"{name} twice")
            seen.add(name)
            self._item(name)
        if "Acceptance:" not in seen:
            raise ValueError("no acceptance")
        self.take("mark", "--BODY--")
        while self.peek() == ("header", "State:"):
            self._state()
        self.take("mark", "--END--")
        self.take("end")
        self._whole()
        return self.hoa

    def _item(self, name: str) -> None:
        hoa = self.hoa
        match name:
            case "States:":
                hoa.count = self.number()
            case "Start:":
                hoa.starts.append(self.number())
            case "AP:":
                hoa.atoms = [self.string() for _ in range(self.number())]
                if len(set(hoa.atoms)) < len(hoa.atoms):
                    raise ValueError("two atoms of one name")
            case "Alias:":
                alias = self.take("alias")
                if alias in hoa.aliases:
                    raise ValueError(f"{alias} twice")
                hoa.aliases[alias] = self.expression(self._atom)
            case "Acceptance:":
                hoa.sets = self.number()
                start = self.at
                hoa.accepts = self.expression(self._set)
                hoa.acceptance = "".join(token for _, token in self.tokens[start : self.at])
            case "acc-name:":
                hoa.acceptance_name = " ".join([self.take("word"), *self._values("int", "word")])
            case "properties:":
                hoa.properties += self._values("word")
            case "tool:" | "name:":
                hoa.strings[name] = [self.string()]
                if name == "tool:" and self.peek()[0] == "string":
                    hoa.strings[name].append(self.string())
            case _:
                hoa.strings[name] = []
                while self.peek()[0] in ("int", "word", "string"):
                    text = self.string() if self.peek()[0] == "string" else self._values("int", "word")[0]
                    hoa.strings[name].append(text)

    def _values(self, *kinds: str) -> list[str]:
        values = []
        while self.peek()[0] in kinds:
            values.append(self.take(self.peek()[0]))
        return values

    # --- expressions: ! before & before | ---

    def expression(self, leaf: Callable[[], Expression]) -> Expression:
        operands = [self._conjunction(leaf)]
        while self.take_if("|"):
            operands.append(self._conjunction(leaf))
        return lambda values: any(operand(values) for operand in operands)

    def _conjunction(self, leaf: Callable[[], Expression]) -> Expression:
        operands = [self._operand(leaf)]
        while self.take_if("&"):
            operands.append(self._operand(leaf))
        return lambda values: all(operand(values) for operand in operands)

    def _operand(self, leaf: Callable[[], Expression]) -> Expression:
        if self.take_if("("):
            inner = self.expression(leaf)
            self.take("sign", ")")
            return inner
        if self.peek() in (("word", "t"), ("word", "f")):
            constant = self.take("word") == "t"
            return lambda _: constant
        return leaf()

    def _atom(self) -> Expression:
        if self.take_if("!"):
            inner = self._operand(self._atom)
            return lambda letter: not inner(letter)
        if self.peek()[0] == "alias":
            return self.hoa.aliases[self.take("alias")]
        atom = self.number(len(self.hoa.atoms))
        return lambda letter: letter[atom]

    def _set(self) -> Expression:
        kind = self.take("word")
        if kind not in ("Fin", "Inf"):
            raise ValueError(f"an unknown acceptance: {kind}")
        self.take("sign", "(")
        number = self.number(self.hoa.sets)
        self.take("sign", ")")
        return lambda sets: sets[number] == (kind == "Inf")

    # --- the body ---

    def _state(self) -> None:
        self.take("header", "State:")
        number = self.number()
        if number in self.hoa.states:
            raise ValueError(f"state {number} twice")
        name = self.string() if self.peek()[0] == "string" else None
        state = self.hoa.states[number] = State(name, self._sets())
        while self.take_if("["):
            label = self.expression(self._atom)
            self.take("sign", "]")
            state.edges.append(Edge(label, self.number(), self._sets()))

    def _sets(self) -> frozenset[int]:
        if not self.take_if("{"):
            return frozenset()
        numbers = []
        while not self.take_if("}"):
            numbers.append(self.number(self.hoa.sets))
        if len(set(numbers)) < len(numbers):
            raise ValueError("a set twice")
        return frozenset(numbers)

    def _whole(self) -> None:
        """Raise ValueError unless all states are defined, and only they are referred to."""
        hoa = self.hoa
        if set(hoa.states) != set(range(len(hoa.states))) or hoa.count not in (None, len(hoa.states)):
            raise ValueError("a state is missing, or there is one too many")
        targets = {edge.target for state in hoa.states.values() for edge in state.edges}
        if not targets.union(hoa.starts) <= set(hoa.states):
            raise ValueError("there is no such state")
