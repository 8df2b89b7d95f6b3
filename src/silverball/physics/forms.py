"""Forms of primitives: their shapes, and what a contact with one does.

A module of its own, so that tables can be read without the compiler.
"""

from __future__ import annotations

from enum import IntEnum


class Shape(IntEnum):
    """How far a point is from a primitive, and which way is out."""

    PLANE = 0  # a border
    CIRCLE = 1
    CAPSULE = 2  # a segment with a radius
    TRIANGLE = 3
    TAPERED = 4  # a capsule with two radii: a paddle
    ARC = 5  # with a radius
    LINE = 6  # crossed by the ball's centre
    DISC = 7  # entered by the ball's centre


class Response(IntEnum):
    """What a contact with a primitive does."""

    BOUNCE = 0
    PASS = 1  # an event, and the flight goes on
    HOLD = 2  # the ball stays, until it is sent off
