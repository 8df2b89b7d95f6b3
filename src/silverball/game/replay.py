"""What is there for replays? To read and write them, to watch them, to verify them.

`Game.replay` is the recording of a game; `Replay.to_text` and `Replay.from_text` (or `load`) carry it from
program to program; `verify` plays it and says whether the same comes out; `ReplayPlayer` shows it.
"""

from __future__ import annotations

from silverball.game.replay_file import Replay
from silverball.game.replay_player import InputRefusedError, ReplayPlayer
from silverball.game.replay_record import Recorder
from silverball.game.replay_verify import Verdict, compare, verify

__all__ = ["InputRefusedError", "Recorder", "Replay", "ReplayPlayer", "Verdict", "compare", "verify"]
