"""The program without a window: buttons and time."""

from __future__ import annotations

import pytest

from evenings import NOTHING, Evening
from reading import reads
from silverball.app.command_handlers import watch_replay_text
from silverball.app.controls import Action
from silverball.app.machine import SPEEDS
from silverball.app.player_games import GAME_OVER_SECONDS
from silverball.app.sessions import DemoSession
from silverball.app.settings import Settings
from silverball.app.startup import Progress
from silverball.errors import TableError
from silverball.game.replay.format import Replay
from silverball.game.replay.verify import verify
from silverball.game.view import Mode, Phase


@pytest.fixture
def evening(tmp_path):
    made = Evening(tmp_path)
    made.program.finish_loading()
    yield made
    made.store.close()


def test_a_score_is_kept_before_anything_of_it_is_shown(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.play_to_the_end()
    score = evening.program.session.game.score
    assert score > 0
    assert evening.program.menus.page == ""
    assert [row.score for row in evening.store.scores()] == [score]
    evening.go(GAME_OVER_SECONDS + 0.1)
    assert evening.program.menus.page == "initials"
    (row,) = evening.store.scores()
    verdict = verify(Replay.from_text(evening.store.replay(row.id)))
    assert (verdict.ok, verdict.score) == (True, score)


def test_what_is_asked_for_before_the_physics_is_ready_is_done_when_it_is(tmp_path):
    evening = Evening(tmp_path)
    evening.program.play(Mode.FREE, "Leaky", 3)
    assert evening.program.session is None
    assert "one moment" in evening.said[-1]
    evening.tap(Action.CREATE, Action.LEFT, Action.PAUSE)  # impatience changes nothing
    assert not evening.program.menus.is_open
    evening.program.finish_loading()
    assert evening.program.is_playing
    evening.store.close()


def test_before_the_physics_is_ready_the_display_is_never_empty_and_tells_the_time(tmp_path):
    evening = Evening(tmp_path)
    program = evening.program
    assert reads(program.dots(0.0), "SILVERBALL")
    program.progress = Progress(4.0, 0.2)
    assert reads(program.dots(0.0), "COMPILING 4/20 S")
    evening.tap(Action.CREATE)  # PLAY
    assert not program.menus.is_open
    assert reads(program.dots(0.0), "4/20 S")
    program.progress = None
    assert program.dots(0.0).pixels.any()
    program.finish_loading()
    assert program.is_playing
    assert not reads(program.dots(0.0), "4/20 S")
    evening.store.close()


def test_who_goes_back_before_the_physics_is_ready_is_in_the_menu_and_no_game_begins(tmp_path):
    evening = Evening(tmp_path)
    evening.tap(Action.CREATE)
    evening.tap(Action.BACK)
    assert evening.program.menus.page == "main"
    evening.program.finish_loading()
    assert evening.program.session is None
    assert evening.program.menus.page == "main"
    evening.store.close()


def test_a_game_on_a_table_whose_code_is_not_loaded_waits_for_it_and_the_one_before_is_kept(tmp_path):
    """Compiling it at once would freeze the window for half a minute."""
    evening = Evening(tmp_path)
    program = evening.program
    program.finish_loading("full")
    program.play(Mode.ARCADE, "silver_comet", 1)
    program.play(Mode.FREE, "original", 1)
    assert program.session is None
    assert not program.is_ready
    assert program.loading.waiting.table.name == "Original 1"
    assert reads(program.dots(0.0), "GETTING READY")
    assert "Silver Comet" in evening.store.last_game()
    program.finish_loading("plain")
    assert program.is_ready
    assert program.session.game.table.name == "Original 1"
    evening.store.close()


def test_who_does_not_wait_for_the_code_of_another_table_can_play_the_one_before(tmp_path):
    evening = Evening(tmp_path)
    program = evening.program
    program.play(Mode.ARCADE, "silver_comet", 1)  # before anything is loaded
    program.finish_loading("plain")
    assert program.session is None, "the code of another layout has been loaded"
    evening.tap(Action.BACK)
    assert program.is_ready
    program.play(Mode.ARCADE, "classic", 1)
    assert program.session.game.table.name == "Classic"
    evening.store.close()


def test_the_board_that_is_seen_in_the_menu_is_the_one_that_is_played_first(tmp_path):
    from silverball.table import load_table

    evening = Evening(tmp_path, Settings(table="Random"), load_table("random"))
    evening.program.finish_loading()
    seen = evening.program.board.table
    evening.tap(Action.CREATE)
    assert evening.program.session.game.table == seen
    evening.tap(Action.NEW_BOARD)
    assert evening.program.board.table != seen
    evening.store.close()


def test_a_game_that_is_left_is_the_last_game(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.tap(Action.CREATE)
    evening.go(0.2)
    evening.tap(Action.PAUSE, Action.LEFT, Action.CREATE, Action.RIGHT, Action.CREATE)  # end game, yes
    assert evening.program.menus.page == "main"
    assert evening.program.session is None
    replay = Replay.from_text(evening.store.last_game())
    assert replay.ended == "stopped"
    assert verify(replay).ok


def test_a_replay_that_was_tampered_with_is_refused_in_one_sentence_and_the_menu_stays(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.play_to_the_end()
    (row,) = evening.store.scores()
    text = evening.store.replay(row.id).replace("seed = 3", "seed = 4")
    watch_replay_text(evening.program, text, "score 1")
    assert "changed or damaged" in evening.said[-1]
    assert evening.program.menus.is_open


def test_settings_are_kept_with_every_change(evening):
    evening.program.settings.change(volume=3)
    assert Settings.of(evening.store.settings()).volume == 3
    assert evening.program.menus.context.settings.current.volume == 3


def test_losing_the_focus_pauses_play_and_nothing_else(evening):
    evening.program.lose_focus()
    assert evening.program.menus.page == "main"
    evening.program.play(Mode.FREE, "Leaky", 3)
    evening.program.lose_focus()
    assert evening.program.is_paused


def test_a_table_that_is_not_there_is_an_error_at_the_start_and_a_message_later(tmp_path, evening):
    with pytest.raises(TableError):
        Evening(tmp_path / "other", Settings(table="nowhere.toml"))
    before = evening.program.board.table
    evening.program.play(Mode.FREE, "nowhere.toml")
    assert "nowhere.toml" in evening.said[-1]
    assert evening.program.board.table == before


def test_nobody_there_lets_the_program_play_and_a_button_brings_the_menu_back(evening):
    evening.go(31.0)
    assert evening.program.menus.page == "attract"
    assert not evening.program.is_audible
    tick = evening.program.session.game.tick
    evening.go(1.0)
    assert evening.program.session.game.tick > tick
    evening.tap(Action.RIGHT)
    assert evening.program.menus.page == "main"


def test_the_reflex_player_stands_in_until_the_planner_is_ready(evening):
    ready = {"reflex"}
    evening.program.demo_players.is_ready = ready.__contains__
    evening.go(31.0)
    session = evening.program.session
    assert session.player.name == "reflex"
    assert evening.program.display.player_label == "REFLEX"
    tick = session.game.tick
    ready.add("planner")
    evening.go(0.1)
    assert evening.program.session is session
    assert session.player.name == "planner"
    assert session.game.tick > tick
    assert evening.program.display.player_label == "PLANNER"


@pytest.mark.parametrize("demo_player", ["planner", "reflex"])
@pytest.mark.parametrize("action", [Action.LEFT, Action.JITTER, Action.NEW_BOARD, Action.CREATE])
def test_who_is_watched_plays_and_any_button_brings_the_menu_back(evening, demo_player, action):
    evening.program.demo_players.is_ready = lambda name: True
    evening.program.menus.close()
    evening.program.start_demo(demo_player)
    evening.go(0.5)
    assert evening.program.session.player.name == demo_player
    assert evening.program.is_audible
    evening.tap(action)
    assert evening.program.menus.page == "main"
    assert evening.program.session is None


@pytest.mark.parametrize("action", [Action.JITTER, Action.NEW_BOARD])
def test_a_button_that_works_no_menu_ends_the_show_too(evening, action):
    evening.go(31.0)
    assert evening.program.menus.page == "attract"
    evening.tap(action)
    assert evening.program.menus.page == "main"


def test_the_planner_is_not_hurried_beyond_what_it_can_think(evening):
    evening.program.start_demo("reflex")
    evening.program.menus.close()
    evening.tap(*[Action.FASTER] * 9)
    assert evening.program.speed == SPEEDS[-1]
    evening.program.demo_players.is_ready = lambda name: True
    evening.program.start_demo("planner")
    evening.tap(*[Action.FASTER] * 9)
    assert evening.program.speed == 2.0


def test_a_replay_goes_faster_and_slower_holds_and_jumps(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.play_to_the_end()
    replay = Replay.from_text(evening.store.last_game())
    evening.program.watch(replay)
    player = evening.program.session.player
    evening.tap(*[Action.FASTER] * 9)
    assert evening.program.speed == 16.0
    evening.tap(*[Action.SLOWER] * 9)
    assert evening.program.speed == 0.25
    evening.tap(Action.CREATE)
    held = player.tick
    evening.go(1.0)
    assert player.tick == held
    evening.program.single_tick(NOTHING)
    assert player.tick == held + 1
    evening.tap(Action.RIGHT)
    assert player.tick == min(held + 1 + 5 * replay.tick_rate, replay.ticks)


def test_a_space_in_the_very_moment_of_the_end_costs_no_score(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    game = evening.program.session.game
    while not game.is_over:
        if game.phase is not Phase.PLAY:
            evening.press(Action.CREATE)
        evening.advance(8)
    evening.press(Action.CREATE)  # before any time has passed
    assert game.score > 0
    evening.go(0.1)
    assert [row.score for row in evening.store.scores()] == [game.score]


def test_a_program_that_ends_in_the_very_moment_of_the_end_has_kept_the_score(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    game = evening.program.session.game
    while not game.is_over:
        if game.phase is not Phase.PLAY:
            evening.press(Action.CREATE)
        evening.advance(8)
    evening.program.games.save_last_game()
    assert [row.score for row in evening.store.scores()] == [game.score]


@pytest.mark.parametrize("move", ["watch", "jump", "tick"])
def test_a_replay_whose_inputs_cannot_be_given_is_put_away_in_one_sentence(evening, move):
    from dataclasses import replace

    evening.program.play(Mode.FREE, "Leaky", 3)
    evening.tap(Action.CREATE)
    evening.go(0.5)
    replay = evening.program.session.game.replay
    evening.program.watch(replace(replay, tail="+a+a+a+a"))  # four balls at once
    if move == "jump":
        evening.program.watching.jump(5.0)
    elif move == "tick":
        evening.program.machine.is_replay_paused = True
        evening.program.single_tick(NOTHING)
    else:
        evening.go(0.1)
    assert "was recorded, but" in evening.said[-1]
    assert evening.program.session is None
    assert evening.program.menus.is_open


def test_a_game_that_is_over_gives_way_to_the_show_when_nobody_is_there(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.play_to_the_end()
    evening.go(GAME_OVER_SECONDS + 40.0)
    assert evening.program.menus.page == "attract"
    assert isinstance(evening.program.session, DemoSession)
    assert not evening.program.is_audible
    assert [row.initials for row in evening.store.scores()] == ["AAA"]


def test_the_main_menu_after_a_game_shows_the_board_without_what_was_on_it(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.tap(Action.CREATE)
    evening.program.session.game.end()  # with a ball on the board
    evening.go(GAME_OVER_SECONDS + 0.2)
    assert evening.program.menus.page == "over"
    evening.tap(Action.LEFT, Action.CREATE)  # menu
    assert evening.program.menus.page == "main"
    assert evening.program.session is None


def test_a_table_chosen_after_a_game_is_seen_at_once(evening):
    evening.program.play(Mode.ARCADE, "Leaky", 3)
    evening.play_to_the_end()
    evening.program.menus.open_main()
    evening.program.settings.change(table="classic")
    assert evening.program.board.table.name == "Classic"
    assert evening.program.session is None


def test_a_table_chosen_elsewhere_leaves_a_game_that_goes_on_alone(evening):
    evening.program.play(Mode.FREE, "Leaky", 3)
    session = evening.program.session
    evening.program.settings.change(table="classic")
    assert evening.program.session is session
    assert evening.program.board.table.name == "Leaky"


def test_a_seed_that_is_chosen_is_seen_at_once_and_played(tmp_path):
    from silverball.table import generate_table, load_table

    evening = Evening(tmp_path, Settings(table="random"))
    evening.program.finish_loading()
    # Table, board seed, new or the same or a number.
    evening.tap(*[Action.RIGHT] * 2, Action.CREATE)
    while evening.program.menus.page == "table":
        evening.tap(Action.RIGHT)
        page = evening.program.menus.context.pages[-1]
        if page._current_items()[page.index].label == "BOARD SEED":
            evening.tap(Action.CREATE)
    evening.tap(Action.LEFT, Action.LEFT, Action.CREATE)
    assert evening.program.menus.page == "seed"
    for digit in "42":
        evening.program.menus.type(digit, digit, is_button=False)
    evening.tap(Action.CREATE)
    assert evening.program.board.table == generate_table(42, load_table("random"))
    evening.tap(Action.BACK, Action.LEFT, Action.LEFT, Action.CREATE)
    assert evening.program.session.game.table == generate_table(42, load_table("random"))
    evening.store.close()


@pytest.mark.parametrize(
    ("state", "words"),
    [("menu", "paused"), ("game", "paused"), ("over", "game is over"), ("replay", "replay is paused"),
     ("ended replay", "replay has ended"), ("show", "paused")],
)  # fmt: skip
def test_a_single_tick_that_is_not_possible_gives_the_reason(evening, state, words):
    program = evening.program
    if state in ("over", "replay", "ended replay"):
        program.play(Mode.ARCADE, "Leaky", 3)
        evening.play_to_the_end()
    if "replay" in state:
        program.watch(Replay.from_text(evening.store.last_game()))
    if state == "ended replay":
        program.watching.jump(1e6)
        evening.go(0.1)
        assert program.session.has_ended
    elif state == "game":
        program.play(Mode.FREE, "Leaky", 3)
    elif state == "show":
        program.start_demo()
    program.single_tick(NOTHING)
    assert words in evening.said[-1]
