"""Describe when an episode ends and how it is judged."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa


def ending(fspa: Fspa) -> str:
    """Return sentences that say when an episode ends and what counts as success.

    The rules are those of section 4 of ``docs/semantics.md``.
    """
    initial, verdicts = fspa.states[0].verdict, {state.verdict for state in fspa.states}
    if initial in ("satisfied", "violated"):
        return f"Every episode is a {'success' if initial == 'satisfied' else 'failure'}."
    can_break = "violated" in verdicts
    if fspa.judge == "goal":
        or_fails = ", and with failure as soon as it is broken for good" if can_break else ""
        too = ", too" if can_break else ""
        return (
            f"An episode ends with success as soon as the spec is met{or_fails}. "
            f"An episode that is over before the spec is met is a failure{too}."
        )
    until = "until the game ends it" if fspa.limit_steps is None else "to its limit"
    met = "it is in a state with 0 to go" if fspa.semantics == "infinite" else "the spec is met"
    early = [
        *(["with success as soon as nothing can break the spec any more"] if "satisfied" in verdicts else []),
        *(["with failure as soon as the spec is broken for good"] if can_break else []),
    ]
    sooner = f" It ends before that {', and '.join(early)}." if early else ""
    is_due = initial == "holding" and "pending" in verdicts
    due = " What is still due at the last step counts as missed: its verdict is `pending`." if is_due else ""
    return f"An episode goes on {until}, and is a success if {met} then.{sooner}{due}"


def limit_text(steps: int | None, seconds: float | None) -> str:
    """Return a sentence about the limit of an episode: ``The limit is 400 steps, 20 s.``

    ``steps`` is None if there is no limit. ``seconds`` is the limit as a time; it is None if the
    length of a step is unknown.
    """
    if steps is None:
        return "There is no limit."
    time = "" if seconds is None else f", {seconds:g} s"
    return f"The limit is {steps} step{'s' * (steps != 1)}{time}."
