"""The output of `tltlc mine --json`, in the form of ``mine.schema.json``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tltlc.automaton.text import formula_text
from tltlc.tools.mine.clause import count_atoms
from tltlc.tools.mine.confirm import Proposal
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.reasons import reasons
from tltlc.tools.mine.search import SpecSearch


def document(
    proposals: Sequence[Proposal], evidence: Evidence, search: SpecSearch, *, complete: bool
) -> dict[str, Any]:
    """Return the proposals and their figures as a JSON object.

    ``complete`` is true if the search was not stopped, and no limit left anything out.
    """
    return {
        "traces": len(evidence.traces),
        "counterexamples": len(evidence.counterexamples),
        "made_up": evidence.made_up,
        "complete": complete,
        "proposals": [
            {
                "rank": rank,
                "clauses": [clause.text for clause in proposal.clauses],
                "formula": str(proposal.fspa.formula),
                "english": formula_text(proposal.fspa),
                "score": proposal.figures.score(count_atoms(proposal.clauses)),
                "support": proposal.figures.support,
                "separation": proposal.figures.separation,
                "atoms": count_atoms(proposal.clauses),
                "reasons": list(reasons(proposal, evidence, search.bits)),
                "not_satisfied": [verdict.trace.name for verdict in proposal.traces if not verdict.accepted],
                "not_violated": [verdict.trace.name for verdict in proposal.counterexamples if verdict.accepted],
            }
            for rank, proposal in enumerate(proposals, start=1)
        ],
    }
