"""High scores, settings and the last game: one SQLite file, and the proof that a score was played."""
