"""What the tests of the soak share: rounds of 20 simulated seconds."""

from __future__ import annotations

import pytest

from silverball.soak import rounds as soak_module


@pytest.fixture
def short_rounds(monkeypatch):
    for name in ("ROUND_SECONDS", "HOSTILE_SECONDS"):
        monkeypatch.setattr(soak_module, name, 20.0)
