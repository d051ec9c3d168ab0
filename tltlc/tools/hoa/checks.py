"""Check what the grammar of HOA files cannot express.

Numbers must be in range, and the automaton must be of a kind that tltlc can read.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.source import Span
from tltlc.tools.hoa.problems import DETERMINISTIC, format_error, unsupported_error
from tltlc.tools.hoa.tree import Header, Hoa, HoaExpression, Sets, Targets

FINITE: Final = "Tltlc-semantics:"
"""The header with which tltlc marks automata over finite traces."""


def check(hoa: Hoa) -> None:
    """Raise TltlError for the first problem of a file.

    Raises:
        TltlError: TLT0651 if a state or an acceptance set does not exist, or if a state or the name
            of an atom occurs twice; TLT0652 if the automaton is alternating or does not have
            exactly one ``Start:`` header, if the header :data:`FINITE` has a wrong value or
            contradicts the acceptance, or if an unknown header changes the meaning of the file.
    """
    _check_condition(hoa, hoa.condition)
    for header in hoa.headers:
        _check_header(hoa, header)
    _check_start(hoa)
    _check_states(hoa)
    names: dict[str, Span] = {}
    for atom in hoa.atoms:
        if names.setdefault(atom.text, atom.span) is not atom.span:
            raise format_error(hoa.source, atom.span, f"two atoms are called `{atom.text}`", "rename one of them")


def is_finite(hoa: Hoa) -> bool:
    """Whether the automaton is over finite traces, that is, has the header :data:`FINITE`."""
    return any(header.name == FINITE for header in hoa.headers)


def _check_header(hoa: Hoa, header: Header) -> None:
    """Check one of ``hoa.headers``, the headers that have no field of their own in ``hoa``.

    Raises TltlError, TLT0652, if :data:`FINITE` has a wrong value or contradicts the acceptance, or
    if the header is unknown and begins with a capital letter. The format allows a reader to ignore
    an unknown header only if its name begins in lower case.
    """
    if header.name == FINITE and header.values == ("finite",):
        if (hoa.sets, hoa.condition.op, hoa.condition.outside) != (1, "inf", False):
            title = "over finite traces, the acceptance must be `Acceptance: 1 Inf(0)`"
            raise unsupported_error(hoa.source, header.span, title, "put the states in which a trace may end in set 0")
        for state in hoa.states:
            for edge in state.edges:
                if edge.sets.numbers:
                    title = "over finite traces, states accept, but edges do not"
                    raise unsupported_error(
                        hoa.source, edge.sets.span, title, "write the set after the state that this edge leads to"
                    )
    elif header.name == FINITE:
        title, help_ = (
            'the only value of this header is `"finite"`',
            "leave out the header if traces are infinite",
        )
        raise unsupported_error(hoa.source, header.span, title, help_)
    elif header.name[0].isupper():
        title = f"tltlc does not know the header `{header.name}`, which changes what the automaton means"
        raise unsupported_error(hoa.source, header.span, title, "write the automaton without it")


def _check_start(hoa: Hoa) -> None:
    if not hoa.starts:
        raise unsupported_error(hoa.source, Span(0, 4), "the automaton has no initial state", "name one: `Start: 0`")
    if len(hoa.starts) > 1:
        title = "the automaton has several initial states, so it is not deterministic"
        raise unsupported_error(hoa.source, hoa.starts[1].span, title, DETERMINISTIC)


def _check_states(hoa: Hoa) -> None:
    numbers: set[int] = set()
    for state in hoa.states:
        if state.number in numbers:
            raise format_error(
                hoa.source,
                state.span,
                f"state {state.number} occurs here again",
                "write all of its edges after one `State:`",
            )
        numbers.add(state.number)
    if hoa.count is not None and (excess := next((state for state in hoa.states if state.number >= hoa.count), None)):
        title = f"state {excess.number} does not exist: `States:` declares {hoa.count}, counted from 0"
        raise format_error(hoa.source, excess.span, title, "declare more states, or leave out `States:`")
    for targets in _targets(hoa):
        if len(targets.states) > 1:
            title = "this leads to several states at once, so the automaton is alternating"
            raise unsupported_error(hoa.source, targets.span, title, DETERMINISTIC)
        if targets.states[0] not in numbers:
            title = f"state {targets.states[0]} does not exist"
            raise format_error(hoa.source, targets.span, title, f"add it to the body: `State: {targets.states[0]}`")
    for sets in _sets(hoa):
        _check_set(hoa, max(sets.numbers, default=-1), sets.span)


def _check_condition(hoa: Hoa, condition: HoaExpression) -> None:
    """Raise TltlError, TLT0651, if an acceptance condition uses a set that does not exist."""
    for term in condition.args:
        _check_condition(hoa, term)
    if condition.op in ("fin", "inf"):
        assert isinstance(condition.value, int)
        _check_set(hoa, condition.value, condition.span)


def _check_set(hoa: Hoa, number: int, span: Span) -> None:
    """Raise TltlError, TLT0651, if the file has no acceptance set with this number."""
    if number >= hoa.sets:
        title = f"set {number} does not exist: `Acceptance:` declares {hoa.sets}, counted from 0"
        raise format_error(hoa.source, span, title, "use one of those, or declare more")


def _targets(hoa: Hoa) -> Iterator[Targets]:
    yield from hoa.starts
    for state in hoa.states:
        yield from (edge.targets for edge in state.edges)


def _sets(hoa: Hoa) -> Iterator[Sets]:
    for state in hoa.states:
        yield state.sets
        yield from (edge.sets for edge in state.edges)
