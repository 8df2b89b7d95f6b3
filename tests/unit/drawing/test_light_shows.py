"""Light shows: functions of their time and the lamps' places, begun by events of a game."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from boards import CLASSIC
from silverball.drawing import Moment
from silverball.drawing.effects import Effects
from silverball.drawing.lamp_levels import Lamps
from silverball.drawing.layout import Layout
from silverball.drawing.light_shows import (
    EVENT_SHOWS,
    FOREVER,
    SHOWS,
    Order,
    Running,
    places_of,
    show_levels,
    shown_share,
)
from silverball.game.view import GameEvent, GameEventKind
from silverball.table.rulebook import Lamp
from silverball.world import Event

RATE = 240
LAMPS = [
    Lamp(name=f"{row} {column}", center=(2.0 * row - 7.0, 2.0 * column - 3.0))
    for row in range(8)
    for column in range(4)
]
LAYOUT = Layout.of(CLASSIC.replace(format=2, lamp=LAMPS))
PLACES = places_of(LAYOUT)
STEP = 1.0 / 120.0
WATCHED = 21.0  # [s] longer than any show, and than attract mode's before it repeats


def course(name):
    """The levels of all lamps during a show, [time, lamp]."""
    show = SHOWS[name]
    return np.array(
        [show_levels(show, age, PLACES) for age in np.arange(0.0, min(show.seconds, WATCHED), STEP)]
    )


def cue(name, tick):
    return GameEvent(GameEventKind.CUE, tick, 0, name)


@pytest.mark.parametrize("name", SHOWS)
def test_a_show_stays_in_its_bounds_and_lights_every_lamp(name):
    levels = course(name)
    assert levels.min() >= 0.0
    assert levels.max() <= 1.0
    assert (levels.max(axis=0) > 0.5).all()


@pytest.mark.parametrize("name", SHOWS)
def test_no_show_flashes_the_table_more_than_three_times_a_second(name):
    mean = course(name).mean(axis=1)
    is_bright = mean > 0.5
    rises = np.flatnonzero(is_bright[1:] & ~is_bright[:-1]) * STEP
    assert all(((rises >= start) & (rises < start + 1.0)).sum() <= 3 for start in rises)


def test_attract_mode_never_ends_and_a_tilt_is_dark():
    attract, tilt = SHOWS["attract"], SHOWS["tilt"]
    for age in (0.7, 5.1, 12.0):
        again = age + 20.0 * 500
        assert show_levels(attract, age, PLACES) == pytest.approx(
            show_levels(attract, again, PLACES), abs=1e-6
        )
    assert all(shown_share(show, 1e6) == 1.0 for show in (attract, tilt))
    assert show_levels(tilt, 0.2, PLACES).max() > 0.5
    assert all(show_levels(tilt, age, PLACES).max() == 0.0 for age in (0.6, 3.0, 100.0))
    assert [name for name, show in SHOWS.items() if show.seconds == FOREVER] == ["attract", "tilt"]


def test_a_wave_goes_in_its_order():
    levels = show_levels(SHOWS["ball start"], 0.25, PLACES).reshape(8, 4)
    assert levels[:3].max() > 0.0
    assert levels[5:].max() == 0.0
    late = show_levels(SHOWS["end of ball"], 0.25, PLACES).reshape(8, 4)
    assert late[:5].max() == 0.0
    assert late[5:].max() > 0.0
    assert PLACES[Order.OUT].reshape(8, 4)[3:5, 1:3].max() < PLACES[Order.OUT].reshape(8, 4)[[0, -1]].min()


def test_a_show_hides_the_games_own_lamps_and_gives_them_back():
    lamps, effects = Lamps(LAYOUT), Effects()
    on = Moment.before(CLASSIC)._replace(lamps=(1,) * len(LAMPS))
    for age, share in ((0.0, 0.0), (1.999999, 1.0)):
        levels = lamps.levels(on._replace(show=Running("jackpot", age)), effects)
        assert levels == pytest.approx(share, abs=1e-3)
    calm = Effects(is_full=False)
    assert lamps.levels(on._replace(show=Running("jackpot", 0.6)), calm).max() <= 0.4
    assert lamps.levels(on._replace(show=Running("lock", 0.6)), calm).min() == 1.0
    assert lamps.levels(on._replace(show=Running("unheard of", 0.6)), effects).min() == 1.0


def test_cues_and_events_begin_shows_by_rank():
    effects = Effects()
    effects.add_game_events([cue("jackpot", 240), cue("lit shot", 250), cue("no show", 260)], RATE)
    assert effects.show(1.5) == Running("jackpot", 0.5)
    assert effects.show(1.0 + SHOWS["jackpot"].seconds) is None
    effects.add_game_events([cue("super jackpot", 300)], RATE)
    assert effects.show(1.5) == Running("super jackpot", 0.25)
    effects.add_game_events([cue("lit shot", 300 + 5 * 240)], RATE)  # when that is over
    assert effects.show(6.3).name == "lit shot"
    effects.clear()
    assert effects.show(6.3) is None


def test_a_tilt_stays_dark_until_the_ball_is_over_and_the_next_one_begins():
    effects = Effects()
    effects.add_game_events([GameEvent(GameEventKind.BALL_READY, 0, 1)], RATE)
    assert effects.show(0.0) is None  # nothing has ended
    created = Event("created", "", 1, 100, 0.0, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0), 0.0)
    effects.add_events([created], RATE)
    assert effects.show(0.5).name == "ball start"
    effects.add_game_events([GameEvent(GameEventKind.TILT, 480), cue("super jackpot", 500)], RATE)
    effects.add_events([created._replace(tick=600)], RATE)  # another ball of the same turn
    assert effects.show(20.0) == Running("tilt", 18.0)
    effects.add_game_events([GameEvent(GameEventKind.BALL_READY, 4800, 2)], RATE)
    assert effects.show(20.0) == Running("end of ball", 0.0)
    effects.add_events([created._replace(tick=4900)], RATE)
    assert effects.show(20.5).name == "ball start"


def test_a_show_of_a_later_time_is_forgotten_when_the_game_is_set_back():
    effects = Effects()
    effects.add_game_events([cue("jackpot", 2400)], RATE)
    assert effects.show(10.1) is not None
    assert effects.show(5.0) is None


def test_every_event_has_a_show_that_exists():
    assert set(EVENT_SHOWS.values()) <= set(SHOWS)


def test_the_page_lists_all_shows():
    page = (Path(__file__).parents[3] / "docs" / "look.md").read_text(encoding="utf-8")
    listed = [line.split("`")[1] for line in page.splitlines() if line.startswith("| `")]
    assert sorted(name for name in listed if name in SHOWS) == sorted(SHOWS)
