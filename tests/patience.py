"""How long tests wait for anything to happen, which only a fault takes, even while others compile."""

from __future__ import annotations

PATIENCE = 600  # [s]
