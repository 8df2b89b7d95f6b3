"""High scores, settings and the last game: one SQLite file, and the verification of scores."""
