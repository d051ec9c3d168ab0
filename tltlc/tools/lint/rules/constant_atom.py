"""TLT0416: an atom that always holds or never holds, whatever the values of the signals."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.tools.lint.atom_signs import can_be, is_always
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.next_values import compared_next
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
                yield _finding(atom.name, spec, holds=False)
            elif not can_be("not positive", atom, spec.fspa) and is_always("positive", atom, spec.fspa):
                yield _finding(atom.name, spec, holds=True)


def _finding(name: str, spec: SpecView, *, holds: bool) -> RuleFinding:
    """Return the finding for an atom that always holds if ``holds``, or never."""
    message = f"its value is {'above 0' if holds else '0 or less'} for all values of the signals"
    fact = "fails where its value is 0 or less" if holds else "holds where its value is above 0"
    label, help_ = spec.atom_label(name, message), f"an atom {fact}: check the sign, the range and the units"
    compared = compared_next(name, spec)
    if compared is not None:
        operator, help_ = compared
        label = Label(operator.source, operator.tree.span, message)
    return RuleFinding(f"`{name}` {'always' if holds else 'never'} holds", (label,), help_)


RULE = LintRule("TLT0416", "error", check, supersedes=("TLT0449",))
