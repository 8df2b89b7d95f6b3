"""Rules, display and sounds of a page do what their twins in Python do, on a machine with all of them."""

from __future__ import annotations

import random
from base64 import b64decode
from collections.abc import Iterator

import numpy as np
import pytest

from browser import wait_until
from rule_tables import comet
from silverball.app.announcements import TableWords
from silverball.app.rule_words import RuleWords, Standing
from silverball.app.score_display import ScoreDisplay
from silverball.app.sound import instruments
from silverball.app.sound.moods import MoodReader
from silverball.app.sound.sound_sets import DEFAULT_SET
from silverball.app.sound.synth import RATE
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.replay.player import Playback
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase
from silverball.table import Table, load_table
from silverball.web.card_words import card_words
from web.conftest import write_game_page, write_replay_page
from web.test_game_page import PLAY
from web.test_replay_page import VERDICT

STEPS = 1500
DISPLAY = """(steps) => {
  const { display } = silverball.stage;
  silverball.isStopped = true;
  display.clear();
  return steps.map(([events, view, seconds, best, bonus]) => {
    display.add(events);
    if (bonus) display.countBonus(bonus);
    return btoa(String.fromCharCode(...display.draw(view, seconds, best).levels));
  });
}"""
MOODS = """([mode, beat]) => {
  const { page, stage, meta } = silverball, { follower } = page;
  const reader = new modules["moods.js"].MoodReader(meta.sounds.music.moods), moods = [];
  silverball.isStopped = true;
  follower.restart();
  while (!follower.isAtEnd) {
    follower.advance(beat);
    const mood = reader.read(follower.game, beat / stage.world.rate);
    moods.push(mood && [mood.level, mood.isLifted ? meta.sounds.music.lift : 0]);
  }
  return moods;
}"""
SHOTS = """([offers, standings]) => (
  standings.map((standing) => modules["card.js"].shotsOf(offers, standing).map(Object.values)))"""
BEAT = 8  # ticks


@pytest.fixture(scope="module")
def table() -> Table:
    return comet()


@pytest.fixture(scope="module")
def page(browser, table, tmp_path_factory):
    path = write_game_page(tmp_path_factory.mktemp("rules") / "comet.html", table)
    with browser.open(path) as found:
        yield found


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("players", [1, 3])
def test_the_rules_of_a_table_are_played(page, seed, players):
    replay = Replay.from_text(page.evaluate(PLAY, [60, seed, "arcade", players]))
    assert replay.players == players
    verdict = replay.verify()
    assert verdict.ok, verdict.message
    assert replay.score > 0


def match_of(table: Table, players: int) -> Replay:
    game = Game(table, 5, players=players)
    for tick in range(0, 240 * 90, 20):
        beat = tick // 20
        if not game.view.on_board and not game.is_over:
            game.create_ball()
        game.step(beat % 3 == 0, beat % 5 < 2, 20, launch=tick % 300 < 200)
    return game.replay


def test_a_match_is_watched(browser, table, tmp_path):
    replay = match_of(table, 2)
    seconds = len(replay.lines)
    playback = Playback(replay)
    playback.play(replay.ticks)
    assert playback.game.view.player == 2 or playback.game.is_over, "the machine was handed on"
    with browser.open(write_replay_page(tmp_path / "match.html", replay)) as page:
        wait_until(page, f"/ {seconds} of|^not/.test({VERDICT})", 60)
        assert page.evaluate(VERDICT) == f"same bits: {seconds} of {seconds} s"
        page.evaluate("silverball.page.seek(silverball.meta.replay.ticks)")
        assert tuple(page.evaluate("silverball.page.follower.game.match.scores")) == playback.game.scores


def steps_of_a_display(table: Table, rng: random.Random) -> Iterator[tuple]:
    """Random events and views, as no game would have them: every branch of the display is reached."""
    words, kinds = TableWords.of(table), list(GameEventKind)
    texts = sorted({text for rule in table.rule for text in (rule.message, rule.cue) if text})
    modes = [mode.name for mode in table.mode]
    view = GameView(Mode.ARCADE, Phase.READY, 0, 1, 3, 0, 0, 1, 0.0, 0, False, 3)
    assert words.messages
    for step in range(STEPS):
        seconds, events = 0.016 * step + 0.001 * rng.random(), []
        while rng.random() < 0.04:
            kind = rng.choice(kinds)
            of_mode = kind in (GameEventKind.MODE_STARTED, GameEventKind.MODE_ENDED)
            of_text = kind in (GameEventKind.MESSAGE, GameEventKind.CUE)
            part = rng.choice(modes) if of_mode else rng.choice(texts) if of_text else ""
            events.append(GameEvent(kind, 4 * step, rng.choice([0, 1, 3, 5, 10, 2500]), part))
        if rng.random() < 0.05:
            score = 0 if rng.random() < 0.05 else view.score + rng.choice([10, 1234, 1_000_000])
            view = view._replace(
                phase=rng.choice([*Phase, Phase.PLAY, Phase.PLAY]), score=score, on_board=rng.randrange(3),
                combo=rng.choice([0, 0, 4, 9]), multiplier=rng.choice([1, 2]),
                save_left=rng.choice([0.0, 1.0, 4.0]),
                tilted=rng.random() < 0.05, mode=rng.choice([Mode.ARCADE, Mode.ARCADE, Mode.FREE]),
                player=rng.choice([1, 2]), scores=rng.choice([(), (score, 5)]), balls=rng.choice([0, 3]),
            )  # fmt: skip
        yield (
            events,
            view,
            seconds,
            rng.choice([0, 500_000]) if step % 400 == 0 else 500_000,
            700 * (step % 300 == 299),
        )


