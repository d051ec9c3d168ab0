"""Games that are Gymnasium environments, described by a game file: ``FILE.game.toml``.

Begin with :mod:`~tltl_runtime.gymnasium_games.game_file`.
"""
