"""The stealth game of Gutiérrez-Sánchez et al., IEEE Trans. Games 2024 (sections IV and VI), with levels as data."""
