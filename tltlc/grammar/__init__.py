"""From .tltl text to syntax tree."""
