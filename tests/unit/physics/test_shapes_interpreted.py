"""The new shapes give the same bits interpreted and compiled."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import shape_flights
from patience import PATIENCE
from silverball.physics import records as layouts


def test_the_interpreted_flights_give_the_bits_of_the_compiled_ones() -> None:
    run = subprocess.run(
        [sys.executable, "-W", "ignore", str(Path(shape_flights.__file__))],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True, text=True, check=False, timeout=PATIENCE,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert json.loads(run.stdout) == shape_flights.flights()


LAYOUTS = {name: value for name, value in vars(layouts).items() if isinstance(value, np.dtype)}


@pytest.mark.parametrize("name", LAYOUTS)
def test_no_field_of_a_record_is_hidden_by_an_attribute_of_numpy(name: str) -> None:
    """Interpreted kernels read fields as attributes, where numpy's own come first."""
    assert [field for field in LAYOUTS[name].names or () if hasattr(np.record, field)] == []
