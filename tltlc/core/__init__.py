"""Records, names with arguments, and source texts with spans: the code that all other packages use."""
