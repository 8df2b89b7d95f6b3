"""Work on a Ray cluster: a head and two nodes on this machine, with all that can befall them."""

from __future__ import annotations

import itertools
import os
import signal
import time
from pathlib import Path

import pytest
import spread_tasks

from commandline import started
from patience import PATIENCE
from silverball import load_table
from silverball.errors import SilverballError
from silverball.players import register, unregister
from silverball.soak import campaign
from silverball.soak.rounds import Options
from silverball.studies.ray_runner import ray_runner, soak_rounds
from silverball.studies.result_folder import ResultFolder
from silverball.studies.run import finish
from silverball.studies.spread import LostTask, Task, spread
from silverball.studies.study_plan import Plan, arms_of

ray = pytest.importorskip("ray")


@pytest.fixture(scope="module")
def nodes():
    """A head without cores, where this process is, and two nodes with one core each."""
    from ray.cluster_utils import Cluster

    made = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    for _ in range(2):
        made.add_node(num_cpus=1)
    yield made
    ray.shutdown()
    made.shutdown()


def squares(count, address, **options):
    tasks = (Task(number, number) for number in range(count))
    return list(spread(spread_tasks.squared, tasks, address, **options))


def test_every_task_has_its_result(nodes):
    done = squares(50, nodes.address)
    assert sorted(task.number for task, _ in done) == list(range(50))
    assert all(result == task.number**2 for task, result in done)
    assert [task.number for task, _ in squares(50, nodes.address, in_order=True)] == list(range(50))
    assert not ray.is_initialized()


@pytest.mark.slow
def test_only_so_many_tasks_are_in_flight_and_what_they_share_travels_once(nodes):
    taken = []
    shared = {"factor": 7}

    def tasks():
        for number in itertools.count():
            taken.append(number)
            yield Task(number, number, shared)

    results = spread(spread_tasks.times, tasks(), nodes.address)
    pids = set()
    for done, (task, (product, pid)) in enumerate(results, 1):
        assert product == 7 * task.number
        pids.add(pid)
        assert len(taken) - done <= 2 * 2
        if done == 12:
            results.close()
    assert len(pids) >= 2
    assert not ray.is_initialized()


@pytest.mark.slow
def test_errors_end_the_work_in_a_sentence(nodes):
    with pytest.raises(SilverballError, match=r"^the table of 3 has a hole$"):
        list(spread(spread_tasks.refused, [Task(0, 3)], nodes.address))
    with pytest.raises(LostTask, match=r"^task 5 failed on a node: ZeroDivisionError"):
        list(spread(spread_tasks.broken, [Task(5, 3)], nodes.address))


@pytest.mark.slow
def test_a_task_that_kills_every_worker_is_given_up(nodes, monkeypatch):
    monkeypatch.setattr("silverball.studies.spread.RETRIES", 1)
    with pytest.raises(LostTask, match=r"^task 8 was lost 2 times with its worker or node"):
        list(spread(spread_tasks.fatal, [Task(8, 3)], nodes.address))


class Lefty:
    """A player that only this process knows."""

    def __init__(self, seed):
        self._seed = seed

    def press(self, world):
        return self._seed == 3, False


@pytest.mark.slow
def test_registered_players_travel_along(nodes):
    register("lefty", Lefty)
    try:
        tasks = [Task(0, "lefty")]
        ((_, pressed),) = spread(spread_tasks.pressed_by, tasks, nodes.address, ["lefty", "reflex"])
    finally:
        unregister("lefty")
    assert pressed == [(True, False)] * 2


def kill_at_once(node):
    """SIGKILL to the raylet and to its workers, as when a machine is switched off."""
    (raylet,) = [info.process.pid for info in node.all_processes["raylet"]]
    for pid in (raylet, *workers_of(raylet)):
        os.kill(pid, signal.SIGKILL)


def is_working(node):
    """Whether a worker of the node is at a task."""
    (raylet,) = [info.process.pid for info in node.all_processes["raylet"]]
    return any(name.startswith("ray::work") for name in workers_of(raylet).values())


def workers_of(raylet):
    """The names of the processes that a raylet has started, by their ids."""
    lines = os.popen(f"ps -o pid=,args= --ppid {raylet}").read().splitlines()
    return {int(pid): name for pid, _, name in (line.strip().partition(" ") for line in lines)}


# --- studies and soaks


def bits(folder: Path) -> list[tuple[str, bytes]]:
    """All that a study has written."""
    return [(path.name, path.read_bytes()) for path in sorted(folder.rglob("*")) if path.is_file()]


def test_a_study_has_the_same_bits_on_a_cluster_of_which_a_node_is_killed(nodes, tmp_path):
    register("lefty", Lefty)
    try:
        arms = arms_of([("classic", load_table("classic"))], ["reflex", "lefty"])
        plan = Plan(arms, games=40, longest=10.0, chunk_games=1)
        extra = nodes.add_node(num_cpus=1)
        folder, killed = ResultFolder(tmp_path / "there", plan), []

        def note(number, _):
            if not killed and is_working(extra):
                kill_at_once(extra)
                killed.append(number)

        finish(folder, ray_runner(nodes.address, ["reflex", "lefty"]), note)
        finish(ResultFolder(tmp_path / "here", plan))
    finally:
        unregister("lefty")
    assert killed
    assert bits(tmp_path / "here") == bits(tmp_path / "there")
    nodes.remove_node(extra)


@pytest.mark.slow
def test_a_study_that_is_stopped_goes_on_without_a_cluster(nodes, tmp_path):
    command = ["study", "classic", "--games", "4000", "--seconds", "60", "--no-playable", "--seed", "5"]
    process = started(*command, "--out", str(tmp_path / "a"), "--ray", nodes.address)
    chunks = tmp_path / "a" / "chunks"
    deadline = time.monotonic() + 90
    while time.monotonic() < deadline and len(list(chunks.glob("*.npz"))) < 3:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130, said
    assert "the same command goes on from there" in said
    done = len(list(chunks.glob("*.npz")))
    assert done >= 3
    for folder in ("a", "b"):
        process = started(*command, "--out", str(tmp_path / folder))
        _, said = process.communicate(timeout=PATIENCE)
        assert process.returncode == 0, said
    assert bits(chunks) == bits(tmp_path / "b" / "chunks")
    assert len(bits(chunks)) > done


@pytest.mark.slow
def test_a_soak_has_the_same_totals_on_a_cluster(nodes, tmp_path):
    options = Options(load_table("random"), 3, 2, 60, False, True)
    frames = 3 * 2 * 600 * 60  # three rounds
    here = campaign.soak(options, frames, tmp_path / "here.json")
    there = campaign.soak(options, frames, tmp_path / "there.json", rounds=soak_rounds(nodes.address))
    assert here == there
    assert here.rounds == 3
    assert (tmp_path / "here.json").read_bytes() == (tmp_path / "there.json").read_bytes()
