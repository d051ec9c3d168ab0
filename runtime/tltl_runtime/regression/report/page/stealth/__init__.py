"""Maps and recorded episodes of the stealth game. The rest of the report knows no game."""
