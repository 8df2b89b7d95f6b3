"""Runs a study: plays the chunks that are missing, one after the other, each on all cores."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from silverball.studies.chunk import Columns, run_chunk
from silverball.studies.result_folder import ResultFolder
from silverball.studies.study_plan import Chunk

Runner = Callable[[Iterable[Chunk]], Iterable[tuple[int, Columns]]]
"""Plays chunks and yields the number and the columns of each as it is done, in any order."""


def play_here(chunks: Iterable[Chunk]) -> Iterable[tuple[int, Columns]]:
    """Play chunks in this process, in their order."""
    for chunk in chunks:
        yield chunk.number, run_chunk(chunk)


def finish(
    folder: ResultFolder,
    runner: Runner = play_here,
    done: Callable[[int, Columns], None] | None = None,
) -> None:
    """Play all chunks of a study that are not done, and write each as soon as it is.

    Args:
        folder: Where the results are.
        runner: What plays the chunks.
        done: Called with the number and the columns of each chunk that was written.
    """
    for number, columns in runner(folder.missing()):
        folder.write(number, columns)
        if done is not None:
            done(number, columns)
    folder.sweep()
