"""Why a spec is proposed, in words that can be checked against the traces."""

from __future__ import annotations

from statistics import median_low

from tltlc.tools.mine.bits import Bits, count
from tltlc.tools.mine.clause import Conjunction, accepted_by
from tltlc.tools.mine.confirm import Proposal
from tltlc.tools.mine.evidence import Evidence


def reasons(proposal: Proposal, evidence: Evidence, bits: Bits) -> tuple[str, ...]:
    """Sentences: how many traces satisfy it, how counterexamples break it, and what each clause adds."""
    found = [_support(proposal)]
    if proposal.counterexamples:
        found.append(_separation(proposal, made_up=evidence.made_up))
    return (*found, *_shares(proposal.clauses, bits), *_unasked(proposal.clauses, bits))


def _support(proposal: Proposal) -> str:
    figures = proposal.figures
    if figures.traces == 1:
        return "the one trace satisfies it"
    if figures.accepted == figures.traces:
        return "both traces satisfy it" if figures.traces == 2 else f"all {figures.traces} traces satisfy it"
    others = [each.trace.name for each in proposal.traces if not each.accepted]
    listed = ", ".join(others[:3]) + (", …" if len(others) > 3 else "")
    return f"{figures.accepted} of {figures.traces} traces satisfy it (not {listed})"


def _separation(proposal: Proposal, *, made_up: bool) -> str:
    figures = proposal.figures
    kind = "made-up counterexample" if made_up else "counterexample"
    at = [each.violated_at for each in proposal.counterexamples if each.violated_at is not None]
    short = figures.rejected - len(at)
    if figures.counterexamples == 1:
        return f"the one {kind} does not: it {f'breaks it at step {at[0]}' if at else 'ends before it is met'}"
    if figures.rejected == figures.counterexamples:
        whole = f"none of the {figures.counterexamples} {kind}s does"
    else:
        verb = "does" if figures.rejected == 1 else "do"
        whole = f"{figures.rejected} of {figures.counterexamples} {kind}s {verb} not"
    ways = []
    if at:
        one = "breaks" if len(at) == 1 else "break"
        place = f"at step {at[0]}" if min(at) == max(at) else f"at steps {min(at)} to {max(at)}"
        half = f", half of them by step {median_low(at)}" if len(at) > 2 and min(at) < max(at) else ""
        ways.append(f"{len(at)} {one} it {place}{half}")
    if short:
        ways.append(f"{short} end{'s' * (short == 1)} before it is met")
    return f"{whole}: {'; '.join(ways)}"


def _shares(clauses: Conjunction, bits: Bits) -> list[str]:
    """Of several clauses the counterexamples that only one rejects."""
    if len(clauses) == 1:
        return []
    found = []
    for each in clauses:
        others = accepted_by((other for other in clauses if other is not each), bits)
        alone = count(bits.counterexamples & others & ~each.accepts)
        found.append(f"`{each.text}` alone rejects {alone} of them")
    return found


def _unasked(clauses: Conjunction, bits: Bits) -> list[str]:
    """Clauses that are met in some traces only because nothing asks for them."""
    every = count(bits.traces)
    unasked = [(each.text, every - count(each.asked & bits.traces)) for each in clauses]
    return [f"`{text}`: in {number} of {every} traces nothing calls for it" for text, number in unasked if number]
