"""The same game still gives the bits that it gave when its digest was recorded."""

from __future__ import annotations

from collections import Counter

import pytest

from golden.make_digests import FILE, REMEDY, Golden, changed, digest, read, renew
from scenes import SCENES, Scene, played
from silverball.physics import PHYSICS_VERSION
from silverball.physics.records import WORLD

GOLDEN = read()


def test_the_golden_digests_are_those_of_these_scenes_and_this_version():
    assert GOLDEN.physics_version == PHYSICS_VERSION, REMEDY
    assert list(GOLDEN.digests) == list(GOLDEN.since) == [scene.name for scene in SCENES], REMEDY
    assert max(GOLDEN.since.values()) <= PHYSICS_VERSION


@pytest.fixture(scope="module")
def ends():
    """The world at the end of each scene."""
    return {scene.name: played(scene) for scene in SCENES}


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.name)
def test_a_scene_ends_in_its_golden_digest(scene: Scene, ends):
    world = ends[scene.name]
    assert digest(world, GOLDEN.since.get(scene.name, 0)) == GOLDEN.digests.get(scene.name), REMEDY
    assert digest(world, PHYSICS_VERSION) == world.digest()


def test_the_scenes_meet_everything_there_is_to_meet(ends):
    """A digest guards only what happens in its game."""
    counters = [name for name in WORLD.names if name.endswith("_hits")]
    counters += ["touches", "drained", "draws", "jams"]
    total = {name: sum(int(world.records[0][name]) for world in ends.values()) for name in counters}
    assert all(total.values()), total
    assert not any(world.fault for world in ends.values())


def test_the_scenes_of_devices_use_every_part(ends):
    used = Counter()
    for name in ("devices", "devices as in the window"):
        used.update(ends[name].hits)
    assert [part for part, count in used.items() if count == 0] == ["board.top"]  # behind the arch


OLD = Golden(3, {"a": "1", "b": "2"}, {"a": 2, "b": 3})


@pytest.mark.parametrize(
    ("new", "done"),
    [
        (Golden(3, {"a": "1", "b": "2"}, {"a": 2, "b": 3}), "0 changed, 0 added, 0 gone"),
        (Golden(3, {"a": "1", "b": "2", "c": "3"}, {"a": 2, "b": 3, "c": 3}), "0 changed, 1 added, 0 gone"),
        (Golden(3, {"a": "1"}, {"a": 2}), "0 changed, 0 added, 1 gone"),
        (Golden(4, {"a": "1", "b": "9"}, {"a": 2, "b": 4}), "1 changed, 0 added, 0 gone"),
    ],
)
def test_digests_are_written_again(tmp_path, new: Golden, done: str):
    file = tmp_path / FILE.name
    renew(file, OLD)
    assert renew(file, new).endswith(done)
    assert read(file) == new


@pytest.mark.parametrize("version", [2, 3])
def test_digests_that_differ_are_not_written_without_a_raised_version(tmp_path, version: int):
    file = tmp_path / FILE.name
    renew(file, OLD)
    new = Golden(version, {"a": "9", "b": "2", "c": "3"})
    assert changed(OLD, new) == ["a"]
    with pytest.raises(SystemExit, match="raise PHYSICS_VERSION"):
        renew(file, new)
    assert read(file) == OLD
