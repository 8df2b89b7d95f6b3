"""The engines of the comparison, their steppings, and whether they are installed."""

from __future__ import annotations

import platform
from importlib import import_module, metadata, util
from typing import NamedTuple

from silverball.benchmarks.peers.playfield import Playfield, Stepping
from silverball.errors import SilverballError
from silverball.table import Table

EXTRA = "bench"
MEDIUM = 4  # steps per frame, of 1/240 s
FINE = 17  # steps per frame, of 1/1020 s


class Engine(NamedTuple):
    """An engine to compare with.

    Attributes:
        name: Name in the report.
        package: Name of its package for pip.
        imported: Name of the Python module to import.
        module: Our module that builds a table in it.
        playfield: Name of the class in that module.
        substeps: Substeps per step, where the engine takes them as an argument.
    """

    name: str
    package: str
    imported: str
    module: str
    playfield: str
    substeps: int = 1

    @property
    def is_installed(self) -> bool:
        """Whether its Python module can be imported."""
        return util.find_spec(self.imported) is not None

    @property
    def install_hint(self) -> str:
        """How to install the missing package."""
        return f"{self.package} is not installed: pip install 'silverball[{EXTRA}]'"

    def entries(self) -> list[Entry]:
        """This engine with its recommended stepping, at 1/240 s and at 1/1020 s."""
        recommended: Stepping = import_module(self.module).RECOMMENDED
        finer = [Stepping(steps, self.substeps) for steps in (MEDIUM, FINE)]
        return [Entry(self.name, stepping, self.module, self.playfield) for stepping in (recommended, *finer)]


class Entry(NamedTuple):
    """An engine with a stepping: a row of the report."""

    name: str
    stepping: Stepping
    module: str
    playfield: str

    def build(self, table: Table) -> Playfield:
        """Build a table in this engine."""
        playfield: Playfield = getattr(import_module(self.module), self.playfield)(table, self.stepping)
        return playfield


_PACKAGE = "silverball.benchmarks.peers"
PEERS = (
    Engine("pymunk", "pymunk", "pymunk", f"{_PACKAGE}.pymunk_table", "PymunkPlayfield"),
    Engine("Box2D v3", "pyb2d3", "pyb2d3", f"{_PACKAGE}.box2d_v3_table", "Box2DV3Playfield", 4),
    Engine("Box2D 2.3", "box2d", "Box2D", f"{_PACKAGE}.box2d_v2_table", "Box2DV2Playfield"),
)
SILVERBALL = "Silverball, one world"
BATCH = "Silverball, a batch"
OWN = tuple(
    Entry(SILVERBALL, Stepping(steps), f"{_PACKAGE}.silverball_table", "SilverballPlayfield")
    for steps in (1, MEDIUM)
)


def installed_peers() -> list[Engine]:
    """The peers that are installed.

    Raises:
        SilverballError: No peer is installed, or mpmath is missing, which the reference needs.
    """
    found = [engine for engine in PEERS if engine.is_installed]
    if not found:
        raise SilverballError(*(engine.install_hint for engine in PEERS))
    if util.find_spec("mpmath") is None:
        raise SilverballError(f"mpmath is not installed: pip install 'silverball[{EXTRA}]'")
    return found


def versions(engines: list[Engine]) -> dict[str, str]:
    """Versions of Python and of all packages in the comparison."""
    packages = ["silverball", "numba", "numpy", *(engine.package for engine in engines)]
    return {"Python": platform.python_version(), **{name: metadata.version(name) for name in packages}}
