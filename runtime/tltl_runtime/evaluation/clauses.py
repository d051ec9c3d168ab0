"""The clauses of a spec, by which evaluations and trainings say why episodes fail."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.spec.task import read_spec
from tltlc.api import Fspa, Spec, TltlError, record, replace, traces

_STATE_BUDGET: Final = 2_000
"""The automaton of a clause may have at most this many states: larger ones would delay the first episode."""


@record
class ClauseJudge:
    """What is needed to judge episodes by the clauses of a spec.

    ``fspa`` is the automaton of the spec, in which params have the values of the episodes. ``clauses`` are
    the clauses of the spec, as its source text has them if that is known.
    """

    fspa: Fspa
    clauses: traces.Clauses

    def broken(self, atoms: Mapping[str, float]) -> tuple[str, ...]:
        """Return the clauses that the last sample of an episode broke, where this sample alone shows it.

        It does so for clauses that ask the same of every sample, such as ``avoid fell``. ``atoms`` maps
        names of atoms to their values at the sample.
        """
        return tuple(part.text for part in self.clauses.parts if _breaks_alone(part.fspa, atoms))

    def judge(self) -> traces.Judge:
        """Return an object that judges the samples of whole episodes."""
        return traces.Judge(self.fspa, self.clauses, episodes=True)


def clause_judge(fspa: Fspa, params: Mapping[str, float], source: str | None) -> ClauseJudge:
    """Return what is needed to judge episodes by the clauses of a spec.

    ``params`` are values of the spec's params, in SI units. ``source`` is the argument of
    :func:`~tltl_runtime.spec.task.read_spec` for the text that ``fspa`` may have been compiled from. If it
    is None, has an error or is now another spec, the clauses are named in words, from the formula.
    """
    spec = None if source is None else _source_spec(fspa, source)
    values = tuple(replace(param, value=params.get(param.name, param.value)) for param in fspa.params)
    judged = replace(fspa, params=values)
    return ClauseJudge(judged, traces.clauses_of(judged, spec and replace(spec, params=values), _STATE_BUDGET))


def _breaks_alone(clause: Fspa, atoms: Mapping[str, float]) -> bool:
    """Whether a sample breaks a clause that asks the same of every sample, whatever came before it."""
    verdicts = [state.verdict for state in clause.states]
    if verdicts.count("violated") != 1 or len(verdicts) != 2 or verdicts[0] == "violated":
        return False
    holds = [atoms.get(atom.name, 0.0) > 0.0 for atom in clause.atoms]
    breaking = (edge for edge in clause.edges_from(0) if clause.states[edge.target].verdict == "violated")
    return any(all(holds[atom] == truth for atom, truth in prime) for edge in breaking for prime in edge.guard.primes)


def _source_spec(fspa: Fspa, source: str) -> Spec | None:
    try:
        compiled, spec = read_spec(source)
    except TltlError:
        return None
    return spec if spec_hash(compiled) == spec_hash(fspa) else None
