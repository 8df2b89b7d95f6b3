"""Silverball: a pinball table in Python."""

__version__ = "0.1.0"
