"""Slices of worlds on threads; an interruption waits until all slices are done."""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from types import CodeType
from typing import Any

WAIT_SECONDS = 0.1  # on Windows a wait notices Ctrl-C only when it ends
_compiled: set[CodeType] = set()  # code of the tasks that have been called


def cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _SliceQueue:
    """Slices of worlds that threads take one after the other."""

    def __init__(self, task: Callable[[int, int], None], slices: Sequence[tuple[int, int]]) -> None:
        self._task = task
        self._pending = deque(slices)
        self._unfinished = [None] * len(slices)  # one item for each slice that is not done
        self.errors: list[BaseException] = []
        self.done = threading.Event()

    def run(self) -> None:
        """Run slices until none is left; the operations on the list and the deque are atomic."""
        while True:
            try:
                slice_ = self._pending.popleft()
            except IndexError:
                return
            try:
                self._task(*slice_)
            except BaseException as error:  # raised again by the thread that waits
                self.errors.append(error)
            finally:
                self._unfinished.pop()
                if not self._unfinished:
                    self.done.set()


def run_on_threads(task: Any, slices: Sequence[tuple[int, int]], threads: int) -> None:
    """Call task(first, end) for every slice on a number of threads, and wait until all are done.

    An exception that a signal handler raises meanwhile is raised afterwards.
    """
    code = getattr(task, "func", task).__code__
    if code not in _compiled:
        task(0, 0)  # no world: its kernel is compiled here, where it can be interrupted
        _compiled.add(code)
    queue = _SliceQueue(task, slices)
    interruption: BaseException | None = None
    while not queue.done.is_set():
        try:
            for _ in range(min(threads, len(slices))):
                thread_pool(threads).submit(queue.run)
            while not queue.done.wait(WAIT_SECONDS):
                pass
        except RuntimeError:  # Python is shutting down: no new threads
            queue.run()
        except BaseException as error:
            interruption = error
    if interruption is not None:
        raise interruption
    if queue.errors:
        raise queue.errors[0]


@cache
def thread_pool(threads: int) -> ThreadPoolExecutor:
    """Return the pool with this number of threads."""
    return ThreadPoolExecutor(threads, thread_name_prefix="silverball")


if hasattr(os, "register_at_fork"):  # threads do not survive a fork; a child makes its own
    os.register_at_fork(after_in_child=thread_pool.cache_clear)
