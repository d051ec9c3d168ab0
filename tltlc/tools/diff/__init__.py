"""Compare specs: the traces that they accept, their atoms and signals, and how they are judged.

:mod:`tltlc.tools.diff.pairs` compares two files for ``tltlc diff``.
:mod:`tltlc.tools.diff.breaking` compares two versions of a file for ``tltlc breaking``.
"""
