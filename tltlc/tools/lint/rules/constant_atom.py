"""TLT0416: an atom that always holds or never holds, whatever the values of the signals."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.tools.lint.atom_signs import can_be, is_always
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield one finding for each atom that always holds or never holds."""
    checked: set[str] = set()
    for spec in view.specs:
        for atom in spec.fspa.atoms:
            if atom.name in checked:
                continue
            checked.add(atom.name)
            if not can_be("positive", atom, spec.fspa) and is_always("not positive", atom, spec.fspa):
                label = spec.atom_label(atom.name, "its value is 0 or less for all values of the signals")
                help_ = "an atom holds where its value is above 0: check the sign, the range and the units"
                yield RuleFinding(f"`{atom.name}` never holds", (label,), help_)
            elif not can_be("not positive", atom, spec.fspa) and is_always("positive", atom, spec.fspa):
                label = spec.atom_label(atom.name, "its value is above 0 for all values of the signals")
                help_ = "an atom fails where its value is 0 or less: check the sign, the range and the units"
                yield RuleFinding(f"`{atom.name}` always holds", (label,), help_)


RULE = LintRule("TLT0416", "error", check)
