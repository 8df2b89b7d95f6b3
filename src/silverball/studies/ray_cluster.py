"""The connection to a Ray cluster: an address that answers within ten seconds, or one sentence.

local             a cluster of this machine's cores, for as long as the work takes
auto              the cluster that this machine is a node of
HOST:PORT         the same, by the address that `ray start --head` printed
ray://HOST:PORT   a cluster that this machine is no node of, by its Ray client server
"""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from silverball.errors import MissingExtra, SilverballError
from silverball.world.threads import cores

LOCAL = "local"
ADDRESS = re.compile(r"(?:ray://)?(?P<host>[\w.-]+|\[[0-9a-fA-F:.]+\]):(?P<port>\d{1,5})")
SOCKET_SECONDS = 2.0  # within which a port must accept a connection
ANSWER_SECONDS = 7.0  # within which a cluster must answer; together less than ten seconds
EXPECTED = "expected local, auto, HOST:PORT or ray://HOST:PORT"
QUIET = {  # of Ray: no figures to its makers, no warnings about what is meant so
    "RAY_USAGE_STATS_ENABLED": "0",
    "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0",
    "RAY_DEDUP_LOGS": "1",
}
INIT = {"include_dashboard": False, "log_to_driver": False, "logging_level": "ERROR"}
PROBE = "import sys, ray; ray.init(address=sys.argv[1], log_to_driver=False, logging_level='ERROR')"


class NoCluster(SilverballError):
    """No Ray cluster answers at an address, or it cannot be used."""


@contextmanager
def cluster(address: str) -> Iterator[Any]:
    """Connect to a cluster; yields the module `ray`, and leaves the cluster at the end.

    Args:
        address: See the top of this file.

    Raises:
        MissingExtra: Ray is not installed.
        NoCluster: Nothing answers at the address within ten seconds.
    """
    require_cluster(address)
    ray = require_ray()
    if ray.is_initialized():  # of the caller, who also ends it
        yield ray
        return
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        if address == LOCAL:
            ray.init(num_cpus=cores(), **INIT)
        else:
            ray.init(address=address, log_to_driver=False, logging_level="ERROR")
    except Exception as error:  # Ray raises its own, gRPC's and Python's
        raise NoCluster(f"--ray {address}: {_first_line(error)}") from None
    finally:
        if threading.current_thread() is threading.main_thread():
            for number, handler in handlers.items():
                signal.signal(number, handler)  # Ray sets its own
    try:
        yield ray
    finally:
        ray.shutdown()


def require_ray() -> Any:
    """The module `ray`.

    Raises:
        MissingExtra: It is not installed.
    """
    try:
        import ray
    except ImportError:
        raise MissingExtra("spreading work with --ray", "ray") from None
    return ray


def require_cluster(address: str) -> None:
    """Check that a cluster can be used, before anything else is done.

    Raises:
        MissingExtra: Ray is not installed.
        NoCluster: The address is none, or no cluster answers there within ten seconds.
    """
    check_address(address)
    for name, value in QUIET.items():
        os.environ.setdefault(name, value)
    require_ray()
    probe(address)


def check_address(address: str) -> None:
    """Check that a text can be the address of a cluster.

    Raises:
        NoCluster: It cannot.
    """
    if address in (LOCAL, "auto"):
        return
    found = ADDRESS.fullmatch(address)
    if found is None or not 0 < int(found["port"]) < 2**16:
        raise NoCluster(f"--ray: {EXPECTED}, got {address!r}")


def probe(address: str) -> None:
    """Check that a Ray cluster answers.

    A process of its own asks: Ray waits for a minute, and ends the process that it is in, if another program
    listens at the address. A cluster that has answered once is not asked again.

    Raises:
        NoCluster: None does within ten seconds.
    """
    if address == LOCAL or address in _answered:
        return
    found = ADDRESS.fullmatch(address)
    if found is not None:
        host, port = found["host"].strip("[]"), int(found["port"])
        try:
            socket.create_connection((host, port), SOCKET_SECONDS).close()
        except OSError as error:
            reason = error.strerror or str(error)
            raise NoCluster(
                f"--ray {address}: no Ray cluster answers there ({reason}); start one with  ray start --head"
            ) from None
    try:
        asked = subprocess.run(
            [sys.executable, "-c", PROBE, address],
            capture_output=True, text=True, timeout=ANSWER_SECONDS, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        reason = f"nothing that answers within {ANSWER_SECONDS:g} s"
    else:
        if asked.returncode == 0:
            _answered.add(address)
            return
        lines = [line for line in asked.stderr.splitlines() if line.strip()]
        reason = re.sub(r"^[\w.]+(?:Error|Exception): ", "", lines[-1]) if lines else "no Ray cluster"
    raise NoCluster(f"--ray {address}: no Ray cluster answers there ({reason[:300]})")


_answered: set[str] = set()  # addresses of clusters


def _first_line(error: Exception) -> str:
    return (str(error).strip().splitlines() or [type(error).__name__])[0][:300]
