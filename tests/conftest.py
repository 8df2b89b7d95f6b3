"""What holds for all tests: hypothesis draws the same examples every time and has no deadline (the first
call compiles)."""

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
