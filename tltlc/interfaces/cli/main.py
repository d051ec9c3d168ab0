"""The entry point of ``tltlc``. The module imports nothing at the top, so it can handle Ctrl-C from the start.

Python's own handler would raise an exception, even in the middle of an import, and Python would
print its traceback.
"""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType
    from typing import NoReturn


def main(arguments: "Sequence[str] | None" = None) -> "NoReturn":
    """Run the command line and exit with its status.

    Without ``arguments``, use the arguments of the process, handle its signals, and open standard
    streams that are closed.
    """
    if arguments is None:
        _run_process()
    from tltlc.interfaces.cli.command_line import cli

    cli.main(args=list(arguments))


def end_at_once(number: int = 2, frame: "FrameType | None" = None) -> "NoReturn":
    """Handle Ctrl-C while the command line is loading, when there is no work to keep yet."""
    import os

    os._exit(128 + number)


def _run_process() -> "NoReturn":
    try:
        import atexit
        import gc
        import signal

        # Loading the modules and compiling a spec makes fewer objects than this, and none of them is garbage. With
        # Python's own threshold, the collector would visit them about a hundred times.
        gc.set_threshold(100_000)
        # At its exit, Python collects garbage, whatever the threshold is. It skips frozen objects.
        atexit.register(gc.freeze)
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, end_at_once)
        from tltlc.interfaces.cli.streams import open_missing_streams

        open_missing_streams()
        from tltlc.interfaces.cli.command_line import cli
        from tltlc.interfaces.cli.interrupts import end_on_signals

        with end_on_signals():
            cli.main()
    except KeyboardInterrupt:
        # The interrupt came before our handler was installed, or after it was removed.
        raise SystemExit(_interrupted()) from None


def _interrupted() -> int:
    """Return the exit status after a KeyboardInterrupt.

    Before the command line is loaded, only Ctrl-C can raise one.
    """
    import sys

    exits = sys.modules.get("tltlc.interfaces.cli.exits")
    return exits.interrupted_status() if exits else 130
