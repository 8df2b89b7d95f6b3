"""Replays: recordings of games as text that can be played, verified, compared and filmed."""
