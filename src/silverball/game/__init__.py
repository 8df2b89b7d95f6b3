"""What does it all mean? Rules make a game of a world: points, balls left, tilt, replays, high scores.

No window in here: the window, the films and the tests are all callers of the same `Game`.
"""
