"""What a Ray worker does: one task, with the players of the sender, and kernels compiled once a node.

Ray starts a process for each core of a node. The first task of each kind compiles kernels, or finds them
compiled; while one process of a node compiles, the others wait instead of compiling the same.
"""

from __future__ import annotations

import fcntl
import functools
import hashlib
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from silverball import __version__
from silverball.errors import SilverballError
from silverball.physics.kernel import KERNEL_PACKAGES, cache_folder
from silverball.players import registry
from silverball.source_digest import source_digest

CODE = (*KERNEL_PACKAGES, "game", "studies", "table")  # what decides results


class Job(NamedTuple):
    """What all tasks of a work share; it travels to each node once.

    Attributes:
        function: Called with a task and what it shares with others; a pure function.
        players: Factories of registered players, by name.
        version: The version of Silverball that sends it.
        code: The digest of its code: another one would not give the same bits.
    """

    function: Callable[..., Any]
    players: dict[str, Any]
    version: str
    code: str


class OtherCode(Exception):
    """A node has another version of Silverball, so its results would be others."""


def job_of(function: Callable[..., Any], players: dict[str, Any]) -> Job:
    """The job of a function, with the version and the digest of this code."""
    return Job(function, players, __version__, own_code())


def work(job: Job, kind: str, task: Any, shared: Any) -> Any:
    """Do one task.

    Args:
        job: What all tasks share.
        kind: Tasks of the same kind need the same kernels.
        task: The first argument of the function.
        shared: Its second one, if it is not None.

    Raises:
        OtherCode: This node has another version of Silverball.
    """
    if job.code != own_code():
        raise OtherCode(
            f"the node {os.uname().nodename} has other code (Silverball {__version__}, {own_code()}) than "
            f"this machine ({job.version}, {job.code}): install the same on all nodes"
        )
    for name, factory in job.players.items():
        if name in registry.registered_names():
            registry.unregister(name)
        registry.register(name, factory)
    try:
        with compiled_once(kind):
            return job.function(task) if shared is None else job.function(task, shared)
    except SilverballError as error:  # some of them cannot travel: they need more than a message
        raise SilverballError(*str(error).splitlines()) from None


@functools.cache
def own_code() -> str:
    """The digest of the code of this process."""
    return source_digest(CODE)


@contextmanager
def compiled_once(kind: str) -> Iterator[None]:
    """Let only one process of this machine do the first task of a kind, which may compile for a minute."""
    folder = cache_folder()
    if folder is None or kind in _known:
        yield
        return
    name = hashlib.sha256(f"{folder.name} {kind}".encode()).hexdigest()[:16]
    marks = folder.parent / "spread"
    mark, lock = marks / f"{name}.compiled", marks / f"{name}.lock"
    if mark.exists():
        _known.add(kind)
        yield
        return
    marks.mkdir(exist_ok=True)
    with open(lock, "w", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)  # a process that is killed lets it go
        if mark.exists():
            fcntl.flock(file, fcntl.LOCK_UN)
        yield
        mark.touch()
        _known.add(kind)


_known: set[str] = set()  # kinds of tasks that this process knows to be compiled
