"""The output of `tltlc mine --json`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tltlc.automaton.text import formula_text
from tltlc.tools.mine.clause import atoms_of
from tltlc.tools.mine.confirm import Proposal
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.reasons import reasons
from tltlc.tools.mine.search import SpecSearch


def document(proposals: Sequence[Proposal], evidence: Evidence, search: SpecSearch, *, whole: bool) -> dict[str, Any]:
    """Return the proposals with their figures.

    ``whole``: the search came to its end, and no limit left anything out.
    """
    return {
        "traces": len(evidence.traces),
        "counterexamples": len(evidence.counterexamples),
        "made_up": evidence.made_up,
        "complete": whole,
        "proposals": [
            {
                "rank": rank,
                "clauses": [clause.text for clause in proposal.clauses],
                "formula": str(proposal.fspa.formula),
                "english": formula_text(proposal.fspa),
                "score": proposal.figures.score(atoms_of(proposal.clauses)),
                "support": proposal.figures.support,
                "separation": proposal.figures.separation,
                "atoms": atoms_of(proposal.clauses),
                "reasons": list(reasons(proposal, evidence, search.bits)),
                "not_satisfied": [judged.trace.name for judged in proposal.traces if not judged.accepted],
                "not_violated": [judged.trace.name for judged in proposal.counterexamples if judged.accepted],
            }
            for rank, proposal in enumerate(proposals, start=1)
        ],
    }
