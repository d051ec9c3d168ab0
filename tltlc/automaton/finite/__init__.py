"""From a spec over finite traces to its minimal automaton."""
