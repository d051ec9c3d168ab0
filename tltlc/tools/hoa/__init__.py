"""Automata in the Hanoi omega-automata format (HOA), version 1, read: https://adl.github.io/hoaf/."""
