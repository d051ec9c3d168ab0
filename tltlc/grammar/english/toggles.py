"""What rules mean that count how often a bool changes: `a changes at most 4 times in any 5 s`."""

from __future__ import annotations

from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, Rules
from tltlc.grammar.english.terminals import Term


class Toggles(Rules):
    """The meanings of the rules that count the beginnings and ends of a bool together."""

    def toggles(self, term: Term, sign: str, number: str | Term, *time: Duration) -> Reading | None:
        """Return the rule that a bool changes at most so often, in any time or in all.

        `begins a or ends a` holds at both of two steps in a row with a change, and would count them once.
        """
        text = number if isinstance(number, str) else number.text
        if not text.isdecimal() or sign not in ("<=", "<"):
            return None
        most = int(text) - (sign == "<")
        if most < 1:
            return None
        counts = [f"({edge} {term.text}, " for edge in ("begins", "ends")]
        calls = [f"times_within{call}{time[0].text}, " if time else f"times{call}" for call in counts]
        return Reading((f"keep {' + '.join(f'{call}{most + 1})' for call in calls)} <= {most}",))

    def toggles_first(self, sign: str, number: Term, term: Term, *time: Duration) -> Reading | None:
        return self.toggles(term, sign, number, *time)

    def avoid_toggles(self, term: Term, sign: str, number: str | Term, *time: Duration) -> Reading | None:
        opposite = {">": "<=", ">=": "<"}.get(sign)
        return None if opposite is None else self.toggles(term, opposite, number, *time)

    def avoid_toggles_first(self, sign: str, number: Term, term: Term, *time: Duration) -> Reading | None:
        return self.avoid_toggles(term, sign, number, *time)
