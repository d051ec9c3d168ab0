"""Describe how near failed episodes came to their next subgoals, and what remained to be done."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tltl_runtime.game.level import Level
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode, NearestMiss
from tltl_runtime.regression.explain.phrase import Phrase, phrase, things_phrase
from tltl_runtime.regression.explain.stages import Subgoal, near_enough
from tltl_runtime.support.number_text import number
from tltlc.api import Fspa, label_text


def approach_phrase(level: Level | None, fspa: Fspa, undone: Subgoal, episodes: Sequence[ExplainedEpisode]) -> Phrase:
    """Describe how near failed episodes came to the subgoal ``undone``.

    The first clause counts the episodes that had just reached the subgoal when another atom broke the
    spec. The second clause describes the nearest miss of the other episodes. It is left out unless
    such misses are known for more than half of all ``episodes``. Each clause begins with a semicolon.
    The text is empty if both are left out. ``level`` is None for recorded traces.
    """
    clauses = Phrase("")
    if arrived := sum(episode.arrived for episode in episodes):
        was = "was" if arrived == 1 else "were"
        position = f"{was} at {undone.place}" if undone.targets else "lacked nothing else"
        clauses = Phrase(f"; {arrived} of them {position} when it broke", undone.mentions)
    misses = [episode.nearest for episode in episodes if episode.nearest and not episode.arrived]
    if 2 * len(misses) <= len(episodes):
        return clauses
    return phrase(clauses, "; ", _limit_phrase(level, fspa, misses, " of the others" if arrived else ""))


def remaining_text(fspa: Fspa, episodes: Sequence[ExplainedEpisode]) -> str:
    """Return a clause with the state in which episodes failed most often, and what remained to be done there.

    For example, ``mostly in state 2, where this remained: reach near(exit)``.
    """
    ((state, count),) = Counter(episode.summary.unmet for episode in episodes).most_common(1)
    often = "" if count == len(episodes) else "mostly " if 2 * count > len(episodes) else "most often "
    return f"{often}in state {state}, where this remained: {label_text(fspa, state)}"


def _limit_phrase(level: Level | None, fspa: Fspa, misses: Sequence[NearestMiss], of: str) -> Phrase:
    """Describe the atom that limits ``misses`` most often, and the best of the misses that it limits.

    A miss says how near an episode came to its next subgoal. ``of`` is empty, or says which episodes
    are meant, for example `` of the others``. ``level`` is None for recorded traces.
    """
    (((atom, must_hold), count),) = Counter((miss.atom, miss.wanted) for miss in misses).most_common(1)
    same_limit = [miss for miss in misses if (miss.atom, miss.wanted) == (atom, must_hold)]
    often = "" if 2 * count > len(misses) else "most often "
    if not must_hold:
        return Phrase(f"{often}the limit is that `{atom}` holds")
    if level is None:
        return Phrase(_trace_limit_text(often, atom, max(miss.robustness for miss in same_limit)))
    if distances := [miss.distance for miss in same_limit if miss.distance is not None]:
        nearest, sufficient = _distance_texts(min(distances), _sufficient_distance(level, fspa, atom))
        target = same_limit[0].target
        assert target is not None, "a distance is the distance to a target"
        limit = f": {nearest} ({often}`{atom}` is the limit{sufficient})"
        return phrase(f"closest approach{of} to ", things_phrase([target]), limit)
    best = max(miss.robustness for miss in same_limit)
    # A Boolean atom that does not hold has robustness -1, which says nothing.
    return Phrase(f"{often}the limit is `{atom}`" + (f", {number(best, 2)} at best" if best > -1.0 else ""))


def _trace_limit_text(often: str, atom: str, best: float) -> str:
    """Say that ``atom`` kept traces from the next subgoal.

    ``best`` is the greatest value of the atom. It is left out if it is -1, as for a Boolean atom.
    ``often`` comes before the name: empty or ``most often`` and a space.
    """
    value = f", with {number(best, 2)} at best: it holds above 0" if best > -1.0 else ""
    return f"{often}`{atom}` was missing{value}"


def _sufficient_distance(level: Level, fspa: Fspa, name: str) -> float | None:
    """Return the distance in metres below which the atom ``name`` holds.

    None if there is no such atom, or if
    :func:`~tltl_runtime.regression.explain.stages.near_enough` gives no distance.
    """
    atoms = {atom.name: row for row, atom in enumerate(fspa.atoms)}
    return near_enough(fspa, atoms[name], level.game.params(level)) if name in atoms else None


def _distance_texts(least: float, limit: float | None) -> tuple[str, str]:
    """Return ``least`` as a text, and a clause about ``limit``: ``1.2 m`` and ``, below 1.0 m is enough``.

    Both are in metres. ``least`` is the least distance to a target, and ``limit`` the distance that
    would suffice. If ``limit`` is None, the clause is empty. Two decimals are shown if the distances
    differ only in the second.
    """
    if limit is None:
        return f"{least:.1f} m", ""
    for decimals in (1, 2):
        if (nearest := f"{least:.{decimals}f} m") != (sufficient := f"{limit:.{decimals}f} m"):
            return nearest, f", below {sufficient} is enough"
    return nearest, ", less is enough"
