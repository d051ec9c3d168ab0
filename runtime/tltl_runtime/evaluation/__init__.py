"""Episodes that policies play, each the same whenever and wherever it is played, and what they show."""
