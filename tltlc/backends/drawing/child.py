"""The program of a child process that draws a graph: ``python child.py FORMAT ENGINE < graph.dot > picture``.

Python cannot interrupt a layout that takes too long, so it runs in a process that the parent can
kill.
"""

from __future__ import annotations

import signal
import sys


def main() -> None:
    """Read a DOT text from standard input, and write the picture to standard output."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # Let Ctrl-C end this process without a traceback. The parent gets the signal too, and sees why the child ended.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    import pygraphviz

    picture_format, engine = sys.argv[1:]
    graph = pygraphviz.AGraph(string=sys.stdin.buffer.read().decode("utf-8"))
    sys.stdout.buffer.write(graph.draw(format=picture_format, prog=engine))


if __name__ == "__main__":
    main()
