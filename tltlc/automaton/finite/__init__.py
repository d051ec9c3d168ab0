"""Build the minimal automaton of a spec over finite traces."""
