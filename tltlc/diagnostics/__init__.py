"""Everything that tltlc has to say about a source text, and how it is shown."""
