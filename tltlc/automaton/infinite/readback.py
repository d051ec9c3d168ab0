"""Write the labels of states with the operators of the source text, and with operands in the order of the source."""

from __future__ import annotations

from typing import Final

from tltlc.automaton.infinite.label_factoring import Factoring
from tltlc.automaton.infinite.normal_form import infinite_form, with_derived_operators
from tltlc.logic.formula import FALSE, TRUE, Formula, rebuild
from tltlc.logic.text.printer import ascii_text

_MOST_PARTS: Final = 300
"""If a spec has more subformulas, its labels are not rewritten: they are too long to read in any style."""


def without_constants(formula: Formula) -> Formula:
    """Return a formula without ``true`` and ``false`` that is equivalent on every infinite trace.

    If the formula simplifies to a constant, the result is this constant.
    """
    return NormalFormWriter(formula).formula(infinite_form(formula)) if _has_constants(formula) else formula


class NormalFormWriter:
    """Rewrites formulas from the normal form for infinite traces to the style of ``source``.

    If the source has ``a -> F b``, the result has ``a -> F b`` too, instead of ``!a | F b``.
    """

    def __init__(self, source: Formula) -> None:
        self._place: dict[Formula, int] = {}
        self._done: dict[Formula, Formula] = {}
        self._readable: dict[Formula, Formula] = {}
        self._sizes: dict[Formula, int] = {}
        self._factoring: Factoring | None = None
        parts = list(source.walk())
        has_constants = _has_constants(source)
        self._source = source if len(parts) <= _MOST_PARTS else None
        for place, part in enumerate(parts if self._source else ()):
            form = with_derived_operators(infinite_form(part), self._readable)
            if form not in (TRUE, FALSE):
                self._place.setdefault(form, place)
                # Do not copy parts that the source writes in a longer form than necessary.
                if part.op == "not" or (has_constants and _has_constants(part)):
                    continue
                if self._size(part) <= self._size(self._done.get(form, form)):
                    self._done[form] = part
        self._last = len(parts)

    def formula(self, label: Formula) -> Formula:
        """Return a short formula in the style of the source that is equivalent to ``label`` on every infinite trace."""
        candidates = [self._in_source_style(label)]
        if self._source and label.op in ("and", "or"):
            self._factoring = self._factoring or Factoring(self._source.atoms())
            candidates += map(self._in_source_style, self._factoring.forms(label))
        distinct = list(dict.fromkeys(candidates))
        return min(distinct, key=lambda candidate: len(ascii_text(candidate))) if len(distinct) > 1 else distinct[0]

    def _in_source_style(self, label: Formula) -> Formula:
        plain = with_derived_operators(label, self._readable)
        for node in plain.bottom_up(known=self._done):
            ordered = node
            if node.op in ("and", "or"):
                ordered = rebuild(node, tuple(sorted(node.args, key=self._place_of)))
            as_written = self._done.get(ordered)
            self._done[node] = as_written or rebuild(ordered, tuple(self._done[argument] for argument in ordered.args))
        return self._done[plain]

    def _place_of(self, formula: Formula) -> int:
        """Return the position of a formula in the source; if it is not there, the first position of its operands.

        The position of a formula that has nothing in common with the source is after all others.
        """
        place = self._place.get(formula)
        if place is None:
            place = self._place[formula] = min(map(self._place_of, formula.args), default=self._last)
        return place

    def _size(self, formula: Formula) -> int:
        """Return the number of operators and atoms in the formula's text."""
        for node in formula.bottom_up(known=self._sizes):
            self._sizes[node] = 1 + sum(self._sizes[argument] for argument in node.args)
        return self._sizes[formula]


def _has_constants(formula: Formula) -> bool:
    """Whether a formula contains ``true`` or ``false``."""
    return not {TRUE, FALSE}.isdisjoint(formula.walk())
