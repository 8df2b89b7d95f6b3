"""The hop of a resting ball: two numbers that both the physics and the checks of tables need."""

HOP = 5e-4
"""[u] Height of the hop that a touch leaves at least, so that a resting ball does not bounce ever faster.
Under gravity 10 u/s² a hop takes 0.02 s, 50 events a second, and is 1/1000 of a ball high: invisible.
Smaller: more events for a ball at rest. Larger: a ball at rest visibly trembles. Source: chosen."""

HOP_SHARE = 0.9
"""A hop is at most this share of `hit_speed`, so that it never comes back as a hit. Source: chosen."""
