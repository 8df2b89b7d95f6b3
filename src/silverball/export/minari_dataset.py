"""Data sets in Minari's format: episodes of a player, written as a whole or not at all.

The data set is written under a hidden name in the same folder, which Minari does not list, and renamed in one
step. What a killed process has left there is removed by the next one that writes a data set of that name.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import re
import shutil
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from silverball.envs.rewards import import_path
from silverball.errors import MissingExtra, OutputError
from silverball.export.episodes import Recorded, Recording
from silverball.physics import PHYSICS_VERSION
from silverball.table import Table, dump_table

NAME = re.compile(r"(?:[A-Za-z0-9_][\w-]*/)*[A-Za-z0-9_][\w-]*-v\d+", re.ASCII)
EPISODES_AT_ONCE = 16  # that are handed to Minari in one call, which opens its file anew


def require_minari() -> None:
    """Check that Minari and the reader of its files are installed.

    Raises:
        MissingExtra: One is not.
    """
    try:
        import h5py  # noqa: F401
        import minari  # noqa: F401
    except ImportError:
        raise MissingExtra("writing a data set for Minari", "minari") from None


def checked_place(name: str, folder: Path | None, *, force: bool = False) -> Path:
    """The folder of a data set, before a minute of work is lost.

    Args:
        name: Its name in Minari: ``silverball/PinballClassic-v0/reflex-v0``.
        folder: Minari's folder; None: the one that Minari itself uses.
        force: Whether a data set of that name may be replaced.

    Raises:
        OutputError: The name is malformed, or there is something already.
        MissingExtra: Minari is not installed.
    """
    require_minari()
    from minari.storage.datasets_root_dir import get_dataset_path

    if not NAME.fullmatch(name):
        raise OutputError(
            "a data set's name must be letters, digits, _ and -, with a version, in folders or not, like "
            f"silverball/PinballClassic-v0/reflex-v0, got {name!r}"
        )
    try:
        place = Path(get_dataset_path(name) if folder is None else folder / name)
    except OSError as error:
        raise OutputError(f"the folder of Minari cannot be used ({error.strerror or error})") from None
    if place.exists() and not (place / "data" / "metadata.json").is_file():
        raise OutputError(f"{place}: there is something else than a data set; choose another name")
    if place.exists() and not force:
        raise OutputError(f"{place}: this data set exists; choose another name, or replace it with --force")
    return place


def write_dataset(
    recording: Recording,
    count: int,
    name: str,
    place: Path,
    command: str,
    *,
    with_infos: bool = False,
    progress: Callable[[int], None] | None = None,
) -> str:
    """Record episodes and write them as one data set.

    Args:
        recording: What to record.
        count: Episodes.
        name: The name of the data set in Minari.
        place: Its folder, from `checked_place`; a data set there is replaced at the end.
        command: What makes it again, for its metadata.
        with_infos: Whether the counts of events are written too.
        progress: Called with the episodes written so far.

    Returns:
        The digest of the data, which is in the metadata too.

    Raises:
        OutputError: It cannot be written, or another process is writing it.
    """
    require_minari()
    from minari import MinariDataset
    from minari.dataset.minari_storage import MinariStorage

    with _hidden_folder(place) as hidden:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about what a data set may say and this one does not
            data = hidden / "data"
            storage = MinariStorage.new(
                data, recording.observation_space, recording.action_space, recording.spec, "hdf5",
                jpeg_encoding=False,
            )  # fmt: skip
        digest = hashlib.sha256()
        buffers: list[Any] = []
        for done, episode in enumerate(recording.episodes(count), 1):
            episode.add_to(digest)
            buffers.append(_buffer(episode, with_infos))
            if len(buffers) == EPISODES_AT_ONCE or done == count:
                storage.update_episodes(buffers)
                buffers = []
            if progress is not None:
                progress(done)
        storage.update_metadata(_metadata(recording, name, command, digest.hexdigest()))
        MinariDataset(data)  # reads what it needs
        _put_in_place(hidden, place)
    return digest.hexdigest()


def _buffer(episode: Recorded, with_infos: bool) -> Any:
    """An episode as Minari takes it."""
    from minari.data_collector import EpisodeBuffer

    return EpisodeBuffer(
        seed=episode.seed,
        observations=episode.observations,
        actions=episode.actions,
        rewards=episode.rewards,
        terminations=episode.terminated,
        truncations=episode.truncated,
        infos=dict(episode.counts) if with_infos else {},
    )


def _metadata(recording: Recording, name: str, command: str, digest: str) -> dict[str, Any]:
    """What the data set says about itself."""
    import minari

    from silverball import __version__

    described = {key: _as_json(value) for key, value in recording.options.items()}
    return {
        "dataset_id": name,
        "minari_version": minari.__version__,
        "algorithm_name": recording.player,
        "description": f"Episodes of the player {recording.player} in {recording.id}, made by: {command}",
        "requirements": [f"silverball=={__version__}"],
        "silverball": {
            "command": command,
            "environment": recording.id,
            "options": described,
            "player": recording.player,
            "seed": recording.seed,
            "version": __version__,
            "physics": PHYSICS_VERSION,
            "tables": list(recording.table_digests),
            "digest": digest,
        },
    }


def _as_json(value: Any) -> Any:
    """An option as JSON can hold it."""
    if isinstance(value, Table):
        return dump_table(value)
    if callable(value):
        return import_path(value) or repr(value)
    try:
        json.dumps(value)
    except TypeError:
        return str(value)
    return value


@contextmanager
def _hidden_folder(place: Path) -> Iterator[Path]:
    """An empty folder beside the place, which only this process has; it is removed at the end.

    Raises:
        OutputError: Another process has it, or it cannot be written.
    """
    hidden = place.with_name(f".{place.name}.unfinished")
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        hidden.mkdir(exist_ok=True)
        lock = os.open(hidden, os.O_RDONLY)
    except OSError as error:
        raise _unwritable(place, error) from None
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise OutputError(f"{place}: another process is writing this data set; wait for it") from None
        try:
            _empty(hidden)
            yield hidden
        except OSError as error:
            raise _unwritable(place, error) from None
        finally:
            shutil.rmtree(hidden, ignore_errors=True)
    finally:
        os.close(lock)


def _empty(folder: Path) -> None:
    for entry in folder.iterdir():
        shutil.rmtree(entry) if entry.is_dir() else entry.unlink()


def _put_in_place(hidden: Path, place: Path) -> None:
    """Give the finished folder its name; a data set that has the name is removed afterwards."""
    for file in (hidden / "data").iterdir():
        with open(file, "rb+") as written:
            os.fsync(written.fileno())
    if not place.exists():
        os.rename(hidden, place)
        return
    old = place.with_name(f".{place.name}.replaced")
    shutil.rmtree(old, ignore_errors=True)
    os.rename(place, old)
    os.rename(hidden, place)
    shutil.rmtree(old, ignore_errors=True)


def _unwritable(place: Path, error: OSError) -> OutputError:
    return OutputError(
        f"{place}: the data set cannot be written ({error.strerror or error}); nothing is left of it"
    )
