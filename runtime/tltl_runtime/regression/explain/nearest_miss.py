"""Describe by how much failed episodes broke the spec, and how near they came to their next subgoals."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Final

from tltl_runtime.game.level import Level
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode, NearestMiss
from tltl_runtime.regression.explain.phrase import Phrase, phrase, things_phrase
from tltl_runtime.regression.explain.stages import Subgoal, near_enough
from tltl_runtime.support.number_text import number, quantity_text
from tltlc.api import Fspa

_LEAST_GAP: Final = 5e-7
"""Smaller differences are not told as numbers: six decimals do not show them."""


def approach_phrase(level: Level | None, fspa: Fspa, undone: Subgoal, episodes: Sequence[ExplainedEpisode]) -> Phrase:
    """Describe by how much failed episodes broke the spec, and how near they came to the subgoal ``undone``.

    The first clause says by how much and when they broke the spec, if they did. The second clause counts
    the episodes that had just reached the subgoal when another atom broke the
    spec. The third clause describes the nearest miss of the other episodes. It is left out unless
    such misses are known for more than half of all ``episodes``. Each clause begins with a semicolon.
    The text is empty if both are left out. ``level`` is None for recorded traces.
    """
    clauses = _breach_phrase(episodes)
    if arrived := sum(episode.arrived for episode in episodes):
        was = "was" if arrived == 1 else "were"
        position = f"{was} at {undone.place}" if undone.targets else "lacked nothing else"
        clauses = phrase(clauses, Phrase(f"; {arrived} of them {position} when it broke", undone.mentions))
    misses = [episode.nearest for episode in episodes if episode.nearest and not episode.arrived]
    if 2 * len(misses) <= len(episodes):
        return clauses
    return phrase(clauses, "; ", _limit_phrase(level, fspa, misses, " of the others" if arrived else ""))


def _breach_phrase(episodes: Sequence[ExplainedEpisode]) -> Phrase:
    """Say how far and when episodes broke the spec: ``; `abs(spin)` reached 14.1 at worst, at 2.1 s to 5 s``.

    If they broke comparisons of several quantities, such as two of one clause, it is about the most frequent
    one. Empty if they did not break it, or if nothing about it is known.
    """
    quantities = Counter(episode.measured.quantity for episode in episodes if episode.measured is not None)
    for quantity, _ in quantities.most_common(1):
        episodes = [episode for episode in episodes if episode.measured and episode.measured.quantity == quantity]
    measured = [episode.measured for episode in episodes if episode.measured is not None]
    times = [episode.seconds for episode in episodes if episode.seconds is not None]
    if not times and not measured:
        return Phrase("")
    text = "; broken"
    if measured:
        worst = max(measured, key=lambda measure: measure.gap)
        value = worst.gap if worst.value is None else worst.value
        reached = "was off by" if worst.value is None else "reached"
        text = f"; `{worst.quantity}` {reached} {quantity_text(value, worst.unit, worst.gap)}"
        text += " at worst" * (len(measured) > 1) + "," * (len(measured) > 1 and bool(times))
    return Phrase(text + _times_text(times))


def _times_text(times: Sequence[float]) -> str:
    """Return a clause with the range of some times in seconds: `` at 3.2 s`` or `` at 2.1 s to 5.0 s``."""
    if not times:
        return ""
    first, last = (f"{time:.{_decimals(time)}f} s" for time in (min(times), max(times)))
    return f" at {first}" if first == last else f" at {first} to {last}"


def _limit_phrase(level: Level | None, fspa: Fspa, misses: Sequence[NearestMiss], of: str) -> Phrase:
    """Describe the atom that limits ``misses`` most often, and the best of the misses that it limits.

    A miss says how near an episode came to its next subgoal. ``of`` is empty, or says which episodes
    are meant, for example `` of the others``. ``level`` is None for recorded traces.
    """
    (((atom, must_hold), count),) = Counter((miss.atom, miss.wanted) for miss in misses).most_common(1)
    same_limit = [miss for miss in misses if (miss.atom, miss.wanted) == (atom, must_hold)]
    often = "" if 2 * count > len(misses) else "most often, "
    distances = [miss.distance for miss in same_limit if miss.distance is not None]
    if level is None or not distances:
        return Phrase(often + _miss_text(fspa, same_limit))
    nearest, sufficient = _distance_texts(min(distances), _sufficient_distance(level, fspa, atom))
    target = same_limit[0].target
    assert target is not None, "a distance is the distance to a target"
    return phrase(f"{often}closest approach{of} to ", things_phrase([target]), f": {nearest} (`{atom}`{sufficient})")


def _miss_text(fspa: Fspa, misses: Sequence[NearestMiss]) -> str:
    """Say by how much episodes missed an atom at best: ```x >= 7` was missed by 0.5 m at best``.

    All of ``misses`` have the same atom, and the same truth value that it had to have.
    """
    atom, wanted = misses[0].atom, misses[0].wanted
    opposite = next((known.opposite for known in fspa.atoms if known.name == atom), None)
    if any(miss.reached for miss in misses):
        state = f"`{atom}` was false" if not wanted and opposite is None else f"`{atom if wanted else opposite}` held"
        return f"{state} at times, but not together with the rest"
    if measured := [miss.missed for miss in misses if miss.missed is not None]:
        least = min(measured, key=lambda measure: measure.gap)
        gap = quantity_text(least.gap, least.unit, least.gap)
        by = f"missed by {gap} at best" if least.gap >= _LEAST_GAP else "just missed"
        return f"`{atom if wanted else opposite}` was {by}"
    if not wanted:
        return f"`{atom}` still held" if opposite is None else f"`{opposite}` was not reached"
    best = max(miss.robustness for miss in misses)
    # A Boolean atom that does not hold has robustness -1, which says nothing.
    return f"`{atom}` was not reached" + (f" ({number(best, 2)} at best, it holds above 0)" if best > -1.0 else "")


def _decimals(value: float) -> int:
    """Return the decimals of a time or a distance: one, or none if it has three digits before the point."""
    return 1 if value < 100.0 else 0


def _sufficient_distance(level: Level, fspa: Fspa, name: str) -> float | None:
    """Return the distance in metres below which the atom ``name`` holds.

    None if there is no such atom, or if
    :func:`~tltl_runtime.regression.explain.stages.near_enough` gives no distance.
    """
    atoms = {atom.name: row for row, atom in enumerate(fspa.atoms)}
    return near_enough(fspa, atoms[name], level.game.params(level)) if name in atoms else None


def _distance_texts(least: float, limit: float | None) -> tuple[str, str]:
    """Return ``least`` as a text, and a clause about ``limit``: ``1.2 m`` and `` holds below 1.0 m``.

    Both are in metres. ``least`` is the least distance to a target, and ``limit`` the distance that
    would suffice. If ``limit`` is None, the clause does not name it. Up to two decimals are shown if the
    distances differ only there.
    """
    if limit is None:
        return f"{least:.{_decimals(least)}f} m", " was not reached"
    for decimals in range(_decimals(least), 3):
        if (nearest := f"{least:.{decimals}f} m") != (sufficient := f"{limit:.{decimals}f} m"):
            return nearest, f" holds below {sufficient}"
    return nearest, " holds below that"
