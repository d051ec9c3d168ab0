"""What failed episodes lacked: how near they came to what was to be done next, and what remained of the spec."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tltl_runtime.regression.explain.account import Account, Nearest
from tltl_runtime.regression.explain.stages import REACHES, near_enough
from tltl_runtime.stealth.capabilities.capabilities import given_params
from tltl_runtime.stealth.level import Level
from tltl_runtime.support.number_text import number
from tltlc.automaton.fspa import Fspa


def approach(level: Level, fspa: Fspa, undone: str, accounts: Sequence[Account]) -> str:
    """What most of the episodes lacked of what was to be done next, behind a semicolon; where they had come to it, and
    something else broke the spec then, that.
    """
    said = ""
    if arrived := sum(each.arrived for each in accounts):
        was = "was" if arrived == 1 else "were"
        there = f"{was} at {undone.removeprefix(REACHES)}" if undone.startswith(REACHES) else "lacked nothing else"
        said = f"; {arrived} of them {there} when it broke"
    near = [each.nearest for each in accounts if each.nearest and not each.arrived]
    if 2 * len(near) <= len(accounts):
        return said
    return f"{said}; {_limit(level, fspa, near, ' of the others' if arrived else '')}"


def remained(fspa: Fspa, accounts: Sequence[Account]) -> str:
    """In which state of the automaton most of the episodes failed, and what remained to be done there."""
    ((state, count),) = Counter(each.unmet for each in accounts).most_common(1)
    often = "" if count == len(accounts) else "mostly " if 2 * count > len(accounts) else "most often "
    return f"{often}in state {state}, where this remained: {fspa.states[state].label.english}"


def _limit(level: Level, fspa: Fspa, near: Sequence[Nearest], of: str) -> str:
    """What was the limit most often, and how near the episodes, which are ``of`` some, came then at best."""
    (((atom, wanted), count),) = Counter((each.atom, each.wanted) for each in near).most_common(1)
    limited = [each for each in near if (each.atom, each.wanted) == (atom, wanted)]
    often = "" if 2 * count > len(near) else "most often "
    if not wanted:
        return f"{often}the limit is that `{atom}` holds"
    if distances := [each.distance for each in limited if each.distance is not None]:
        came, enough = _metres(min(distances), _near_enough(level, fspa, atom))
        return f"closest approach{of} to `{limited[0].target}`: {came} ({often}`{atom}` is the limit{enough})"
    best = max(each.robustness for each in limited)
    # Of what is either true or false there is no better or worse.
    return f"{often}the limit is `{atom}`" + (f", {number(best, 2)} at best" if best > -1.0 else "")


def _near_enough(level: Level, fspa: Fspa, name: str) -> float | None:
    atoms = {atom.name: row for row, atom in enumerate(fspa.atoms)}
    return near_enough(fspa, atoms[name], given_params(level, fspa)) if name in atoms else None


def _metres(came: float, enough: float | None) -> tuple[str, str]:
    """How near the episodes came, and words on what would have done, told apart where they are nearly the same."""
    if enough is None:
        return f"{came:.1f} m", ""
    for places in (1, 2):
        if (there := f"{came:.{places}f} m") != (below := f"{enough:.{places}f} m"):
            return there, f", below {below} would do"
    return there, ", less would do"
