"""The maps and the recorded episodes of the stealth game: all that the report knows of one game."""
