"""A world in the shipped WebAssembly module, played by wasmtime: the other half of the tests of same bits."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from silverball.physics.records import LOG, PLAIN_WORLD
from silverball.web.module import PATH
from silverball.world import WorldBatch
from silverball.world.single_step import addresses_of

try:
    import wasmtime
except ModuleNotFoundError:
    wasmtime = None  # type: ignore[assignment]

MISSING = "" if wasmtime else "needs the package wasmtime, which is part of the extra `test`"
PAGE = 65536


@cache
def _module(path: Path) -> tuple[Any, Any]:
    engine = wasmtime.Engine()
    return engine, wasmtime.Module(engine, path.read_bytes())


class WasmMachine:
    """An instance of the module, with arrays of Python in its memory."""

    def __init__(self, path: Path = PATH) -> None:
        engine, module = _module(path)
        self.store = wasmtime.Store(engine)
        self.exports = wasmtime.Instance(self.store, module, []).exports(self.store)
        self.memory = self.exports["memory"]
        self.top = self.exports["heap"].value(self.store)

    def put(self, array: np.ndarray) -> int:
        """Copy an array; return its address."""
        data = np.ascontiguousarray(array).tobytes()
        at, self.top = self.top, self.top + (len(data) + 15) // 16 * 16
        missing = self.top - self.memory.data_len(self.store)
        if missing > 0:
            self.memory.grow(self.store, -(-missing // PAGE))
        self.memory.write(self.store, data, at)
        return at

    def take(self, at: int, size: int) -> bytes:
        return bytes(self.memory.read(self.store, at, at + size))

    def call(self, name: str, *arguments: float) -> Any:
        return self.exports[name](self.store, *arguments)


class WasmWorld:
    """The first world of a batch, copied into the module; nothing that it does shows in Python."""

    def __init__(self, batch: WorldBatch, path: Path = PATH) -> None:
        self.machine = machine = WasmMachine(path)
        boards = batch.boards
        self.layout = boards.layout
        self.suffix = "_plain" if self.layout == PLAIN_WORLD else ""
        named = {
            "world": batch.state[:1], "board": boards.board[:1], "collider": boards.collider,
            "grid": boards.grid, "log": batch.logs[:1], "tally": batch.tallies[:1],
        }  # fmt: skip
        self.at = {name: machine.put(array) for name, array in named.items()}
        self.place, self.places = machine.put(boards.place), boards.place.shape
        self.colliders, self.parts = len(boards.collider), batch.tallies.shape[1]
        row = np.zeros(1, addresses_of(self.layout))
        for name, at in self.at.items():
            row[name] = at
        row["colliders"], row["numbers"], row["parts"] = self.colliders, len(boards.grid), self.parts
        row["tick"] = 1.0 / batch.tick_rate
        self.addresses = machine.put(row)

    def create_ball(self) -> bool:
        at = self.at
        return (
            self.machine.call(
                f"create_ball{self.suffix}", at["world"], at["board"], at["collider"], self.colliders,
                self.place, *self.places, at["log"],
            )
            == 0
        )  # fmt: skip

    def step(self, buttons: int, ticks: int) -> int:
        return int(self.machine.call(f"step{self.suffix}", self.addresses, 1, buttons, ticks))

    @property
    def state(self) -> bytes:
        return self.machine.take(self.at["world"], self.layout.itemsize)

    @property
    def tallies(self) -> bytes:
        return self.machine.take(self.at["tally"], 8 * self.parts)

    @property
    def events(self) -> bytes:
        return events_of(np.frombuffer(self.machine.take(self.at["log"], LOG.itemsize), LOG)[0])


def events_of(log: Any) -> bytes:
    """The events of the last step in a log, and how many were lost."""
    return bytes(log["event"][: log["count"]].tobytes()) + int(log["lost"]).to_bytes(8, "little")
