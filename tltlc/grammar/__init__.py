"""Parse .tltl text into a syntax tree."""
