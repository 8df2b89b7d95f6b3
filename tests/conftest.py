"""Settings of all tests: hypothesis profile, number of processes, and order of the files.

Hypothesis draws the same examples in every run and has no deadline, because the first call compiles.
"""

from __future__ import annotations

import os
import sys

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "silverball",
    derandomize=True,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
settings.load_profile("silverball")


@pytest.fixture
def unregistered():
    """No registered players but those of the test."""
    from silverball.players.registry import _refused, _registered

    for names in (_registered, _refused):
        names.clear()
    yield
    for names in (_registered, _refused):
        names.clear()


@pytest.fixture
def site(tmp_path, monkeypatch, unregistered):
    """A folder on sys.path for installed packages."""
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    yield folder
    imported = {name for name, one in sys.modules.items() if str(folder) in str(getattr(one, "__file__", ""))}
    for name in imported:
        del sys.modules[name]


SLOW_FILES = (  # those that take longest; they come first, or one of them would run alone at the end
    "unit/table/test_table_mutations.py",
    "unit/world/test_determinism.py",
    "unit/game/test_forged_rules.py",
    "window/test_real_window.py",
    "property/test_forged_states.py",
    "cli/test_play_demo_show.py",
    "cli/test_forged_scores.py",
    "cli/test_streams.py",
    "property/test_nothing_inside.py",
    "unit/game/test_store_held.py",
    "unit/table/test_table_check.py",
    "unit/table/test_table_generate.py",
    "unit/table/test_table_bad_keys.py",
)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int | None:
    """One process more than cores: a fifth of the time goes into waiting for windows, files and programs."""
    if "PYTEST_XDIST_AUTO_NUM_WORKERS" in os.environ:
        return None
    return len(os.sched_getaffinity(0)) + 1 if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1) + 1


def pytest_configure(config: pytest.Config) -> None:
    """Keep the order of the files; newer xdist would sort them by their number of tests."""
    if hasattr(config.option, "loadscopereorder"):
        config.option.loadscopereorder = False


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sort the slowest files to the front."""
    rank = {name: number for number, name in enumerate(SLOW_FILES)}
    root = os.path.dirname(__file__)
    items.sort(key=lambda item: rank.get(os.path.relpath(item.path, root).replace(os.sep, "/"), len(rank)))
