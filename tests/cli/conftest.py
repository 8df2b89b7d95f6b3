"""How the tests call the command line: through the real entry point, in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable

import pytest

Silverball = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def silverball() -> Silverball:
    def run(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "silverball", *arguments]
        return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False, **options)  # type: ignore[call-overload,no-any-return]

    return run
