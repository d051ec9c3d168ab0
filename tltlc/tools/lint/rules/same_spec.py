"""TLT0426: a spec that asks for the same as another one of the file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.tools.lint.file_view import SpecView, View
from tltlc.tools.lint.rule import Remark, Rule

_WORK: Final = 200_000
"""Steps after which two specs count as different: a note must not take longer than the compilation."""


def check(view: View) -> Iterator[Remark]:
    """A remark for each spec that accepts what an earlier one does, and is judged as it is.

    Of one that every trace satisfies, or none, the compiler has said what is wrong with it.
    """
    firsts: dict[object, list[SpecView]] = {}
    for spec in view.specs:
        if spec.is_settled:
            continue
        alike = firsts.setdefault(_form(spec.fspa), [])
        earlier = next((each for each in alike if _accept_the_same(each.fspa, spec.fspa)), None)
        if earlier is None:
            alike.append(spec)
            continue
        title = f"`{spec.spec.name}` asks for the same as `{earlier.spec.name}`"
        labels = (spec.name_label("this one again"), earlier.name_label("the other one"))
        yield Remark(title, labels, "remove one of them, or say what tells them apart")


def _form(fspa: Fspa) -> object:
    """What two specs of a file share that may accept the same; over finite traces they then do."""
    settings = (fspa.semantics, fspa.judge, fspa.limit_steps, fspa.level, fspa.spec_size)
    return settings if fspa.semantics == "infinite" else (*settings, _edges(fspa))


def _edges(fspa: Fspa) -> tuple[object, ...]:
    """The edges from state to state, by guards and not by the numbers that states and atoms happen to have.

    Minimal automata of one language, whose guards are canonical, have the same ones.
    """
    leaving: dict[int, list[tuple[list[list[tuple[str, bool]]], int]]] = {state.id: [] for state in fspa.states}
    for edge in fspa.edges:
        primes = sorted(
            sorted((fspa.atoms[index].name, holds) for index, holds in prime) for prime in edge.guard.primes
        )
        leaving[edge.source].append((primes, edge.target))
    order, places = [0], {0: 0}
    found: list[object] = []
    for state in order:
        for primes, target in sorted(leaving[state]):
            if target not in places:
                places[target] = len(order)
                order.append(target)
            found.append((places[state], fspa.states[target].accepting, str(primes), places[target]))
    return tuple(found)


def _accept_the_same(one: Fspa, other: Fspa) -> bool:
    """Whether two of one form accept the same traces."""
    if one.semantics == "finite":
        return True
    from tltlc.automaton.compare import are_equivalent
    from tltlc.automaton.infinite.work import OutOfWork

    try:
        return are_equivalent(one, other, _WORK)
    except OutOfWork:
        return False


RULE = Rule("TLT0426", "note", check)
