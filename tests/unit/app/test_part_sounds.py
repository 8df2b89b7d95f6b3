"""The tables of sounds: every finish, every kind of event and every mechanism has an entry, and no other."""

from __future__ import annotations

import pytest

from silverball.app.sound import part_sounds
from silverball.app.sound.bank import RECIPES
from silverball.physics.records import EventKind
from silverball.table.primitive import Finish, Primitive, Shape, Surface

CIRCLE = Primitive(Shape.CIRCLE, ((0.0, 0.0),), radius=0.5)


def test_every_finish_has_the_sound_of_a_hit():
    assert set(part_sounds.HITS) == set(Finish)


def test_every_kind_of_event_is_heard_or_silent_on_purpose():
    known = part_sounds.BLOWS | part_sounds.EVENTS.keys() | part_sounds.MECHANISMS.keys()
    assert known == {kind.name.lower() for kind in EventKind}


def test_every_sound_of_the_tables_is_in_the_bank():
    sounds = [*part_sounds.HITS.values(), part_sounds.BALL, part_sounds.KICK, part_sounds.DROP]
    sounds += [sound for sound in part_sounds.EVENTS.values() if sound is not None]
    sounds += [sound for by_finish in part_sounds.MECHANISMS.values() for sound in by_finish.values()]
    assert {sound.name for sound in sounds} <= RECIPES.keys()


@pytest.mark.parametrize("kind", [*part_sounds.EVENTS, *part_sounds.MECHANISMS])
@pytest.mark.parametrize("finish", [None, *Finish])
def test_no_event_of_any_part_fails(kind, finish):
    sound = part_sounds.event_sound(kind, finish)
    assert (sound is None) == (part_sounds.EVENTS.get(kind, sound) is None)


@pytest.mark.parametrize(
    ("primitive", "name"),
    [
        (CIRCLE._replace(finish=Finish.RUBBER), "rubber"),
        (CIRCLE._replace(finish=Finish.RUBBER, surface=Surface(kick=10.0)), "kick"),
        (CIRCLE._replace(finish=Finish.BUMPER, surface=Surface(kick=10.0)), "cylinder"),
        (CIRCLE._replace(finish=Finish.TARGET), "target"),
        (CIRCLE._replace(finish=Finish.TARGET, bank="left"), "drop"),
    ],
)
def test_a_coil_or_a_fall_is_heard_rather_than_the_material(primitive, name):
    assert part_sounds.blow_sound(primitive).name == name
