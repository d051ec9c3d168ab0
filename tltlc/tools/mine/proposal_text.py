"""Print proposals as text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import fill
from typing import Final

from tltlc.automaton.text import formula_text
from tltlc.tools.mine.bits import Bits
from tltlc.tools.mine.clause import count_atoms
from tltlc.tools.mine.confirm import Proposal
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.reasons import reasons
from tltlc.tools.mine.score import PRICE

_WIDTH: Final = 100
_INDENT: Final = " " * 5
_MEASURE: Final = (
    f"The score is support + separation - 1, less {PRICE:g} for each atom. Support is the share of the traces that "
    "satisfy a proposal; separation is the share of the counterexamples that do not."
)


def proposals_text(proposals: Sequence[Proposal], evidence: Evidence, bits: Bits) -> str:
    """Describe the proposals in words, the best first.

    The text has the rank, the score, the clauses, an English sentence and the reasons for each
    proposal, and ends with an explanation of the score. Lines are at most 100 columns wide, except
    for clauses.
    """
    parts = ["\n".join(_proposal(rank, proposal, evidence, bits)) for rank, proposal in enumerate(proposals, start=1)]
    if evidence.made_up:
        parts.append(
            "No counterexamples were given, so made-up ones are used: traces that are cut short, reordered, slower, "
            "or broken."
        )
    parts.append(fill(_MEASURE, _WIDTH))
    return "\n\n".join(parts)


def _proposal(rank: int, proposal: Proposal, evidence: Evidence, bits: Bits) -> Iterator[str]:
    figures = proposal.figures
    score = figures.score(count_atoms(proposal.clauses))
    yield f"{rank:3}  score {score:.2f}  support {figures.support:.2f}  separation {figures.separation:.2f}"
    yield ""
    yield from (f"{_INDENT}    {clause.text}" for clause in proposal.clauses)
    yield ""
    yield _wrap(formula_text(proposal.fspa))
    yield from (_wrap(reason, "- ") for reason in reasons(proposal, evidence, bits))


def _wrap(text: str, mark: str = "") -> str:
    indent = _INDENT + " " * len(mark)
    return fill(text, _WIDTH, initial_indent=_INDENT + mark, subsequent_indent=indent)
