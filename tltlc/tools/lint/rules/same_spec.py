"""TLT0426: a spec that asks for the same as another spec of the file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.rule import LintRule, RuleFinding

_WORK: Final = 200_000
"""The most steps of work for the comparison of two specs.

Specs that need more count as different, because a note must not take longer than the compilation.
"""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each spec that accepts the same traces as an earlier spec.

    Both must also have the same judge, limit and level. Specs that every trace or no trace satisfies
    are left out, because the compiler already warns of them.
    """
    earlier_specs: dict[object, list[SpecView]] = {}
    for spec in view.specs:
        if spec.is_settled:
            continue
        alike = earlier_specs.setdefault(_form(spec.fspa), [])
        earlier = next((candidate for candidate in alike if _accept_the_same(candidate.fspa, spec.fspa)), None)
        if earlier is None:
            alike.append(spec)
            continue
        title = f"`{spec.spec.name}` means the same as `{earlier.spec.name}`"
        labels = (spec.name_label("this spec"), earlier.name_label("the other spec"))
        yield RuleFinding(title, labels, "remove one of them, or write what makes them different")


def _form(fspa: Fspa) -> object:
    """Return a key: only specs whose automata have equal keys can count as the same spec.

    The key has the semantics, judge, limit, level and ``spec_size`` of the automaton. Over finite
    traces, it also has the edges, so that automata with equal keys accept the same traces.
    """
    settings = (fspa.semantics, fspa.judge, fspa.limit_steps, fspa.level, fspa.spec_size)
    return settings if fspa.semantics == "infinite" else (*settings, _edges(fspa))


def _edges(fspa: Fspa) -> tuple[object, ...]:
    """Return the edges in a canonical form, which does not depend on how states and atoms are numbered.

    So minimal automata that accept the same traces have the same form.
    """
    leaving: dict[int, list[tuple[list[list[tuple[str, bool]]], int]]] = {state.id: [] for state in fspa.states}
    for edge in fspa.edges:
        primes = sorted(
            sorted((fspa.atoms[index].name, holds) for index, holds in prime) for prime in edge.guard.primes
        )
        leaving[edge.source].append((primes, edge.target))
    order, places = [0], {0: 0}
    canonical: list[object] = []
    for state in order:
        for primes, target in sorted(leaving[state]):
            if target not in places:
                places[target] = len(order)
                order.append(target)
            canonical.append((places[state], fspa.states[target].accepting, str(primes), places[target]))
    return tuple(canonical)


def _accept_the_same(one: Fspa, other: Fspa) -> bool:
    """Whether two automata with the same key (:func:`_form`) accept the same traces.

    False as well if the comparison takes more than ``_WORK`` steps.
    """
    if one.semantics == "finite":
        return True
    from tltlc.automaton.compare import are_equivalent
    from tltlc.automaton.work import OutOfWork

    try:
        return are_equivalent(one, other, _WORK)
    except OutOfWork:
        return False


RULE = LintRule("TLT0426", "note", check, lint_only=True)
