"""The tools that work on specs and automata. Each package is one tool."""
