"""A user's program is checked by mypy against the public face."""

from __future__ import annotations

from mypy import api

PROGRAM = """
import numpy as np
import silverball as sb

table: sb.Table = sb.load_table("classic").replace(board={"gravity": 9.0})
world: sb.World = sb.World(table, seed=7)
ball: sb.BallState = world.create_ball()
world.step(left=True, ticks=24)
speeds: list[float] = [event.speed for event in world.events]
picture: "np.typing.NDArray[np.uint8]" = world.render(height=240)
batch = sb.WorldBatch(table, count=4)
moment: sb.Snapshot = batch.save(0)
game = sb.Game(table, seed=1, mode="arcade")
game.step(left=True)
replay: sb.Replay = game.replay
cylinder: sb.parts.Cylinder = sb.parts.Cylinder(center=(0.0, 0.0), radius=0.5)
"""
MISTAKES = """
import silverball as sb

sb.World("classic", sed=7)
sb.World("classic").step(left="yes")
sb.load_table(7)
sb.Flipper
"""


def check(tmp_path, program: str) -> tuple[str, int]:
    file = tmp_path / "program.py"
    file.write_text(program, encoding="utf-8")
    shown, _, code = api.run(["--strict", "--config-file=", f"--cache-dir={tmp_path / 'cache'}", str(file)])
    return shown, code


def test_a_correct_program_passes(tmp_path):
    shown, code = check(tmp_path, PROGRAM)
    assert code == 0, shown


def test_mistakes_are_found(tmp_path):
    shown, code = check(tmp_path, MISTAKES)
    assert code == 1
    for word in ("sed", "left", "load_table", "Flipper"):
        assert word in shown
