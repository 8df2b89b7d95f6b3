"""Metrics of a table from thousands of simulated games: ball times, shots, scores, with 95 % intervals."""
