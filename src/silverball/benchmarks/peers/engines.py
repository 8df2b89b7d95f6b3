"""Which engines take part, with which stepping, and what is missing here?"""

from __future__ import annotations

import platform
from importlib import import_module, metadata, util
from typing import NamedTuple

from silverball.benchmarks.peers.engine import Playfield, Stepping
from silverball.errors import SilverballError
from silverball.table import Table

EXTRA = "bench"
EVERY = 4  # steps a frame at 1/240 s
FINE = 17  # steps a frame at 1/1020 s


class Engine(NamedTuple):
    """A peer.

    Attributes:
        name: What people call it.
        package: Its name for pip.
        imported: Its name in Python.
        module: The module here that builds the table in it.
        playfield: The class there.
        substeps: Of each step, where the engine can be told.
    """

    name: str
    package: str
    imported: str
    module: str
    playfield: str
    substeps: int = 1

    @property
    def is_installed(self) -> bool:
        """Whether it can be imported."""
        return util.find_spec(self.imported) is not None

    @property
    def missing(self) -> str:
        """What to say and to do where it is not installed."""
        return f"{self.package} is not installed: pip install 'silverball[{EXTRA}]'"

    def entries(self) -> list[Entry]:
        """This engine with the stepping that it recommends, at 1/240 s and at 1/1020 s."""
        recommended: Stepping = import_module(self.module).RECOMMENDED
        finer = [Stepping(steps, self.substeps) for steps in (EVERY, FINE)]
        return [Entry(self.name, stepping, self.module, self.playfield) for stepping in (recommended, *finer)]


class Entry(NamedTuple):
    """An engine with a stepping: a row of the report."""

    name: str
    stepping: Stepping
    module: str
    playfield: str

    def build(self, table: Table) -> Playfield:
        """The table in this engine."""
        made: Playfield = getattr(import_module(self.module), self.playfield)(table, self.stepping)
        return made


_HERE = "silverball.benchmarks.peers"
PEERS = (
    Engine("pymunk", "pymunk", "pymunk", f"{_HERE}.pymunk_table", "PymunkPlayfield"),
    Engine("Box2D v3", "pyb2d3", "pyb2d3", f"{_HERE}.box2d_v3_table", "Box2DV3Playfield", 4),
    Engine("Box2D 2.3", "box2d", "Box2D", f"{_HERE}.box2d_v2_table", "Box2DV2Playfield"),
)
SILVERBALL = "Silverball, one world"
BATCH = "Silverball, a batch"
OWN = tuple(
    Entry(SILVERBALL, Stepping(steps), f"{_HERE}.silverball_table", "SilverballPlayfield")
    for steps in (1, EVERY)
)


def present_peers() -> list[Engine]:
    """The peers that are installed.

    Raises:
        SilverballError: None is, or what the reference needs is missing.
    """
    found = [engine for engine in PEERS if engine.is_installed]
    if not found:
        raise SilverballError(*(engine.missing for engine in PEERS))
    if util.find_spec("mpmath") is None:
        raise SilverballError(f"mpmath is not installed: pip install 'silverball[{EXTRA}]'")
    return found


def versions(engines: list[Engine]) -> dict[str, str]:
    """Versions of all that takes part."""
    packages = ["silverball", "numba", "numpy", *(engine.package for engine in engines)]
    return {"Python": platform.python_version(), **{name: metadata.version(name) for name in packages}}
