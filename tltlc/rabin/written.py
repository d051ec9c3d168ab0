"""What remains in a state, written as in the source: with its operators, and its operands in their order."""

from __future__ import annotations

from typing import Final

from tltlc.logic.formula import FALSE, TRUE, Formula, rebuild
from tltlc.rabin.infinite import infinite_form, readable

_MOST_PARTS: Final = 300
"""A specification with more is written as the construction has it: nobody reads its labels."""


class Writer:
    """Writes formulas of the construction's normal form in the words of ``source``: ``a -> F b`` for ``!a | F b``."""

    def __init__(self, source: Formula) -> None:
        self._place: dict[Formula, int] = {}
        self._done: dict[Formula, Formula] = {}
        parts = list(source.walk())
        for place, part in enumerate(parts if len(parts) <= _MOST_PARTS else ()):
            form = readable(infinite_form(part))
            if form not in (TRUE, FALSE):
                self._place.setdefault(form, place)
                # Parts that the source says in more words than need be are not taken from it.
                if part.op != "not" and _size(part) <= _size(self._done.get(form, form)):
                    self._done[form] = part
        self._last = len(parts)

    def formula(self, label: Formula) -> Formula:
        """The formula, equal on every infinite trace."""
        plain = readable(label)
        for node in plain.bottom_up(known=self._done):
            args = node.args
            if node.op in ("and", "or"):
                args = tuple(sorted(args, key=self._place_of))
            self._done[node] = rebuild(node, tuple(self._done[argument] for argument in args))
        return self._done[plain]

    def _place_of(self, formula: Formula) -> int:
        """Where in the source the formula first stands, or a part of it."""
        found = self._place.get(formula)
        if found is None:
            found = self._place[formula] = min(map(self._place_of, formula.args), default=self._last)
        return found


def _size(formula: Formula) -> int:
    """The operators and atoms in the formula as it is written."""
    sizes: dict[Formula, int] = {}
    for node in formula.bottom_up():
        sizes[node] = 1 + sum(sizes[argument] for argument in node.args)
    return sizes[formula]
