"""The stealth game, with levels as data.

Source: Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, sections IV and VI.
"""
