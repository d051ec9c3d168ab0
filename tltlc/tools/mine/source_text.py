"""Proposals as a source text that compiles, with traces as its tests."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from textwrap import wrap
from typing import Final

from tltlc.core.record import replace
from tltlc.tools.mine.bits import Bits
from tltlc.tools.mine.confirm import Judgement, Proposal
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.reasons import reasons
from tltlc.tools.mine.vocabulary import Words, of_columns
from tltlc.tools.witness.blocks import expectations, test_block

_WIDTH: Final = 96
_LONGEST_TEST: Final = 40
"""Changes of the atoms in a trace above which a test of it helps no reader."""


def source_text(proposals: Sequence[Proposal], evidence: Evidence, bits: Bits, preamble: str) -> str:
    """A file with the proposals as specs `mined_1` and so on; ``preamble`` declares what they speak of.

    Each is documented by its English and its reasons, and has tests: the simplest trace that it accepts, and the
    simplest counterexample that it does not.  It has no limit: how long play took is not how long it may take.
    """
    said = _counted(len(evidence.traces), "trace")
    if evidence.counterexamples:
        kind = "made-up counterexample" if evidence.made_up else "counterexample"
        said += f" and {_counted(len(evidence.counterexamples), kind)}"
    longest = _counted(max(len(trace.letters) for trace in evidence.traces), "step")
    parts = [
        f"// Proposed by `tltlc mine` from {said}: read before use.\n"
        f"// Limits are yours to set: the longest of the traces takes {longest}.\n{preamble}"
    ]
    for number, proposal in enumerate(proposals, start=1):
        named = replace(proposal, fspa=replace(proposal.fspa, name=f"mined_{number}"))
        parts += [_spec(named, evidence, bits), *_tests(named)]
    return "\n".join(parts)


def declarations(proposals: Sequence[Proposal], words: Words, imported: str | None) -> str:
    """What declares the names in proposals, and nothing else: the columns that they are.

    Where atoms are of a library, ``imported`` is the line that imports it, and behind it stand further entities.
    """
    texts = [clause.text for proposal in proposals for clause in proposal.clauses]
    texts += [atom.name for proposal in proposals for atom in proposal.fspa.atoms]
    said = "\n".join(texts)

    def is_said(name: str) -> bool:
        return re.search(rf"(?<![\w.]){re.escape(name)}(?![\w.(])", said, re.ASCII) is not None

    if imported is None:
        return of_columns({atom.name: True for atom in words.reader.atoms if is_said(atom.name)}).library.text
    entities = [name for name in words.entities if is_said(name)]
    return imported + (f"\nentity {', '.join(entities)}\n" if entities else "")


def _spec(proposal: Proposal, evidence: Evidence, bits: Bits) -> str:
    said = [proposal.fspa.formula.english, "", *(_sentence(each) for each in reasons(proposal, evidence, bits))]
    lines = [line for text in said for line in wrap(text, _WIDTH) or [""]]
    docs = "".join(f"/// {line}".rstrip() + "\n" for line in lines)
    clauses = "".join(f"    {each.text}\n" for each in proposal.clauses)
    return f"{docs}spec {proposal.fspa.name} {{\n{clauses}}}\n"


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."


def _tests(proposal: Proposal) -> Iterator[str]:
    atoms = {atom.name for atom in proposal.fspa.atoms}

    def changes(judged: Judgement) -> tuple[int, int]:
        """How many lines a trace takes, and how many samples."""
        letters = judged.trace.letters
        return sum(1 for _ in groupby(letter & atoms for letter in letters)), len(letters)

    good = [each for each in proposal.traces if each.accepted]
    bad = [each for each in proposal.counterexamples if not each.accepted]
    for chosen in (good, bad):
        if chosen:
            simplest = min(chosen, key=changes)
            if changes(simplest)[0] <= _LONGEST_TEST:
                letters = simplest.trace.letters
                yield test_block(simplest.trace.name, proposal.fspa, letters, expectations(proposal.fspa, letters))


def _counted(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
