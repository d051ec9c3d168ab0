"""Child process that lays out a graph: ``python child.py FORMAT ENGINE < graph.dot > picture``.

A layout cannot be interrupted from within Python, so it runs in a process that the parent can kill.
"""

from __future__ import annotations

import signal
import sys


def main() -> None:
    """Read a DOT text and write the picture."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # Ctrl-C also reaches the parent, which recognises that the child died of SIGINT.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    import pygraphviz

    picture_format, engine = sys.argv[1:]
    graph = pygraphviz.AGraph(string=sys.stdin.buffer.read().decode("utf-8"))
    sys.stdout.buffer.write(graph.draw(format=picture_format, prog=engine))


if __name__ == "__main__":
    main()
