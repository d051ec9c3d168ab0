"""What rules about differences mean: by how much a number changes in each period of a kind."""

from __future__ import annotations

from tltlc.core.record import record, replace
from tltlc.grammar.english.answers import is_negative
from tltlc.grammar.english.intervals import Intervals
from tltlc.grammar.english.quantities import MIRRORED, Change, Number, begun, changed_value, comparison
from tltlc.grammar.english.rules import Reading
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State

_Found = Reading | list[Reading] | None


@record
class Period:
    """Where each period of a kind begins, and what holds in it; nothing that is known for `in each wave`."""

    event: State
    state: State | None = None


@record
class Difference:
    """By how much a number changes: ``hp falls by at most 20``. The sign is empty for ``falls by 20``."""

    term: Term
    change: Change
    sign: str
    step: Number


class Differences(Intervals):
    """The meanings of the rules about periods and about how much a number changes in them."""

    # Periods.

    def stretch_of(self, state: State) -> Period | None:
        """Return the period of a condition: it begins where the condition does."""
        if state.level > ATOM or is_negative(state):
            return None
        return Period(begun(state), None if begun(state) == state else state)

    def number_period(self, term: Term) -> Period | None:
        """Return the period of a number such as `wave`: one for each of its values."""
        state = self.changes(term, "varies") if term.kind == "INT" and term.declared is not None else None
        return None if state is None else Period(state)

    def enum_period(self, name: Term) -> Period | None:
        state = self.enum_varies(name)
        return None if state is None else Period(state)

    # By how much a number changes.

    def difference_of(self, term: Term, change: Change, *rest: str | Number) -> Difference | None:
        step = rest[-1]
        assert isinstance(step, Number)
        return Difference(term, change, rest[0] if isinstance(rest[0], str) else "", step)

    def difference_lost(self, term: Term, sign: str, step: Number) -> Difference | None:
        return self.difference_of(term, "falls", sign, step)

    def difference_gained(self, term: Term, sign: str, step: Number) -> Difference | None:
        return self.difference_of(term, "rises", sign, step)

    def lost(self, *parts: str | Number | Term) -> Difference | None:
        *sign, step, term = parts
        assert isinstance(term, Term) and isinstance(step, Number)
        return self.difference_of(term, "falls", *(part for part in sign if isinstance(part, str)), step)

    def gained(self, *parts: str | Number | Term) -> Difference | None:
        loss = self.lost(*parts)
        return None if loss is None else replace(loss, change="rises")

    def change_in(self, difference: Difference, period: Period) -> _Found:
        """Return the rule of `hp falls by at most 20 in each fight`, or of `gain at least 100 score per wave`."""
        value = self.value_at_last(difference.term, period.event)
        if value is None or difference.change not in ("falls", "rises") or not difference.sign:
            return None
        if difference.sign in ("<", "<="):
            rule = changed(difference, value)
            if rule is None:
                return None
            inside = "" if period.state is None else f"{period.state.at(OR)} implies "
            return Reading((f"keep {inside}{rule.text}",))
        if period.state is not None:
            rule = changed(difference, value)
            return None if rule is None else Reading((f"keep ends {period.state.at(ATOM)} implies {rule.text}",))
        rule = changed(difference, Number(f"previous({value.text})", value.term))
        return None if rule is None else Reading((f"keep {period.event.at(OR)} implies {rule.text}",))

    def change_while(self, difference: Difference, period: Period) -> _Found:
        """Return the readings of `hull falls by at most 15 during a storm`: since it began, or at each step.

        A hit lasts for one step, so `lose at most 15 hull per hit` is about the step before it.
        """
        whole = self.change_in(difference, period)
        if not isinstance(whole, Reading) or period.state is None:
            return whole
        step = changed(difference, Number(f"previous({difference.term.text})", difference.term))
        assert step is not None
        return [
            replace(whole, condition=f"if it counts from where `{period.state.text}` began"),
            Reading((f"keep {period.state.at(OR)} implies {step.text}",), f"for each step with `{period.state.text}`"),
        ]

    def while_change(self, period: Period, difference: Difference) -> _Found:
        return self.change_while(difference, period)

    def in_each_change(self, period: Period, difference: Difference) -> _Found:
        return self.change_while(difference, period)

    def avoid_change_in(self, difference: Difference, period: Period) -> _Found:
        sign = {">": "<=", ">=": "<", "": "<"}.get(difference.sign)
        return None if sign is None else self.change_while(replace(difference, sign=sign), period)

    def must_not_change_in(self, term: Term, change: Change, sign: str, step: Number, period: Period) -> _Found:
        return self.avoid_change_in(Difference(term, change, sign, step), period)

    def must_not_change_while(self, term: Term, change: Change, sign: str, step: Number, period: Period) -> _Found:
        opposite = {">": "<=", ">=": "<"}.get(sign)
        return None if opposite is None else self.change_while(Difference(term, change, opposite, step), period)

    def change_since(self, difference: Difference, event: State) -> _Found:
        value = self.value_at_last(difference.term, event)
        rule = None if value is None else changed(difference, value)
        if rule is None or not difference.sign:
            return None
        return Reading((f"{'keep' if difference.sign in ('<', '<=') else 'reach'} {rule.text}",))


def changed(difference: Difference, before: Number) -> State | None:
    """Return that a number has changed by so much since it had a value."""
    sign = MIRRORED[difference.sign] if difference.change == "falls" else difference.sign
    value = changed_value(difference.term, before.text, difference.change, difference.step)
    then = Number(value, difference.term)
    return comparison(Number(difference.term.text, difference.term), sign, then)
