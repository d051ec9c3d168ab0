"""A game as training, evaluation and regression see it: levels, environments, recordings and an expert."""
