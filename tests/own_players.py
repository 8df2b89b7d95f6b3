"""Players of one's own: a simple one, and distributions that bring one."""

from __future__ import annotations

from pathlib import Path

from silverball.players.registry import ENTRY_POINT_GROUP
from silverball.world import World

LEFTY = """
class Lefty:
    def press(self, world):
        return world.tick % 2 == 0, False
"""


class Swatter:
    """Lifts a paddle while a ball is low on its side; counts its decisions."""

    def __init__(self) -> None:
        self.decisions = 0

    def press(self, world: World) -> tuple[bool, bool]:
        self.decisions += 1
        low = [ball.position[2] for ball in world.balls if ball.position[0] < -6.0]
        return any(z < 0.0 for z in low), any(z >= 0.0 for z in low)


def install(folder: Path, name: str, entries: str, module: str) -> None:
    """Put a distribution into a folder as `pip` does: a module and a .dist-info."""
    module_name = name.replace("-", "_")
    (folder / f"{module_name}.py").write_text(module)
    info = folder / f"{module_name}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[{ENTRY_POINT_GROUP}]\n{entries}\n")
