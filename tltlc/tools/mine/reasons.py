"""Explain why a spec is proposed, in sentences that you can check against the traces."""

from __future__ import annotations

from statistics import median_low

from tltlc.tools.mine.bits import Bits, count
from tltlc.tools.mine.clause import Conjunction, accepted_traces
from tltlc.tools.mine.confirm import Proposal
from tltlc.tools.mine.evidence import Evidence


def reasons(proposal: Proposal, evidence: Evidence, bits: Bits) -> tuple[str, ...]:
    """Return sentences that give the reasons for a proposal: ``both traces satisfy it``.

    They say how many traces satisfy the proposal, how counterexamples violate it, what each clause
    adds, and in how many traces a clause holds only because nothing triggers it.
    """
    sentences = [_support(proposal)]
    if proposal.counterexamples:
        sentences.append(_separation(proposal, made_up=evidence.made_up))
    return (*sentences, *_additions(proposal.clauses, bits), *_vacuous_clauses(proposal.clauses, bits))


def _support(proposal: Proposal) -> str:
    figures = proposal.figures
    if figures.traces == 1:
        return "the one trace satisfies it"
    if figures.accepted == figures.traces:
        return "both traces satisfy it" if figures.traces == 2 else f"all {figures.traces} traces satisfy it"
    unsatisfied = [judgement.trace.name for judgement in proposal.traces if not judgement.accepted]
    names = ", ".join(unsatisfied[:3]) + (", …" if len(unsatisfied) > 3 else "")
    return f"{figures.accepted} of {figures.traces} traces satisfy it (not {names})"


def _separation(proposal: Proposal, *, made_up: bool) -> str:
    figures = proposal.figures
    kind = "made-up counterexample" if made_up else "counterexample"
    steps = [judgement.violated_at for judgement in proposal.counterexamples if judgement.violated_at is not None]
    short = figures.rejected - len(steps)
    if figures.counterexamples == 1:
        return f"the one {kind} does not: it {f'breaks it at step {steps[0]}' if steps else 'ends before it is met'}"
    if figures.rejected == figures.counterexamples:
        summary = f"none of the {figures.counterexamples} {kind}s does"
    else:
        verb = "does" if figures.rejected == 1 else "do"
        summary = f"{figures.rejected} of {figures.counterexamples} {kind}s {verb} not"
    violations = []
    if steps:
        verb = "breaks" if len(steps) == 1 else "break"
        place = f"at step {steps[0]}" if min(steps) == max(steps) else f"at steps {min(steps)} to {max(steps)}"
        half = f", half of them by step {median_low(steps)}" if len(steps) > 2 and min(steps) < max(steps) else ""
        violations.append(f"{len(steps)} {verb} it {place}{half}")
    if short:
        violations.append(f"{short} end{'s' * (short == 1)} before it is met")
    return f"{summary}: {'; '.join(violations)}"


def _additions(clauses: Conjunction, bits: Bits) -> list[str]:
    """Return a sentence for each clause that says how many counterexamples no other clause rejects.

    The list is empty if the spec has only one clause.
    """
    if len(clauses) == 1:
        return []
    sentences = []
    for clause in clauses:
        accepted_by_rest = accepted_traces((candidate for candidate in clauses if candidate is not clause), bits)
        alone = count(bits.counterexamples & accepted_by_rest & ~clause.accepts)
        sentences.append(f"`{clause.text}` alone rejects {alone} of them")
    return sentences


def _vacuous_clauses(clauses: Conjunction, bits: Bits) -> list[str]:
    """Return a sentence for each clause that some traces satisfy only because nothing triggers it."""
    total = count(bits.traces)
    vacuous = [(clause.text, count(bits.traces & clause.accepts & ~clause.not_vacuous)) for clause in clauses]
    return [f"`{text}`: in {number} of {total} traces nothing triggers it" for text, number in vacuous if number]
