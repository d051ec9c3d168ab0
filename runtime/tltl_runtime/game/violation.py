"""Find the atoms that broke a spec."""

from __future__ import annotations

from collections.abc import Callable

from tltl_runtime.game.episode import RecordedEpisode
from tltlc.api import Atom, monitors


def broken_atoms(
    episode: RecordedEpisode, preferred: Callable[[Atom], bool] = lambda atom: False
) -> list[tuple[str, bool]]:
    """Return the atoms that caused a violation, and for each whether it was true: ``[("alive", False)]``.

    ``episode`` must have ended by a violation. Its last transition has a guard. The atoms form a prime
    implicant of this guard that was true at the last step. If several implicants were true, take one
    with a ``preferred`` atom. The list is empty if none was true. An atom that says that a rule is broken
    is replaced by those that break it.
    """
    fspa, last_transition = episode.fspa, (int(episode.states[-2]), int(episode.states[-1]))
    holds = [value > 0.0 for value in episode.atoms[-1].tolist()]
    primes = [
        prime for edge in fspa.edges if (edge.source, edge.target) == last_transition for prime in edge.guard.primes
    ]
    true_primes = [prime for prime in primes if all(holds[atom] == expected for atom, expected in prime)]
    true_primes.sort(key=lambda prime: not any(preferred(fspa.atoms[atom]) for atom, _ in prime))
    broken = [atom for atom, _ in next(iter(true_primes), ())]
    reasons = monitors.deciding_atoms(fspa, broken, episode.atoms[-1].tolist())
    return [(fspa.atoms[atom].name, holds[atom]) for atom in reasons]
