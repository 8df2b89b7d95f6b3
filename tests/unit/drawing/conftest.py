"""Baked pictures of tests go to a folder of their own; the cache of the machine is not used."""

from __future__ import annotations

import pytest

from silverball.drawing.picture_cache import PictureCache


@pytest.fixture(scope="session")
def picture_cache(tmp_path_factory):
    """A store that all tests share, so that a table is baked once."""
    return PictureCache(tmp_path_factory.mktemp("pictures"))
