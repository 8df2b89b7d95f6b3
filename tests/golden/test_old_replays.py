"""Replays that were recorded with version 3 of the physics play on, and every second of them is as it was."""

from __future__ import annotations

from pathlib import Path

import pytest

from silverball.errors import StateError
from silverball.game.replay.format import Replay
from silverball.game.replay.reader import checksum

FILES = sorted(Path(__file__).parent.glob("physics_3_*.txt"))


def changed(text: str, old: str, new: str) -> str:
    """A replay with another line, and the checksum that belongs to it."""
    assert text.count(old) == 1
    body = text.replace(old, new).rpartition("checksum = ")[0]
    return f"{body}checksum = {checksum(body)}\n"


@pytest.fixture(params=FILES, ids=lambda path: path.stem)
def text(request) -> str:
    return request.param.read_text(encoding="utf-8")


def test_a_replay_of_physics_3_is_verified_and_written_as_it_was(text):
    replay = Replay.from_text(text)
    assert replay.physics == 3
    assert replay.verify().message == f"equal in all {replay.ticks} ticks (25.0 s), score {replay.score}"
    assert replay.to_text().partition("\n--- table")[2].partition("checksum")[0] in text


def test_a_replay_of_physics_3_that_was_changed_is_found_out(text):
    score = Replay.from_text(text).score
    verdict = Replay.from_text(changed(text, f"\nscore = {score}\n", f"\nscore = {score + 10}\n")).verify()
    assert not verdict.ok
    assert verdict.field == "score"


def test_physics_3_has_no_tables_of_format_2(text):
    with pytest.raises(StateError, match=r"format 1|not the table that was played"):
        Replay.from_text(changed(text, "\nformat = 1\n", "\nformat = 2\n"))
