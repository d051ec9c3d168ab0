"""The automaton as a Mermaid state diagram, a text that many wikis and code hosts show as a picture.

A long run of states that differ only in a count is drawn as one state. All edges from one state to
another share an arrow, because Mermaid would draw only the last of several loops of a state.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from tltlc.automaton.fspa import Fspa, State
from tltlc.backends import Files, Options, Target
from tltlc.backends.drawing.folding import distance_range
from tltlc.backends.drawing.picture_content import distance_note, folded_drawing, memory_texts, picture_content
from tltlc.backends.drawing.state_rows import state_rows
from tltlc.backends.drawing.texts import escape_invisible, wrap_text
from tltlc.backends.drawing.timers import CLOCK, Timer

TARGET = Target("mermaid", "a state diagram for Mermaid", (".mmd",))

WIDTH, MOST_LINES = 22, 16
"""The most characters in a line, and the most lines of a text.

Mermaid would break longer lines at any blank.
"""

CLASSES = """\
    classDef satisfied fill:#dcfce7,stroke:#15803d,stroke-width:4px,color:#0f172a
    classDef holding fill:#f0fdf4,stroke:#16a34a,stroke-width:4px,color:#0f172a
    classDef pending fill:#f8fafc,stroke:#475569,color:#0f172a
    classDef violated fill:#fef2f2,stroke:#dc2626,color:#0f172a"""
DASHED = "    classDef folded stroke-dasharray:6 4"
LEGEND = "    classDef legend fill:none,stroke:none"

_PLAIN = frozenset(" (),.∞¬∧∨⇒⇔⊤⊥◇□○𝒰" + CLOCK)


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the file ``NAME.mmd``, where NAME is the name of the automaton.

    A state shows its label and distance, in the colours of its verdict. An arrow shows guards;
    over infinite traces, each guard is followed by the sets of Rabin pairs that contain its edge.
    Long runs of states that differ only in a count are folded into one state, which is dashed. A
    legend explains the marks.
    """
    content = picture_content(fspa, folded_drawing(fspa), options.notation)
    drawing = content.drawing
    lines = ["stateDiagram-v2", "    direction LR", f"    accTitle: The automaton of {_escape(fspa.name)}"]
    lines += [
        _state(fspa, drawing.folded.get(state.id, (state,)), content.timers.get(state.id, {}), options)
        for state in drawing.states
    ]
    lines.append("    [*] --> s0")
    for (source, target), guards in content.guards.items():
        lines.append(f"    s{source} --> s{target}: {_lines([*(f'{guard};' for guard in guards[:-1]), guards[-1]])}")
    legend = (distance_note(drawing, "In brackets", "thick outline"), *content.notes, *memory_texts(content.memory))
    lines.append(f'    state "{_lines(legend)}" as legend')
    lines += [CLASSES, DASHED, LEGEND] if drawing.folded else [CLASSES, LEGEND]
    lines += [f"    class s{state.id} {state.verdict}" for state in drawing.states]
    lines += [f"    class s{state} folded" for state in drawing.folded]
    lines.append("    class legend legend")
    return {f"{fspa.name}.mmd": "\n".join([*lines, ""])}


def _state(fspa: Fspa, run: tuple[State, ...], timers: Mapping[str, Timer], options: Options) -> str:
    """Return the line that declares a drawn state in Mermaid: ``state "…" as s0``.

    ``run`` has this state, or all states that are folded into it. ``timers`` run in it.
    """
    first, last = run[0], run[-1]
    heading = [f"{len(run)} more like these:"] if len(run) > 1 else []
    rows = state_rows(fspa, run, timers, options.notation)
    texts = [*heading, *rows, f"[{distance_range(first.distance, last.distance)}]"]
    return f'    state "{_lines(texts)}" as s{first.id}'


def _lines(texts: Sequence[str]) -> str:
    return "<br/>".join(_escape(line) for text in texts for line in wrap_text(text, WIDTH, MOST_LINES))


def _escape(text: str) -> str:
    """Return the text with Mermaid escapes (``#38;`` for ``&``), so that Mermaid reads none of it as syntax.

    Letters, digits and a few other characters are not escaped.
    """
    escaped = "".join(
        character if character.isalnum() or character in _PLAIN else f"#{ord(character)};"
        for character in escape_invisible(text)
    )
    # Mermaid treats any line that contains `direction LR` as that statement.
    return re.sub("direction", lambda match: f"#{ord(match.group()[0])};{match.group()[1:]}", escaped, flags=re.I)
