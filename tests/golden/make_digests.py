"""Write the golden digests again: `python tests/golden/make_digests.py`.

A digest is that of `World.digest`, taken with the version of the physics since which the scene gives these
bits, and with the layout of the record in that version. So raising the version keeps the digests of all
scenes whose bits it does not change.

A digest that differs means that the same table, seed and inputs now give other bits, so that replays
no longer hold: PHYSICS_VERSION must be raised. New scenes may be added at any time; digests of removed scenes
are dropped.
"""

from __future__ import annotations

import hashlib
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import tomli_w

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # run as a program, it finds its scenes there

from golden.layouts import record_bytes
from scenes import SCENES, played
from silverball.physics import PHYSICS_VERSION
from silverball.world import World

FILE = Path(__file__).with_name("digests.toml")
REMEDY = (
    "if this is meant, raise PHYSICS_VERSION and add a line to CHANGELOG's Physics section, "
    "then run  python tests/golden/make_digests.py"
)


class Golden(NamedTuple):
    """The version of the physics, the digest of every scene, and since which version it gives these bits."""

    physics_version: int
    digests: Mapping[str, str]
    since: Mapping[str, int] = MappingProxyType({})


def digest(world: World, since: int) -> str:
    """What `World.digest` says, or said in an earlier version of the physics."""
    return hashlib.sha256(since.to_bytes(8, "little") + record_bytes(world, since)).hexdigest()


def read(file: Path = FILE) -> Golden:
    """The golden digests; none yet where there is no file."""
    if not file.exists():
        return Golden(0, {})
    return Golden(**tomllib.loads(file.read_text(encoding="utf-8")))


def now(old: Golden) -> Golden:
    """The digests that this program gives; a scene whose bits are those of before keeps its version."""
    since, digests = {}, {}
    for name, world in {scene.name: played(scene) for scene in SCENES}.items():
        before = old.since.get(name, PHYSICS_VERSION)
        since[name] = before if digest(world, before) == old.digests.get(name) else PHYSICS_VERSION
        digests[name] = digest(world, since[name])
    return Golden(PHYSICS_VERSION, digests, since)


def changed(old: Golden, new: Golden) -> list[str]:
    """The scenes of both whose digests differ."""
    return [name for name in new.digests if old.digests.get(name, new.digests[name]) != new.digests[name]]


def renew(file: Path, new: Golden) -> str:
    """Write the digests into a file, unless they differ without a raised version.

    Returns:
        What was done, for a person to read.

    Raises:
        SystemExit: The version has not been raised; nothing is written.
    """
    old = read(file)
    differ = changed(old, new)
    if differ and new.physics_version <= old.physics_version:
        raise SystemExit(f"other digests at PHYSICS_VERSION {new.physics_version}: {differ}; {REMEDY}")
    file.write_text("# Written by make_digests.py\n" + tomli_w.dumps(new._asdict()), encoding="utf-8")
    added, gone = new.digests.keys() - old.digests.keys(), old.digests.keys() - new.digests.keys()
    return f"{file.name}: {len(differ)} changed, {len(added)} added, {len(gone)} gone"


if __name__ == "__main__":
    print(renew(FILE, now(read())))
