"""Write proposals as a source text that compiles, with traces as its tests."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from textwrap import wrap
from typing import Final

from tltlc.automaton.compare import Letter
from tltlc.automaton.text import formula_text
from tltlc.core.record import replace
from tltlc.expression.tree import SignalValue, nodes
from tltlc.tools.mine.bits import Bits
from tltlc.tools.mine.confirm import Proposal, ProposalVerdict
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.reasons import reasons
from tltlc.tools.mine.trace_clock import clock_declaration
from tltlc.tools.mine.vocabulary import MiningVocabulary, signal_declarations
from tltlc.tools.witness.blocks import expectations, test_block
from tltlc.tools.witness.step_lengths import length_names

_WIDTH: Final = 96
_LONGEST_TEST: Final = 40
"""The most lines of a test. Longer tests are unreadable, so they are not written."""


def source_text(proposals: Sequence[Proposal], evidence: Evidence, bits: Bits, preamble: str) -> str:
    """Return a source text with the proposals as specs `mined_1`, `mined_2` and so on.

    ``preamble`` declares the names that the specs use. The documentation of each spec says in English
    what it asks for, and why it is proposed. Two tests follow it: the simplest trace that the spec
    accepts, and the simplest counterexample that it rejects. The specs have no limit, because traces
    show how long play took, not how long it may take.
    """
    origin = _count_text(len(evidence.traces), "trace")
    if evidence.counterexamples:
        kind = "made-up counterexample" if evidence.made_up else "counterexample"
        origin += f" and {_count_text(len(evidence.counterexamples), kind)}"
    longest = _count_text(max(len(trace.letters) for trace in evidence.traces), "step")
    parts = [
        f"// Proposed by `tltlc mine` from {origin}: read before use.\n"
        f"// Set limits yourself: the longest of the traces takes {longest}.\n{preamble}"
    ]
    for number, proposal in enumerate(proposals, start=1):
        named = replace(proposal, fspa=replace(proposal.fspa, name=f"mined_{number}"))
        parts += [_spec(named, evidence, bits), *_tests(named)]
    return "\n".join(parts)


def declarations(proposals: Sequence[Proposal], vocabulary: MiningVocabulary, import_text: str | None) -> str:
    """Return the declarations of the names that the proposals use, and no others.

    Without a library, ``import_text`` is None. Then the columns are declared as signals, and so is the
    clock of the traces. With a library, ``import_text`` is the line that imports it. Then the result is
    this line, and a declaration of the entities that the library lacks.
    """
    used = {atom.name: atom for proposal in proposals for atom in proposal.fspa.atoms}
    if import_text is None:
        read = {node.name for atom in used.values() for node in nodes(atom.expression) if isinstance(node, SignalValue)}
        signals = [signal for signal in vocabulary.reader.signals if signal.name in read]
        # Signals with arguments come first, after the entities that are their arguments.
        return clock_declaration(vocabulary.reader.clock_s) + signal_declarations(
            [(signal.base, signal.arguments) for signal in sorted(signals, key=lambda signal: not signal.arguments)],
            {signal.base for signal in signals if signal.type != "bool"},
        )
    arguments = {argument for atom in used.values() for argument in atom.arguments}
    entities = [name for name in vocabulary.entities if name in arguments]
    return import_text + (f"\nentity {', '.join(entities)}\n" if entities else "")


def _spec(proposal: Proposal, evidence: Evidence, bits: Bits) -> str:
    paragraphs = [
        formula_text(proposal.fspa),
        "",
        *(_sentence(reason) for reason in reasons(proposal, evidence, bits)),
    ]
    lines = [line for paragraph in paragraphs for line in wrap(paragraph, _WIDTH) or [""]]
    docs = "".join(f"/// {line}".rstrip() + "\n" for line in lines)
    clauses = "".join(f"    {clause.text}\n" for clause in proposal.clauses)
    return f"{docs}spec {proposal.fspa.name} {{\n{clauses}}}\n"


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."


def _tests(proposal: Proposal) -> Iterator[str]:
    atoms = {atom.name for atom in proposal.fspa.atoms}

    def own_letters(verdict: ProposalVerdict) -> tuple[Letter, ...]:
        """Return what the spec sees of a trace: lengths of steps only if it remembers something."""
        letters = verdict.trace.letters
        if not proposal.fspa.registers:
            return tuple(letter & atoms for letter in letters)
        return tuple((letter & atoms) | length_names(letter) for letter in letters)

    def lengths(verdict: ProposalVerdict) -> tuple[int, int]:
        """Return how many lines a trace takes in a test, and how many samples it has."""
        letters = own_letters(verdict)
        return sum(1 for _ in groupby(letters)), len(letters)

    good = [judgement for judgement in proposal.traces if judgement.accepted]
    bad = [judgement for judgement in proposal.counterexamples if not judgement.accepted]
    for verdicts in (good, bad):
        if verdicts:
            simplest = min(verdicts, key=lengths)
            if lengths(simplest)[0] <= _LONGEST_TEST:
                letters = own_letters(simplest)
                yield test_block(simplest.trace.name, proposal.fspa, letters, expectations(proposal.fspa, letters))


def _count_text(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
