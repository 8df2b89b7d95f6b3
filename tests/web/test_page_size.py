"""Pages as the command writes them are small enough to be sent: at most 1.5 MB, sounds included."""

from __future__ import annotations

import pytest

from silverball.drawing.themes import THEMES
from silverball.table import load_table
from silverball.web.page import PLAIN_HEIGHT, RICH_HEIGHT, default_height, game_page

LIMIT = 1_500_000  # bytes


@pytest.mark.parametrize(
    "name",
    [
        *(
            pytest.param(name, marks=pytest.mark.campaign)
            for name in ("classic", "random", "rolling", "parts")
        ),
        pytest.param("silver_comet", marks=pytest.mark.slow),
    ],
)
def test_a_page_is_small(name):
    assert len(game_page(load_table(name), 7, THEMES["neon"]).encode()) <= LIMIT


def test_a_table_with_lamps_or_levels_has_a_smaller_picture():
    assert default_height(load_table("classic")) == PLAIN_HEIGHT
    assert default_height(load_table("parts")) == RICH_HEIGHT
    assert default_height(load_table("silver_comet")) == RICH_HEIGHT
