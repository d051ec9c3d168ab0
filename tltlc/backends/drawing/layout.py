"""Pictures of automata, laid out by Graphviz within a time limit."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options
from tltlc.backends.dot import Detail, graph
from tltlc.backends.drawing.accessible_svg import make_accessible
from tltlc.backends.drawing.picture_content import folded_drawing
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.child_interrupts import raise_if_interrupted

CHILD = Path(__file__).with_name("child.py")

MOST_EDGES_WITH_GUARDS = 150
"""The most edges of a picture with guards.

More guards would cover each other, or push the states too far apart.
"""

MOST_EDGES_IN_LAYERS = 400
"""The most edges of a picture in layers; with more, this layout would reach its time limit."""

WHOLE_GRAPH = "`tltlc compile -t dot` writes the whole graph for other tools"

ATTEMPTS: tuple[tuple[Detail, str, float, str], ...] = (
    ("full", "dot", MOST_EDGES_WITH_GUARDS, ""),
    ("labels", "dot", MOST_EDGES_IN_LAYERS, "without guards"),
    ("sketch", "sfdp", float("inf"), "by number, without guards"),
)
"""The ways to draw a graph, which are tried in this order.

Each has the detail of the drawing, the layout engine, the most edges for which it is tried, and the
words with which a message says what is left out, if anything.
"""


def draw(fspa: Fspa, options: Options, picture_format: str) -> Files:
    """Return the picture ``NAME.FORMAT`` of the automaton NAME, with the most detail that can be drawn in time.

    Long runs of states that differ only in a count are folded. There are three attempts:

    1. Draw everything, with the states in layers.
    2. Leave out guards, which are then only in the tooltips of an SVG.
    3. Draw only the numbers of the states, with a force-directed layout.

    An attempt takes at most ``options.layout_limit_s`` seconds, and is skipped if there are too
    many edges. If no attempt succeeds, the result is ``NAME.dot`` with nothing folded.
    ``options.report`` is called with a note (TLT0711) if anything was left out.

    Raises:
        TltlError: TLT0730 pygraphviz is not installed, TLT0712 the layout itself failed.
    """
    if find_spec("pygraphviz") is None:
        title = "a picture needs `pygraphviz`, which is not installed"
        raise TltlError([Diagnostic("TLT0730", title, help="pip install 'pygraphviz'")])
    name = f"{fspa.name}.{picture_format}"
    drawing = folded_drawing(fspa)
    for detail, engine, most_edges, cut in ATTEMPTS:
        if len(drawing.edges) <= most_edges:
            picture = _lay_out(graph(fspa, options, drawing, detail), picture_format, engine, options.layout_limit_s)
            if picture is not None:
                if cut:
                    title = f"the picture of `{fspa.name}` shows its {len(fspa.states)} states {cut}: it is too tangled"
                    options.report(Diagnostic("TLT0711", title, help=WHOLE_GRAPH, severity="note"))
                return {
                    name: make_accessible(picture, fspa.name, drawing.folded) if picture_format == "svg" else picture
                }
    title = f"`{fspa.name}` is too tangled to be drawn in time: its graph is written in the format DOT instead"
    options.report(Diagnostic("TLT0711", title, help="other tools may draw it", severity="note"))
    return {f"{fspa.name}.dot": graph(fspa, options)}


def _lay_out(dot: str, picture_format: str, engine: str, limit_s: float) -> bytes | None:
    """Return the picture of the graph ``dot``, laid out by Graphviz's ``engine`` in a child process.

    Return None if the layout reached its time limit or its process was killed. Raises
    KeyboardInterrupt if Ctrl-C ended the process, and TltlError, TLT0712, if the layout failed.
    """
    command = [sys.executable, str(CHILD), picture_format, engine]
    try:
        process = subprocess.run(command, input=dot.encode(), capture_output=True, timeout=limit_s, check=False)
    except subprocess.TimeoutExpired:
        return None
    raise_if_interrupted(process.returncode)
    if process.returncode < 0:
        return None  # A signal ended the process, usually because it ran out of memory or stack.
    if process.returncode or not process.stdout:
        reason = process.stderr.decode(errors="replace").strip().splitlines() or [f"exit status {process.returncode}"]
        raise TltlError([Diagnostic("TLT0712", f"the picture could not be drawn: {reason[-1]}", help=WHOLE_GRAPH)])
    return process.stdout
