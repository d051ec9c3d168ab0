"""How often a formula has begun in the last seconds: the registers of ``times_within(p, T)``."""

from __future__ import annotations

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.expression.tree import Before, Condition, Const, Expression, Op, When
from tltlc.resolve.context import Context
from tltlc.resolve.registers import RegisterDraft, saturated

MOST_BEGINNINGS = 100
"""The most beginnings that one count remembers: each takes a register."""


@record
class Window:
    """The window of ``times_within(p, T)``.

    ``text`` is p, and ``begins`` the condition that p begins at this sample. ``length`` is T in ``unit``,
    which is ``steps`` or ``s``, and ``step`` the length of a step in the same unit.
    """

    text: str
    begins: Condition
    length: float
    unit: str
    step: Expression

    def register(self, name: str, most: int, context: Context, source: SourceFile, span: Span) -> None:
        """Record the register of the count, which has this name, and the registers of the ages that it reads.

        ``most`` is the greatest count that matters. A register that counts further stays as it is.
        """
        known = context.registers.get(name)
        if known is not None and isinstance(known.update, When) and len(known.update.cases) >= most:
            return
        ages = [self._age(number) for number in range(1, most + 1)]
        for age in ages:
            context.register(age, source, span)
        # The ages grow with their numbers, so the oldest beginning inside the window says how many there are.
        cases = tuple((self._is_inside(age), Const(float(number))) for number, age in enumerate(ages, start=1))
        count = RegisterDraft(name, "times_within", "", 0.0, None, 0.0, When(cases[::-1], Const(0.0)))
        context.register(count, source, span, replaces=known)

    def _age(self, number: int) -> RegisterDraft:
        """Return the register with the time since the last beginning but ``number - 1``."""
        name = self._age_name(number)
        later: Expression = Const(0.0)
        if number > 1:
            later = Op("+", (Before(self._age_name(number - 1)), self.step))
        update = When(((self.begins, later),), Op("+", (Before(name), self.step)))
        return RegisterDraft(name, "begun", self.unit, 0.0, None, 0.0, update)

    def _age_name(self, number: int) -> str:
        return f"time since beginning {number} of {self.text}"

    def _is_inside(self, age: RegisterDraft) -> Condition:
        """Return the condition that an age is no longer than the window."""
        return Condition("<=", (saturated(age.name, self.length + 1.0), Const(self.length)))
