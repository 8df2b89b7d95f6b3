"""Plays the chunks of studies and the rounds of soaks on a Ray cluster, one core each, with the same bits."""

from __future__ import annotations

import itertools
from collections.abc import Generator, Iterable, Iterator

from silverball.soak.campaign import Played, RoundSource
from silverball.soak.rounds import Options, play_round
from silverball.studies.chunk import Columns, run_chunk
from silverball.studies.run import Runner
from silverball.studies.spread import Task, spread
from silverball.studies.study_plan import Chunk
from silverball.table import Table, table_digest


def ray_runner(address: str, players: Iterable[str]) -> Runner:
    """What plays chunks on a cluster.

    Args:
        address: "local", "auto", "HOST:PORT" or "ray://HOST:PORT".
        players: The players of all chunks; registered ones travel along.

    Examples:
        >>> from silverball.studies.run import finish
        >>> finish(folder, ray_runner("local", ["reflex"]))  # doctest: +SKIP
    """
    names = tuple(dict.fromkeys(players))

    def play(chunks: Iterable[Chunk]) -> Iterator[tuple[int, Columns]]:
        for task, columns in spread(play_chunk, tasks_of(chunks), address, names):
            yield task.number, columns

    return play


def tasks_of(chunks: Iterable[Chunk]) -> Iterator[Task]:
    """The chunks as tasks; chunks of one table share it."""
    tables: dict[int, tuple[Table, str]] = {}  # by identity: the table, kept alive, and its digest
    for chunk in chunks:
        table, digest = _known(tables, chunk.table)
        yield Task(chunk.number, chunk._replace(table=EMPTY), table, f"{digest} {chunk.player}")


def _known(tables: dict[int, tuple[Table, str]], table: Table) -> tuple[Table, str]:
    if id(table) not in tables:
        tables[id(table)] = table, table_digest(table)
    return tables[id(table)]


def play_chunk(chunk: Chunk, table: Table) -> Columns:
    """Play a chunk on one core."""
    return run_chunk(chunk._replace(table=table), threads=1)


def soak_rounds(address: str) -> RoundSource:
    """What plays the rounds of a soak on a cluster; a few that are begun at the end are not needed.

    Args:
        address: As for `ray_runner`.
    """

    def play(options: Options, first: int) -> Generator[Played]:
        tasks = (Task(number, number, options, "soak") for number in itertools.count(first))
        for _, played in spread(play_soak_round, tasks, address, in_order=True):
            yield played

    return play


def play_soak_round(number: int, options: Options) -> Played:
    """Play a round of a soak on one core."""
    return play_round(options, number, threads=1)


EMPTY = Table()
"""Stands for the table of a chunk while it travels."""
