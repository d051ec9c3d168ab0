"""The automaton in the Hanoi omega-automata format (HOA), version 1 (http://adl.github.io/hoaf/), for other tools.

Over infinite traces, the file has a Rabin automaton with acceptance on edges. The format has no
automata over finite traces. For these, the file has a Büchi automaton with marks on the accepting
states, and a header that says that a finite trace is accepted if its run ends in one of them.

The format has no registers. If a spec has timers in place of bounds, the file has the automaton in
which states take their place. A spec that remembers anything else is refused: with its atoms as free
propositions, the file would have another language.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Final

from tltlc import __version__
from tltlc.artefact.size import check_size
from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa, Guard, Implicant
from tltlc.automaton.guards import Guards, TooManyPrimes
from tltlc.automaton.infinite.mark_conditions import pair_marks
from tltlc.automaton.transitions import ACCEPT, REJECT, TransitionDiagrams
from tltlc.backends import Files, Options, Target
from tltlc.backends.drawing.texts import escape_invisible
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.expression.tree import SignalValue, nodes
from tltlc.logic.formula import FALSE, TRUE
from tltlc.resolve.spec import Register, RegisterKind

TARGET = Target("hoa", "an omega-automaton in the Hanoi format (HOA), for model checkers", (".hoa",))

# By the format, a tool that does not know a header with a capital first letter must refuse the file or warn. Without
# this header, the tool would read an automaton with another meaning.
FINITE_HEADER = 'Tltlc-semantics: "finite"'
FINITE_COMMENT = "A finite trace is accepted if its run ends in a state of set 0."
_KEPT_BY_NAME: Final[tuple[RegisterKind, ...]] = (
    *("once", "historically", "since", "previously", "times"),
    *("previous", "initial", "highest", "lowest"),
)
"""The kinds of registers that a spec asks for itself, if no atom of a timer reads them."""
OTHER_MEMORY = "leave out the target `hoa`, or state the rule without this memory"
FIXED_CLOCK = "write a `clock` with a fixed rate, such as `clock 60 Hz`, or leave out the target `hoa`"
ALLOWED_COMMENT = "Exclusive atoms never hold at once: a letter that is not @allowed has no edge."


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the HOA file ``NAME.hoa``, where NAME is the name of the automaton.

    Formulas are in ASCII notation, and atoms are numbered as in the artefact; if states take the place
    of timers, as in the artefact of a spec without timers.

    Raises:
        TltlError: TLT0004 the file would be larger than `tltlc import` reads, TLT0713 the automaton
            has registers, and states cannot take their place.
    """
    if fspa.registers:
        fspa = _without_registers(fspa, options)
    clashes = sorted({pair for group in fspa.exclusive for pair in combinations(sorted(set(group)), 2)})
    with recursion_room():
        lines = [*_header(fspa, clashes), "--BODY--", *_body(fspa), "--END--", ""]
    text = "\n".join(lines)
    check_size(f"`{fspa.name}.hoa`", len(text.encode()))
    return {f"{fspa.name}.hoa": text}


def _without_registers(fspa: Fspa, options: Options) -> Fspa:
    """Return the automaton of the same spec with states in place of timers; raise TltlError, TLT0713, if that fails."""
    timers = [atom for atom in fspa.atoms if atom.timer is not None]
    of_timers = {node.name for atom in timers for node in nodes(atom.expression) if isinstance(node, SignalValue)}
    named = [register for register in fspa.registers if register.kind in _KEPT_BY_NAME]
    kept = [register for register in named if register.name not in of_timers]
    if kept or not timers:
        raise TltlError([_refusal(fspa, kept or fspa.registers, OTHER_MEMORY)])
    if fspa.clock_varies:
        title = f"`{fspa.name}` has timers on a clock that varies, which the Hanoi format cannot express: "
        title += "a time is no number of steps"
        raise TltlError([Diagnostic("TLT0713", title, help=FIXED_CLOCK)])
    if options.without_timers is None:
        raise TltlError(
            [_refusal(fspa, fspa.registers, "compile the .tltl file: then states take the place of timers")]
        )
    try:
        unfolded = options.without_timers(fspa.name)
    except TltlError as error:
        title = f"`{fspa.name}` has timers, which the Hanoi format cannot express, and is too large without them"
        labels = tuple(label for diagnostic in error.diagnostics for label in diagnostic.labels)
        advice = "shorten the bounds, choose a slower `clock`, or raise `--state-budget`"
        raise TltlError([Diagnostic("TLT0713", title, labels, advice)]) from error
    if unfolded.registers:
        raise TltlError([_refusal(unfolded, unfolded.registers, OTHER_MEMORY)])
    return unfolded


def _refusal(fspa: Fspa, registers: Sequence[Register], advice: str) -> Diagnostic:
    shown = next((register for register in registers if register.kind not in ("last", "first")), registers[0])
    title = f"`{fspa.name}` remembers `{shown.name}`, which the Hanoi format cannot express"
    return Diagnostic("TLT0713", title, help=advice)


