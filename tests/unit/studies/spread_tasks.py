"""Tasks for tests of work that is spread: a node imports them from here."""

from __future__ import annotations

import os
import time
from typing import Any

from silverball.errors import SilverballError
from silverball.players import make_player
from silverball.world import World


def squared(number: int) -> int:
    return number * number


def times(number: int, shared: Any) -> tuple[int, int]:
    time.sleep(0.05)
    return number * shared["factor"], os.getpid()


def refused(number: int) -> int:
    raise SilverballError(f"the table of {number} has a hole")


def broken(number: int) -> int:
    return number // 0


def fatal(number: int) -> int:
    os._exit(1)


def pressed_by(name: str) -> list[tuple[bool, bool]]:
    player, world = make_player(name, 3), World("classic", 1)
    return [player.press(world) for _ in range(2)]
