"""Work on a Ray cluster: a head and two nodes on this machine, with all that can befall them."""

from __future__ import annotations

import socket
import threading
import time

import pytest
import spread_tasks

from silverball.studies import node_work
from silverball.studies.node_work import compiled_once, job_of, work
from silverball.studies.ray_cluster import NoCluster, cluster
from silverball.studies.spread import Task, spread

ray = pytest.importorskip("ray")


@pytest.mark.parametrize("address", ["", "nowhere", "host:", "host:70000", "http://host:1", "a b:6379"])
def test_what_is_no_address_is_refused(address):
    with pytest.raises(NoCluster, match="expected local, auto, HOST:PORT or ray://HOST:PORT"):
        next(spread(spread_tasks.squared, [Task(0, 1)], address))


def test_an_address_without_a_cluster_is_named_within_ten_seconds():
    with socket.socket() as silent:  # accepts connections and says nothing
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        port = silent.getsockname()[1]
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            closed = free.getsockname()[1]
        for address in (f"127.0.0.1:{closed}", f"127.0.0.1:{port}", "no-such-host.invalid:6379"):
            started = time.monotonic()
            with pytest.raises(NoCluster) as raised, cluster(address):
                pass
            assert time.monotonic() - started < 10
            assert f"--ray {address}: no Ray cluster answers there (" in str(raised.value)
            assert "\n" not in str(raised.value)


def test_one_process_of_a_node_compiles_while_the_others_wait(monkeypatch, tmp_path):
    monkeypatch.setattr(node_work, "cache_folder", lambda: tmp_path / "code")
    monkeypatch.setattr(node_work, "_known", NeverKnown())  # as in processes of their own
    (tmp_path / "code").mkdir()
    events = []

    def task():
        with compiled_once("a"):
            events.append("begins")
            time.sleep(0.1)
            events.append("ends")

    def eight_at_once():
        events.clear()
        threads = [threading.Thread(target=task) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert len(events) == 16

    eight_at_once()
    assert events[:2] == ["begins", "ends"]  # the others wait while the first one works
    eight_at_once()
    assert events[:2] == ["begins", "begins"]  # it is compiled: nobody waits


class NeverKnown(set):
    def __contains__(self, kind):
        return False


def test_a_node_with_other_code_does_nothing():
    job = job_of(spread_tasks.squared, {})
    assert work(job, "", 3, None) == 9
    with pytest.raises(node_work.OtherCode, match="install the same on all nodes"):
        work(job._replace(code="0"), "", 3, None)
