"""What all other packages use: records, names with arguments, and source texts with spans."""
