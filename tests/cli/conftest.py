"""Fixtures that run the command line.

`silverball` runs a command in the process of the tests, which saves a second each time; `new_process` runs it
in a new process, for tests of the environment, of exit codes or of two independent runs.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable

import pytest

from commandline import ran
from patience import PATIENCE

Silverball = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def new_process() -> Silverball:
    def run(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "silverball", *arguments]
        return subprocess.run(
            command, capture_output=True, text=True, timeout=PATIENCE, check=False, **options
        )  # type: ignore[call-overload,no-any-return]

    return run


@pytest.fixture(scope="session")
def silverball(new_process) -> Silverball:
    def run(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
        return new_process(*arguments, **options) if "env" in options else ran(*arguments, **options)

    return run
