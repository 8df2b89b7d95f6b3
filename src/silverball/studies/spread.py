"""Work that is spread over a Ray cluster: many tasks, each a pure function of what it is given.

Results come back as they are finished, or in order. If a node is lost, its tasks are done again elsewhere
until it has a result, and since it is a pure function that result is the same. Only so many tasks are handed
to the cluster as it can work on at once, twice over, so neither the tasks nor the results of a million of
them have to fit into memory.
"""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from silverball.errors import SilverballError
from silverball.players import registry
from silverball.studies.node_work import Job, job_of, work
from silverball.studies.ray_cluster import cluster

RETRIES = 20  # of a task whose worker or node is lost
PER_CORE = 2  # tasks in flight for each core: one is worked on, one waits
MOST_IN_FLIGHT = 20_000  # chosen: Ray's waiting takes time in proportion
MOST_WAITING = 4  # results in flight, in the same unit, that may wait for an earlier one, if order is wanted
COUNT_SECONDS = 5.0  # between two counts of the cores, which may become more or fewer
WAIT_SECONDS = 0.5  # [s] between two looks for Ctrl-C and new cores
OWN = "silverball"


class Task(NamedTuple):
    """One piece of work.

    Attributes:
        number: Unlike those of all others.
        argument: The first argument of the function.
        shared: The second one, which other tasks have too: it travels to each node once. None: there is none.
        kind: Tasks of one kind need the same kernels, which are compiled once a node.
    """

    number: int
    argument: Any
    shared: Any = None
    kind: str = ""


class LostTask(SilverballError):
    """A task could not be done, however often it was tried."""


def spread(
    function: Callable[..., Any],
    tasks: Iterable[Task],
    address: str,
    players: Iterable[str] = (),
    *,
    in_order: bool = False,
) -> Iterator[tuple[Task, Any]]:
    """Do tasks on a Ray cluster; yields each with its result.

    Args:
        function: A pure function of a task's argument and what it shares. Its module travels along.
        tasks: The tasks; they are taken as they can be worked on.
        address: "local", "auto", "HOST:PORT" or "ray://HOST:PORT".
        players: Names of players that the function asks for; registered ones travel along.
        in_order: Whether results are yielded in the order of the tasks instead of as they come.

    Raises:
        MissingExtra: Ray is not installed.
        NoCluster: No cluster answers within ten seconds.
        LostTask: A task was lost too often, or a node has other code.
        SilverballError: The function raised it.

    Examples:
        >>> from silverball.studies.spread import Task, spread
        >>> tasks = (Task(number, number) for number in range(3))
        >>> [result for _, result in spread(abs, tasks, "local", in_order=True)]  # doctest: +SKIP
        [0, 1, 2]
    """
    with cluster(address) as ray:
        send_by_value(ray, function)
        yield from _Spread(ray, job_of(function, own_players(ray, players)), iter(tasks), in_order).results()


def own_players(ray: Any, names: Iterable[str]) -> dict[str, Any]:
    """The factories of registered players."""
    players = {}
    for name in names:
        if name in registry.BUILT_IN or name == "beginner":
            continue
        registry.check_name(name)
        players[name] = registry.registered_factory(name)
        send_by_value(ray, players[name])
    return players


def send_by_value(ray: Any, function: Any) -> None:
    """Make the module of a function or class travel along, if nodes may not have it."""
    name = getattr(function, "__module__", None) or "builtins"
    if name in sys.modules and name not in ("builtins", "__main__") and not name.startswith(f"{OWN}."):
        ray.cloudpickle.register_pickle_by_value(sys.modules[name])


class _Spread:
    """The tasks in flight, and the results that wait for an earlier one."""

    def __init__(self, ray: Any, job: Job, tasks: Iterator[Task], in_order: bool) -> None:
        self._ray, self._tasks, self._in_order = ray, tasks, in_order
        self._job = ray.put(job)
        self._do = ray.remote(num_cpus=1, max_retries=RETRIES)(work)
        self._shared: dict[int, tuple[Any, Any]] = {}  # by identity: the value, kept alive, and its reference
        self._flying: dict[Any, Task] = {}
        self._counted, self._room = -1e9, 0

    def results(self) -> Iterator[tuple[Task, Any]]:
        """Every task with its result."""
        waiting: dict[int, Any] = {}
        order: deque[Task] = deque()
        try:
            while True:
                order.extend(self._start_more(len(waiting)))
                if not self._flying:
                    break
                for task, result in self._finished():
                    if not self._in_order:
                        yield task, result
                    else:
                        waiting[task.number] = result
                while order and order[0].number in waiting:
                    task = order.popleft()
                    yield task, waiting.pop(task.number)
                if not self._in_order:
                    order.clear()
        finally:
            for reference in self._flying:
                self._ray.cancel(reference, force=True)

    def _start_more(self, waiting: int) -> list[Task]:
        """Hand tasks to the cluster until it has enough; returns them."""
        if time.monotonic() - self._counted > COUNT_SECONDS:
            cores = max(1, int(self._ray.cluster_resources().get("CPU", 1)))
            self._counted, self._room = time.monotonic(), min(MOST_IN_FLIGHT, PER_CORE * cores)
        started: list[Task] = []
        while len(self._flying) < self._room and waiting <= MOST_WAITING * self._room:
            task = next(self._tasks, None)
            if task is None:
                break
            started.append(task)
            reference = self._do.remote(self._job, task.kind, task.argument, self._sent(task.shared))
            self._flying[reference] = task
        return started

    def _sent(self, shared: Any) -> Any:
        """The reference of a value that tasks share."""
        if shared is None:
            return None
        if id(shared) not in self._shared:
            self._shared[id(shared)] = shared, self._ray.put(shared)
        return self._shared[id(shared)][1]

    def _finished(self) -> Iterator[tuple[Task, Any]]:
        """The tasks that have been finished, after waiting for the first a moment."""
        ready, _ = self._ray.wait(list(self._flying), num_returns=1, timeout=WAIT_SECONDS)
        if ready:  # those that have been finished meanwhile
            ready, _ = self._ray.wait(list(self._flying), num_returns=len(self._flying), timeout=0)
        for reference in ready:
            task = self._flying[reference]
            result = self._result(reference, task)
            del self._flying[reference]
            yield task, result

    def _result(self, reference: Any, task: Task) -> Any:
        errors = self._ray.exceptions
        try:
            return self._ray.get(reference)
        except errors.RayTaskError as error:
            cause = error.cause
            if isinstance(cause, SilverballError):
                raise cause from None
            raise LostTask(
                f"task {task.number:,} failed on a node: {type(cause).__name__}: {cause}"
            ) from error
        except errors.RayError as error:
            line = (str(error).strip().splitlines() or [""])[0]
            raise LostTask(
                f"task {task.number:,} was lost {RETRIES + 1} times with its worker or node: {line}"
            ) from None
