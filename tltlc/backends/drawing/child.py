"""The process that lays a graph out: ``python child.py FORMAT ENGINE < graph.dot > picture``.

A layout cannot be interrupted from within, so that it runs where it can be ended from outside.
"""

from __future__ import annotations

import signal
import sys


def main() -> None:
    """Read a DOT text, write the picture."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # Ctrl-C reaches the parent, too, which recognises this end.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    import pygraphviz

    picture_format, engine = sys.argv[1:]
    graph = pygraphviz.AGraph(string=sys.stdin.buffer.read().decode("utf-8"))
    sys.stdout.buffer.write(graph.draw(format=picture_format, prog=engine))


if __name__ == "__main__":
    main()
