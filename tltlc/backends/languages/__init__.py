"""The syntax of the languages of monitors: printers, literals and reserved names."""