def _header(fspa: Fspa, clashes: Sequence[tuple[int, int]]) -> Iterator[str]:
    """Yield the header lines of a HOA file, which come before its body.

    ``clashes`` are the pairs of atoms, by index, that never hold at once.
    """
    yield "HOA: v1"
    yield f'tool: "tltlc" {_string(__version__)}'
    yield f"name: {_string(fspa.name)}"
    if fspa.doc.strip():
        yield _comment(fspa.doc)
    yield f"States: {len(fspa.states)}"
    yield "Start: 0"
    yield " ".join([f"AP: {len(fspa.atoms)}", *(_string(atom.name) for atom in fspa.atoms)])
    if clashes:
        yield f"Alias: @allowed {' & '.join(f'!({first}&{second})' for first, second in clashes)}"
        yield _comment(ALLOWED_COMMENT)
    infinite = fspa.semantics == "infinite"
    yield from _rabin(len(fspa.acceptance)) if infinite else ("acc-name: Buchi", "Acceptance: 1 Inf(0)")
    marks = "trans-acc" if infinite else "state-acc"
    yield f"tltlc-formula: {_string(str(fspa.formula))}"
    yield f"tltlc-judge: {fspa.judge}"
    if fspa.limit_steps is not None:
        yield f"tltlc-limit: {fspa.limit_steps}"
    if fspa.level is not None:
        yield f"tltlc-level: {_string(fspa.level)}"
    yield f"properties: trans-labels explicit-labels {marks} deterministic{'' if clashes else ' complete'}"
    if not infinite:
        yield FINITE_HEADER
        yield _comment(FINITE_COMMENT)


def _rabin(pairs: int) -> tuple[str, str]:
    """Return the two header lines for Rabin acceptance with this number of pairs.

    Rabin pair i has the sets 2i and 2i + 1. A run may visit set 2i only finitely often, and must
    visit set 2i + 1 infinitely often.
    """
    terms = [f"Fin({2 * pair})&Inf({2 * pair + 1})" for pair in range(pairs)]
    condition = "|".join(map("({})".format, terms)) if pairs > 1 else "".join(terms) or "f"
    return f"acc-name: Rabin {pairs}", f"Acceptance: {2 * pairs} {condition}"


def _body(fspa: Fspa) -> Iterator[str]:
    labels, finite = _EdgeLabels(fspa), fspa.semantics == "finite"
    leaving: list[list[str]] = [[] for _ in fspa.states]
    for edge, marks in zip(fspa.edges, fspa.marks(), strict=True):
        sets = f" {{{' '.join(map(str, sorted(pair_marks(marks))))}}}" if marks else ""
        leaving[edge.source].append(f"[{labels.label(edge.guard)}] {edge.target}{sets}")
    for state in fspa.states:
        yield f"State: {state.id} {_string(str(state.label))}{' {0}' if finite and state.accepting else ''}"
        yield from leaving[state.id]


class _EdgeLabels:
    """Converts guards to edge labels of a HOA file, which are expressions over the numbers of atoms.

    A label is built from the prime implicants of the guard, since they define the guard; the
    guard's text is only for readers. Letters in which two exclusive atoms hold cannot occur; the
    label is false on them.
    """

    def __init__(self, fspa: Fspa) -> None:
        self._diagrams = TransitionDiagrams()
        self._allowed = self._diagrams.allowed_letters(fspa.exclusive)
        self._guards = Guards(self._diagrams, [str(number) for number in range(len(fspa.atoms))], self._allowed)
        self._known: dict[tuple[Implicant, ...], str] = {}

    def label(self, guard: Guard) -> str:
        """Return the label of a guard, without square brackets: ``0 & !1`` if atom 0 holds and atom 1 does not."""
        if guard.primes not in self._known:
            self._known[guard.primes] = self._label(guard.primes)
        return self._known[guard.primes]

    def _label(self, primes: Sequence[Implicant]) -> str:
        try:
            text = self._short(primes)
        except (OutOfSteps, TooManyPrimes):
            text = " | ".join(map(_product, primes))
        if self._allowed == ACCEPT:
            return text
        # On letters that exclusive atoms rule out, the prime implicants may be true or false: exclude these letters.
        return "@allowed" if text == "t" else f"@allowed & ({text})" if "|" in text else f"@allowed & {text}"

    def _short(self, primes: Sequence[Implicant]) -> str:
        """Return the disjunction of the prime implicants as a short formula, with atoms as their numbers.

        Raises OutOfSteps or TooManyPrimes if this takes too much work.
        """
        diagrams, function = self._diagrams, REJECT
        for prime in primes:
            cube = ACCEPT
            for atom, polarity in sorted(prime, reverse=True):
                cube = diagrams.node(atom, REJECT, cube) if polarity else diagrams.node(atom, cube, REJECT)
            function = diagrams.disjoin(function, cube)
        formula = self._guards.formula(diagrams.conjoin(function, self._allowed))
        return {TRUE: "t", FALSE: "f"}.get(formula) or str(formula)


def _product(prime: Implicant) -> str:
    return " & ".join(f"{'' if polarity else '!'}{atom}" for atom, polarity in prime) or "t"


def _string(text: str) -> str:
    r"""Return a string in quotes, with quotes and backslashes escaped, and invisible characters as ``\uXXXX``."""
    return f'"{"".join(map(_character, text))}"'


def _character(character: str) -> str:
    if character in '"\\':
        return f"\\{character}"
    if escape_invisible(character) == character:
        return character
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def _comment(text: str) -> str:
    """Return the text as a comment of a HOA file.

    In the text, ``/*`` becomes ``/ *`` and ``*/`` becomes ``* /``, since HOA comments nest.
    """
    lines = [escape_invisible(line.strip()) for line in text.strip().splitlines()]
    return f"/* {re.sub('(?<=[*])(?=/)|(?<=/)(?=[*])', ' ', chr(10).join(lines))} */"
