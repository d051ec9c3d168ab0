"""Build the automaton of a resolved spec over infinite traces (``docs/semantics.md``, "Infinite traces")."""

from __future__ import annotations

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.infinite.analysis import analysis_of_rabin
from tltlc.automaton.infinite.assembly import assemble
from tltlc.automaton.infinite.blowup import budget_error
from tltlc.automaton.infinite.construct import rabin
from tltlc.automaton.infinite.readback import NormalFormWriter
from tltlc.automaton.work import STEPS_PER_STATE, OutOfWork, Work
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Spec


def build_infinite(spec: Spec, *, state_budget: int = DEFAULT_STATE_BUDGET) -> Fspa:
    """Return the deterministic, complete Rabin automaton of a spec over infinite traces.

    A state is ``accepting`` if it lies on an accepted cycle; it is a trap if no accepting state can
    be reached from it. Raises :class:`~tltlc.diagnostics.diagnostic.TltlError`: TLT0501 if the
    construction takes more than ``state_budget`` times
    :data:`~tltlc.automaton.work.STEPS_PER_STATE` steps, or if formulas become too large; TLT0502 if
    there are too many edges or prime implicants.
    """
    with recursion_room():
        try:
            return _build(spec, STEPS_PER_STATE * state_budget)
        except (OutOfWork, OutOfSteps, TooManyPrimes, RecursionError) as reason:
            raise budget_error(spec, reason) from None


def _build(spec: Spec, work: int) -> Fspa:
    names = [atom.name for atom in spec.atoms]
    automaton = rabin(spec.formula, names, spec.exclusive, work)
    analysis = analysis_of_rabin(automaton, Work(work))
    writer = NormalFormWriter(spec.formula)

    def label(state: int) -> Formula:
        return writer.formula(automaton.labels[state]) if state else spec.formula

    parts = assemble(automaton, analysis, names, spec.exclusive, label)
    return Fspa(
        name=spec.name,
        doc=spec.doc,
        formula=spec.formula,
        level=spec.level,
        limit_steps=spec.limit_steps,
        judge=spec.judge or analysis.default_judge(),
        semantics=spec.semantics,
        tags=spec.tags,
        clock_s=spec.clock_s,
        clock_varies=spec.clock_varies,
        registers=spec.registers,
        signals=spec.signals,
        params=spec.params,
        atoms=spec.atoms,
        exclusive=spec.exclusive,
        states=parts.states,
        edges=parts.edges,
        spec_size=parts.spec_size,
        acceptance=parts.acceptance,
    )
