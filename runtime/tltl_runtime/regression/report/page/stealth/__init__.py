"""The maps and the recorded episodes of the stealth game: the only part of the report that knows a game."""
