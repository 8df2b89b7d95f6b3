"""How the tests call the command line.

In their own process, which saves a second each time; in one of its own what depends on that: another
environment, or a run that is to share nothing with the one before.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable

import pytest

from commandline import ran

Silverball = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def new_process() -> Silverball:
    def run(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "silverball", *arguments]
        return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False, **options)  # type: ignore[call-overload,no-any-return]

    return run


@pytest.fixture(scope="session")
def silverball(new_process) -> Silverball:
    def run(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
        return new_process(*arguments, **options) if "env" in options else ran(*arguments, **options)

    return run
