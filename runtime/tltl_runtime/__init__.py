"""The runtime of .tltl specifications: a stealth game, environments that reward by a spec, and many automata at once.

Importing this package loads neither torch nor pybullet.  It needs the extra ``rl``.
"""

from __future__ import annotations
