"""Read automata in the Hanoi omega-automata format (HOA), version 1: https://adl.github.io/hoaf/.

Begin with :mod:`~tltlc.tools.hoa.load`.
"""
