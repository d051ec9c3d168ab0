"""Describe the nearest misses of failed episodes, and what remained to be done."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tltl_runtime.game.level import Level
from tltl_runtime.game.registry import registered_game
from tltl_runtime.regression.explain.account import Account, NearestMiss
from tltl_runtime.regression.explain.stages import Subgoal, near_enough
from tltl_runtime.support.number_text import number
from tltlc.api import Fspa, label_text


def approach(level: Level, fspa: Fspa, undone: Subgoal, accounts: Sequence[Account]) -> str:
    """Describe how near most of the episodes came to the next stage, starting with a semicolon.

    Episodes that had reached it when something else broke the spec are counted first.
    """
    text = ""
    if arrived := sum(account.arrived for account in accounts):
        was = "was" if arrived == 1 else "were"
        position = f"{was} at {undone.place}" if undone.place else "lacked nothing else"
        text = f"; {arrived} of them {position} when it broke"
    misses = [account.nearest for account in accounts if account.nearest and not account.arrived]
    if 2 * len(misses) <= len(accounts):
        return text
    return f"{text}; {_limit(level, fspa, misses, ' of the others' if arrived else '')}"


def remained(fspa: Fspa, accounts: Sequence[Account]) -> str:
    """Describe the state in which most of the episodes failed, and what remained to be done there."""
    ((state, count),) = Counter(account.summary.unmet for account in accounts).most_common(1)
    often = "" if count == len(accounts) else "mostly " if 2 * count > len(accounts) else "most often "
    return f"{often}in state {state}, where this remained: {label_text(fspa, state)}"


def _limit(level: Level, fspa: Fspa, near: Sequence[NearestMiss], of: str) -> str:
    """Describe the most frequent limiting atom and the nearest miss; ``of`` says which episodes are meant."""
    (((atom, wanted), count),) = Counter((miss.atom, miss.wanted) for miss in near).most_common(1)
    limited = [miss for miss in near if (miss.atom, miss.wanted) == (atom, wanted)]
    often = "" if 2 * count > len(near) else "most often "
    if not wanted:
        return f"{often}the limit is that `{atom}` holds"
    if distances := [miss.distance for miss in limited if miss.distance is not None]:
        came, enough = _metres(min(distances), _near_enough(level, fspa, atom))
        return f"closest approach{of} to `{limited[0].target}`: {came} ({often}`{atom}` is the limit{enough})"
    best = max(miss.robustness for miss in limited)
    # Atoms that are only true or false have robustness 1 or -1, which says nothing.
    return f"{often}the limit is `{atom}`" + (f", {number(best, 2)} at best" if best > -1.0 else "")


def _near_enough(level: Level, fspa: Fspa, name: str) -> float | None:
    atoms = {atom.name: row for row, atom in enumerate(fspa.atoms)}
    return near_enough(fspa, atoms[name], registered_game().params(level)) if name in atoms else None


def _metres(came: float, enough: float | None) -> tuple[str, str]:
    """Format the nearest distance and the sufficient distance, with enough decimals to tell them apart."""
    if enough is None:
        return f"{came:.1f} m", ""
    for places in (1, 2):
        if (nearest := f"{came:.{places}f} m") != (sufficient := f"{enough:.{places}f} m"):
            return nearest, f", below {sufficient} would do"
    return nearest, ", less would do"
