"""Records, source texts and spans."""
