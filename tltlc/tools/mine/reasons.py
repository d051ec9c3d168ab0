"""Explain why a spec is proposed, in sentences that can be checked against the traces."""

from __future__ import annotations

from statistics import median_low

from tltlc.tools.mine.bits import Bits, count
from tltlc.tools.mine.clause import Conjunction, accepted_by
from tltlc.tools.mine.confirm import Proposal
from tltlc.tools.mine.evidence import Evidence


def reasons(proposal: Proposal, evidence: Evidence, bits: Bits) -> tuple[str, ...]:
    """Return the reasons as sentences.

    They say how many traces satisfy the proposal, how counterexamples violate it, and what each
    clause adds.
    """
    sentences = [_support(proposal)]
    if proposal.counterexamples:
        sentences.append(_separation(proposal, made_up=evidence.made_up))
    return (*sentences, *_shares(proposal.clauses, bits), *_unasked(proposal.clauses, bits))


def _support(proposal: Proposal) -> str:
    figures = proposal.figures
    if figures.traces == 1:
        return "the one trace satisfies it"
    if figures.accepted == figures.traces:
        return "both traces satisfy it" if figures.traces == 2 else f"all {figures.traces} traces satisfy it"
    unsatisfied = [judgement.trace.name for judgement in proposal.traces if not judgement.accepted]
    listed = ", ".join(unsatisfied[:3]) + (", …" if len(unsatisfied) > 3 else "")
    return f"{figures.accepted} of {figures.traces} traces satisfy it (not {listed})"


def _separation(proposal: Proposal, *, made_up: bool) -> str:
    figures = proposal.figures
    kind = "made-up counterexample" if made_up else "counterexample"
    at = [judgement.violated_at for judgement in proposal.counterexamples if judgement.violated_at is not None]
    short = figures.rejected - len(at)
    if figures.counterexamples == 1:
        return f"the one {kind} does not: it {f'breaks it at step {at[0]}' if at else 'ends before it is met'}"
    if figures.rejected == figures.counterexamples:
        summary = f"none of the {figures.counterexamples} {kind}s does"
    else:
        verb = "does" if figures.rejected == 1 else "do"
        summary = f"{figures.rejected} of {figures.counterexamples} {kind}s {verb} not"
    violations = []
    if at:
        one = "breaks" if len(at) == 1 else "break"
        place = f"at step {at[0]}" if min(at) == max(at) else f"at steps {min(at)} to {max(at)}"
        half = f", half of them by step {median_low(at)}" if len(at) > 2 and min(at) < max(at) else ""
        violations.append(f"{len(at)} {one} it {place}{half}")
    if short:
        violations.append(f"{short} end{'s' * (short == 1)} before it is met")
    return f"{summary}: {'; '.join(violations)}"


def _shares(clauses: Conjunction, bits: Bits) -> list[str]:
    """For several clauses, return how many counterexamples only one of them rejects."""
    if len(clauses) == 1:
        return []
    sentences = []
    for clause in clauses:
        accepted_by_rest = accepted_by((other for other in clauses if other is not clause), bits)
        alone = count(bits.counterexamples & accepted_by_rest & ~clause.accepts)
        sentences.append(f"`{clause.text}` alone rejects {alone} of them")
    return sentences


def _unasked(clauses: Conjunction, bits: Bits) -> list[str]:
    """Return the clauses that are vacuously satisfied in some traces."""
    total = count(bits.traces)
    unasked = [(clause.text, total - count(clause.asked & bits.traces)) for clause in clauses]
    return [f"`{text}`: in {number} of {total} traces nothing calls for it" for text, number in unasked if number]
