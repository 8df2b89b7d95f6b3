"""Play an arcade game, save its replay, and verify the file."""

import tempfile
from pathlib import Path

import silverball as sb

game = sb.Game("classic", seed=7)
while not game.is_over:
    if game.phase is sb.Phase.READY:
        game.create_ball()
    game.step(left=game.tick % 480 < 240, right=game.tick % 480 >= 240, ticks=24)
    for event in game.events:
        if event.kind is sb.GameEventKind.BALL_LOST:
            print(f"{event.tick / game.tick_rate:.1f} s: ball {event.value} lost, score {game.score}")

path = Path(tempfile.mkdtemp()) / "game.replay"
game.replay.save(path)
verdict = sb.Replay.load(path).verify()
print(f"{path}: {verdict.message}")
assert verdict.ok