def as_in_the_page(step: tuple) -> list:
    events, view, *rest = step
    said = [
        {"kind": one.kind.name, "tick": one.tick, "value": one.value, "text": one.part, "part": -1}
        for one in events
    ]
    shown = {
        "mode": view.mode, "phase": view.phase, "score": view.score, "ball": view.ball, "balls": view.balls,
        "onBoard": view.on_board, "combo": view.combo, "multiplier": view.multiplier,
        "saveLeft": view.save_left,
        "tilted": view.tilted, "maxBalls": view.max_balls, "player": view.player, "scores": list(view.scores),
    }  # fmt: skip
    return [said, shown, *rest]


@pytest.mark.parametrize("seed", range(3))
def test_the_score_display_lights_the_same_dots(page, table, seed):
    steps = list(steps_of_a_display(table, random.Random(seed)))
    frames = page.evaluate(DISPLAY, [as_in_the_page(step) for step in steps])
    display, wrong = ScoreDisplay(words=TableWords.of(table)), []
    for number, (events, view, seconds, best, bonus) in enumerate(steps):
        display.add_events(events)
        if bonus:
            display.count_bonus(bonus)
        if display.frame(view, seconds, best).pixels.tobytes() != b64decode(frames[number]):
            wrong.append(number)
    assert wrong == []
    assert len(set(frames)) > STEPS // 3


def test_the_music_has_the_mood_of_the_game(browser, table, tmp_path):
    replay = match_of(table, 1)
    playback, reader, moods = Playback(replay), MoodReader(table), []
    while playback.game.tick < replay.ticks:
        playback.play(min(BEAT, replay.ticks - playback.game.tick))
        moods.append(reader.read(playback.game, BEAT / replay.tick_rate))
    with browser.open(write_replay_page(tmp_path / "moods.html", replay)) as page:
        found = page.evaluate(MOODS, ["arcade", BEAT])
    assert found == [mood and list(mood) for mood in moods]
    assert len({mood and tuple(mood) for mood in moods}) > 2


@pytest.mark.parametrize("name", ["pad", "bass", "pluck", "lead"])
def test_a_note_is_that_of_the_window(page, name):
    timbre, pitch, seconds = getattr(DEFAULT_SET, name), 392.0, 0.4
    wave = page.evaluate(
        "([timbre, brightest, pitch, seconds, rate]) =>"
        " [...modules['music.js'].noteWave(timbre, brightest, pitch, seconds, rate)]",
        [timbre._asdict(), instruments.BRIGHTEST, pitch, seconds, RATE],
    )
    expected = instruments.sounded(timbre, pitch, seconds)
    assert len(wave) == len(expected)
    assert np.abs(np.array(wave) - expected).max() < 2e-3 * np.abs(expected).max()


def test_music_and_calls_are_heard(page):
    page.evaluate("silverball.isStopped = false")
    page.keyboard.press("Escape" if page.evaluate("silverball.page.menu.isOpen") else "r")
    page.keyboard.press("Space")
    wait_until(page, "silverball.stage.sounds.music?.isPlaying", 60)
    call = "silverball.stage.sounds.call"
    cue = page.evaluate("Object.keys(silverball.meta.sounds.calls.cues)[0]")
    page.evaluate("(text) => silverball.stage.sounds.announce([{ kind: 'CUE', text }])", cue)
    assert page.evaluate(f"{call}.rank") > 0
    wait_until(page, "silverball.stage.sounds.ducked < 0.9")
    page.keyboard.press("p")
    assert not page.evaluate("silverball.stage.sounds.music.isPlaying")


def test_a_shaken_phone_nudges(browser, game_file):
    shake = "(x) => dispatchEvent(new DeviceMotionEvent('devicemotion', { acceleration: { x, y: 1, z: 0 } }))"
    with browser.open(game_file, (390, 844), is_phone=True) as page:
        page.touchscreen.tap(195, 60)
        wait_until(page, "silverball.stage.world.balls().length === 1")
        for x in (1, 3, -20):
            page.evaluate(shake, x)
        page.wait_for_timeout(200)
        assert page.evaluate("silverball.page.game.toReplay()").count("!") == 1, "only a shake nudges"
        page.tap("#bar >> text=Menu")
        page.tap("button:has-text('Shaking nudges: on')")
        page.tap("button:has-text('Go on')")
        page.wait_for_timeout(400)
        page.evaluate(shake, 25)
        page.wait_for_timeout(100)
        assert page.evaluate("silverball.page.game.toReplay()").count("!") == 1


def random_standing(table: Table, dice: random.Random) -> Standing:
    running = [mode.name for mode in table.mode if dice.random() < 0.3]
    return Standing(
        {lamp.name: dice.choice(["off", "on", "blinking"]) for lamp in table.lamp},
        {counter.name: dice.randrange(6) for counter in table.counter},
        dict.fromkeys(running, 1.0),
    )


@pytest.mark.parametrize("ruled", [comet(), load_table("silver_comet")], ids=lambda table: table.name)
def test_the_card_names_what_the_window_names(page, ruled):
    dice = random.Random(5)
    standings = [random_standing(ruled, dice) for _ in range(300)]
    words = RuleWords(ruled)
    expected = [[list(shot) for shot in words.shots(standing)] for standing in standings]
    states = ["off", "on", "blinking"]
    asked = [
        {
            "lamps": [states.index(one.lamps[lamp.name]) for lamp in ruled.lamp],
            "counters": [one.counters[counter.name] for counter in ruled.counter],
            "isRunning": [mode.name in one.modes for mode in ruled.mode],
        }
        for one in standings
    ]
    offers = card_words(ruled, [Mode.ARCADE])["offers"]
    assert page.evaluate(SHOTS, [offers, asked]) == expected
    assert sum(map(len, expected)) > 100
