"""How does a command take options, show diagnostics and choose its exit status?

``OutputPath``, ``WholeRange`` and ``FiniteRange`` are types for the options of click commands.
``open_input`` reads and compiles an argument such as ``SPEC.tltl:NAME``. ``Report`` collects
diagnostics, shows them in the format that the user chose, and returns the exit status. ``exits`` has
all exit statuses.
"""

from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.exits import CLEAN, status_of
from tltlc.interfaces.cli.inputs import Input, open_input
from tltlc.interfaces.cli.numbers import FiniteRange, WholeRange
from tltlc.interfaces.cli.paths import OutputPath, is_stdout
from tltlc.interfaces.cli.report import Report, show
from tltlc.interfaces.cli.settings import CompileSettings
from tltlc.io.child_interrupts import raise_if_interrupted

__all__ = [
    "CLEAN",
    "CompileSettings",
    "FiniteRange",
    "Input",
    "OutputPath",
    "Report",
    "WholeRange",
    "exits",
    "is_stdout",
    "open_input",
    "raise_if_interrupted",
    "show",
    "status_of",
]
