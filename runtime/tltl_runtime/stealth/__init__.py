"""The stealth game. Its levels are data files, not code. Begin with `simulation`, which plays one level.

Source: Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, sections IV and VI.
"""
