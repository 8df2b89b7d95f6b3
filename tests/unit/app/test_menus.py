"""The menus: commands, settings and what they draw."""

import pytest
from hypothesis import given, strategies as st

from reading import reads
from silverball.app.demo_players import DEMO_PLAYERS
from silverball.app.menus import Button, Menus, ReplayStatus, ScoreRow, TableEntry, page_layout
from silverball.app.menus.commands import (
    Attract,
    EndGame,
    EndReplay,
    Initials,
    Play,
    Quit,
    ReplayJump,
    ReplayPause,
    ReplaySpeed,
    Restart,
    Resume,
    SaveReplay,
    WatchDemo,
    WatchLast,
    WatchScore,
)
from silverball.app.menus.menus import ATTRACT_AFTER, REPEAT_AFTER
from silverball.app.settings import PlayerSettings, Settings
from silverball.drawing.dotmatrix.canvas import WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL
from silverball.game.view import Mode

LEFT, RIGHT, START, BACK = Button
LATER = 0.4  # [s] when nothing slides any more
TABLES = (
    TableEntry("classic", "Classic", "drawn by hand"),
    TableEntry("random", "Random", "new for every seed", True),
    TableEntry("/tables/long.toml", "A table whose name is longer than any display", "mine"),
)
ROWS = tuple(ScoreRow(f"P{place}X", 1000 * (10 - place), "2026-11-25", f"k{place}") for place in range(10))


def scores(table: str, mode: Mode):
    return ROWS if table == "classic" and mode is Mode.ARCADE else ()


def menus_with(settings: Settings | None = None, themes=("neon", "night", "plain")) -> Menus:
    return Menus(PlayerSettings(settings or Settings()), TABLES, scores, themes=themes)


def press(menus: Menus, *buttons: Button):
    """Press and release buttons one after the other; the last command that was asked for."""
    last = None
    for button in buttons:
        command = menus.press(button)
        menus.release(button)
        last = command or last
    return last


def choose(menus: Menus, label: str, steps: int = 40):
    """Turn until an item is shown, and choose it."""
    for _ in range(steps):
        if reads(menus.draw(LATER), label, (BOLD,)):
            return press(menus, START)
        press(menus, RIGHT)
    raise AssertionError(f"{label} is not on the page {menus.page}")


def test_play_begins_the_chosen_game_and_closes_the_menus():
    menus = menus_with(Settings(table="classic", mode="free"))
    assert press(menus, START) == Play(Mode.FREE, "classic", None)
    assert not menus.is_open
    assert menus.press(START) is None


def test_the_mode_is_changed_by_steps_and_kept():
    menus = menus_with(Settings(mode="arcade"))
    choose(menus, "MODE")
    press(menus, RIGHT)
    assert menus.context.settings.current.mode == "free"
    press(menus, START)
    assert menus.context.settings.current.mode == "free"
    assert menus.page == "main"


def test_going_back_from_a_value_brings_the_old_one_again():
    menus = menus_with(Settings(volume=7))
    choose(menus, "SETTINGS")
    choose(menus, "VOLUME")
    press(menus, RIGHT, RIGHT)
    assert menus.context.settings.current.volume == 9
    press(menus, BACK)
    assert menus.context.settings.current.volume == 7


def test_the_volume_ends_at_its_ends():
    menus = menus_with(Settings(volume=9))
    choose(menus, "SETTINGS")
    choose(menus, "VOLUME")
    press(menus, RIGHT, RIGHT)
    assert menus.context.settings.current.volume == 10


@pytest.mark.parametrize(
    ("label", "field", "values"),
    [
        ("COLOURS", "theme", {"neon", "night", "plain"}),
        ("SOUND", "muted", {True, False}),
        ("EFFECTS", "effects", {"full", "less"}),
        ("PICTURES/S", "frame_rate", {"screen", "60", "120", "144"}),
        ("FULL SCREEN", "full_screen", {True, False}),
        ("CABINET", "cabinet", {"off", "upright", "left", "right"}),
    ],
)
def test_every_setting_goes_through_all_its_values(label, field, values):
    menus = menus_with()
    choose(menus, "SETTINGS")
    choose(menus, label)
    seen = set()
    menus.context.settings.subscribe(lambda before, after: seen.add(getattr(after, field)))
    press(menus, *[RIGHT] * len(values))
    assert seen == values


def test_a_theme_that_is_no_longer_there_can_be_replaced():
    menus = menus_with(Settings(theme="gone"))
    choose(menus, "SETTINGS")
    choose(menus, "COLOURS")
    press(menus, RIGHT)
    assert menus.context.settings.current.theme in ("neon", "night", "plain")


def test_a_table_is_chosen_and_played():
    menus = menus_with()
    choose(menus, "TABLE")
    choose(menus, "CLASSIC")
    assert menus.context.settings.current.table == "classic"
    assert menus.page == "main"
    assert choose(menus, "PLAY") == Play(Mode.ARCADE, "classic", None)


def test_a_table_that_is_gone_is_still_named_and_asked_for():
    menus = menus_with(Settings(table="lost.toml"))
    assert reads(menus.draw(0.5), "ARCADE · LOST.TOML")
    assert press(menus, START) == Play(Mode.ARCADE, "lost.toml", None)


def test_a_seed_is_entered_by_digits_and_used_for_random_boards_only():
    menus = menus_with(Settings(table="random"))
    choose(menus, "TABLE")
    choose(menus, "BOARD SEED")
    choose(menus, "NUMBER")
    press(menus, LEFT, START)  # with no digit yet, the last choice before 0 is 9
    press(menus, *[RIGHT] * 5, START)
    assert reads(menus.draw(0.0), "9")
    while not reads(menus.draw(0.0), "SPACE: DONE"):
        press(menus, LEFT)
    press(menus, START)
    assert menus.page == "table"
    press(menus, BACK)
    assert choose(menus, "PLAY") == Play(Mode.ARCADE, "random", 95)
    menus.open_main()
    choose(menus, "TABLE")
    choose(menus, "CLASSIC")
    assert choose(menus, "PLAY") == Play(Mode.ARCADE, "classic", None)


def test_the_board_of_the_last_game_can_be_played_again():
    menus = menus_with(Settings(table="random"))
    menus.context.last_seed = 4711
    choose(menus, "TABLE")
    choose(menus, "BOARD SEED")
    choose(menus, "THE SAME")
    press(menus, BACK)
    assert choose(menus, "PLAY") == Play(Mode.ARCADE, "random", 4711)


@pytest.mark.parametrize("demo_player", DEMO_PLAYERS)
def test_every_performer_can_be_watched_on_the_chosen_table(demo_player):
    menus = menus_with(Settings(table="random"))
    choose(menus, "WATCH")
    for _ in DEMO_PLAYERS:
        if reads(menus.draw(LATER), demo_player.label):
            break
        press(menus, RIGHT)
    assert reads(menus.draw(LATER), f"{demo_player.hint} ON")
    assert press(menus, START) == WatchDemo(demo_player.name)


def test_the_attract_pages_tell_who_plays():
    menus = menus_with()
    menus.open_attract()
    for demo_player in DEMO_PLAYERS:
        menus.context.demo_player = demo_player
        assert any(reads(menus.draw(at / 2), demo_player.label) for at in range(60))


def test_what_can_be_watched():
    menus = menus_with()
    menus.context.has_last_game = True
    choose(menus, "WATCH")
    assert choose(menus, "LAST GAME") == WatchLast()
    menus = menus_with()
    choose(menus, "WATCH")
    choose(menus, "HIGH SCORES")
    press(menus, RIGHT, RIGHT)
    assert press(menus, START) == WatchScore("k2")


def test_after_watching_the_page_is_open_from_which_it_began():
    menus = menus_with()
    menus.open_over(500)
    choose(menus, "WATCH IT")
    assert not menus.is_open
    menus.open_transport(ReplayStatus(0.0, 30.0))
    assert press(menus, BACK) == EndReplay()
    assert menus.page == "over"


def test_the_replay_page_asks_for_speed_hold_and_jumps():
    menus = menus_with()
    menus.open_transport(ReplayStatus(5.0, 30.0))
    assert press(menus, RIGHT) == ReplaySpeed(1)
    assert press(menus, LEFT) == ReplaySpeed(-1)
    assert press(menus, START) == ReplayPause()
    menus.update_replay(ReplayStatus(5.0, 30.0, is_paused=True))
    assert isinstance(press(menus, RIGHT), ReplayJump)
    assert press(menus, LEFT).seconds < 0.0
    menus.update_replay(ReplayStatus(30.0, 30.0))
    assert press(menus, START) == EndReplay()


def test_the_replay_page_shows_time_and_speed_below_the_score():
    menus = menus_with()
    menus.open_transport(ReplayStatus(65.0, 130.0, 0.25))
    game = Dots()
    game.text("4,567", 30, 4)
    dots = menus.draw(1.0, game)
    assert reads(dots, "4,567")
    assert reads(dots, "1:05")
    assert reads(dots, "1/4×")


def test_the_pause_goes_on_restarts_or_ends_after_asking():
    menus = menus_with()
    menus.open_pause()
    assert press(menus, START) == Resume()
    assert not menus.is_open
    menus.open_pause()
    assert press(menus, BACK) == Resume()
    for label, command in (("RESTART", Restart()), ("END GAME", EndGame())):
        menus.open_pause()
        assert choose(menus, label) is None
        assert reads(menus.draw(0.3), "NO")
        assert press(menus, START) is None
        assert menus.page == "pause"
        press(menus, START)
        assert choose(menus, "YES") == command
    assert menus.page == "main"


def test_after_a_game_one_plays_again_watches_or_saves():
    menus = menus_with()
    menus.open_over(1234)
    assert reads(menus.draw(0.3), "SCORE 1,234")
    assert choose(menus, "SAVE REPLAY") == SaveReplay()
    menus.show_message("saved as game.txt")
    assert reads(menus.draw(0.7), "SAVED AS GAME.TXT")
    assert choose(menus, "PLAY AGAIN") == Play(Mode.ARCADE, "silver_comet", None)


def test_initials_start_with_those_of_last_time():
    menus = menus_with(Settings(initials="Z.9"))
    menus.open_over(1234, 2)
    assert press(menus, START, START, START, START) == Initials("Z.9")
    assert menus.page == "over"


def test_initials_are_turned_deleted_and_kept():
    menus = menus_with(Settings(initials="AAA"))
    menus.open_over(1234, 1)
    press(menus, RIGHT, RIGHT, START)  # C
    press(menus, LEFT, START)  # before A: delete
    press(menus, RIGHT, START)  # C was offered again: D
    press(menus, START, START)  # A, A
    press(menus, BACK)  # the last A again
    press(menus, RIGHT, START)  # B
    assert press(menus, START) == Initials("DAB")
    assert menus.context.settings.current.initials == "DAB"


def test_leaving_the_initials_keeps_the_score_under_those_of_last_time():
    menus = menus_with(Settings(initials="OLD"))
    menus.open_over(1234, 1)
    press(menus, RIGHT, START)
    press(menus, BACK)
    assert press(menus, BACK) == Initials("OLD")


def test_a_held_paddle_turns_letters_again_and_again_until_it_is_released():
    menus = menus_with(Settings(initials="AAA"))
    menus.open_over(1234, 1)
    menus.tick(10.0)
    menus.press(RIGHT)
    once = menus.signature
    menus.tick(10.0 + 0.9 * REPEAT_AFTER)
    assert menus.signature == once
    for tick in range(30):
        menus.tick(10.5 + tick / 30)
    assert menus.signature != once
    menus.release(RIGHT)
    released = menus.signature
    menus.tick(20.0)
    assert menus.signature == released


def test_going_back_too_often_does_not_lose_the_program():
    menus = menus_with()
    assert press(menus, BACK) is None
    assert reads(menus.draw(0.3), "QUIT")
    assert press(menus, BACK) == Quit()


def test_nobody_at_the_menu_for_a_while_starts_the_show_and_a_button_ends_it():
    menus = menus_with()
    menus.tick(5.0)
    assert menus.tick(5.0 + 0.9 * ATTRACT_AFTER) is None
    press(menus, RIGHT)
    assert menus.tick(5.0 + 1.5 * ATTRACT_AFTER) is None
    assert menus.tick(5.0 + 2.0 * ATTRACT_AFTER) == Attract(True)
    assert menus.page == "attract"
    assert press(menus, RIGHT) == Attract(False)
    assert menus.page == "main"
    menus.tick(5.0 + 4.0 * ATTRACT_AFTER)
    assert menus.page == "attract"
    assert press(menus, START) == Play(Mode.ARCADE, "silver_comet")  # at once to the plunger


def test_no_show_starts_over_a_paused_game_or_in_a_game():
    menus = menus_with()
    for open_page in (menus.open_pause, menus.close):
        open_page()
        assert menus.tick(1000.0) is None
        assert menus.tick(5000.0) is None


def test_no_show_starts_at_the_end_of_a_long_game():
    menus = menus_with()
    menus.tick(1.0)
    press(menus, START)
    menus.open_over(1234)
    assert menus.tick(1.0 + 10.0 * ATTRACT_AFTER) is None
    assert menus.page == "over"
    assert menus.tick(1.0 + 11.5 * ATTRACT_AFTER) == Attract(True)


def test_a_long_message_stays_until_it_can_be_read_to_its_end():
    menus = menus_with()
    menus.tick(1.0)
    menus.show_message("the replay could not be saved because the disk is full")
    frames = [menus.draw(1.0 + tick / 5) for tick in range(60)]
    assert any(reads(dots, "THE REPLAY") for dots in frames)
    assert any(reads(dots, "IS FULL") for dots in frames)
    assert not reads(frames[-1], "IS FULL")


def test_the_replay_page_tells_whose_game_it_is_and_how_to_leave():
    menus = menus_with()
    menus.open_transport(ReplayStatus(0.0, 30.0, title="abc"))
    frames = [menus.draw(tick / 2) for tick in range(60)]
    for text in ("ABC", "SPEED", "BOTH PADDLES HELD: LEAVE", "0:00"):
        assert any(reads(dots, text) for dots in frames), text


def test_the_show_has_the_name_the_scores_and_how_to_begin():
    menus = menus_with(Settings(keys={"create": ("return",)}))
    menus.open_attract()
    frames = [menus.draw(tick / 4) for tick in range(200)]
    for text in ("SILVERBALL", "PRESS RETURN", "CLASSIC · ARCADE", "9,000", "LEFT PADDLE"):
        assert any(reads(dots, text) for dots in frames), text


def test_the_score_page_scrolls_to_its_last_row_and_back():
    menus = menus_with()
    choose(menus, "SCORES")
    frames = [menus.draw(tick / 4) for tick in range(120)]
    first, last = [[reads(dots, row.initials) for dots in frames] for row in (ROWS[0], ROWS[-1])]
    assert first[0]
    assert not last[0]
    assert any(last)
    assert any(first[last.index(True) + 20 :])


@given(
    text=st.text(st.sampled_from("AbIl1W. ,中"), min_size=1, max_size=80),
    left=st.integers(0, 40),
    room=st.integers(30, 119),
)
def test_texts_that_are_too_long_scroll_from_their_first_dot_to_their_last(text, left, room):
    whole = NORMAL.width(text)
    sheet = [[False] * whole for _ in range(9)]
    at = 0
    for letter in text:
        glyph = NORMAL.glyph(letter)
        for row in range(glyph.shape[0]):
            for column in range(glyph.shape[1]):
                sheet[row][at + column] = bool(glyph[row, column])
        at += glyph.shape[1] + NORMAL.gap
    starts, ends = Dots(), Dots()
    page_layout.marquee(starts, text, 3, left, left + room, NORMAL, 0.0, "left")
    moving = max(whole - room, 0) / page_layout.SCROLL_SPEED
    page_layout.marquee(
        ends, text, 3, left, left + room, NORMAL, page_layout.SCROLL_WAIT + moving + 0.5, "left"
    )
    shown = min(whole, room)
    first = [[bool(dot) for dot in row] for row in starts.pixels[3:12, left : left + shown]]
    last = [[bool(dot) for dot in row] for row in ends.pixels[3:12, left : left + shown]]
    assert first == [row[:shown] for row in sheet]
    assert last == [row[whole - shown :] for row in sheet]
    assert not starts.pixels[:, :left].any()
    assert not starts.pixels[:, left + room :].any()


def test_a_table_with_a_long_name_scrolls_in_the_list():
    menus = menus_with(Settings(table="/tables/long.toml"))
    choose(menus, "TABLE")
    seen = [menus.draw(1.0 + tick / 5) for tick in range(60)]
    assert any(reads(dots, "A TABLE WHOSE") for dots in seen)
    assert any(reads(dots, "ANY DISPLAY") for dots in seen)


def test_equal_presses_at_equal_times_show_equal_dots():
    pictures = []
    for _ in range(2):
        menus = menus_with()
        for tick, button in enumerate((RIGHT, RIGHT, START, RIGHT, START, LEFT, START)):
            menus.tick(0.5 * tick)
            press(menus, button)
        pictures.append([menus.draw(4.0 + step / 7).pixels.tobytes() for step in range(30)])
    assert pictures[0] == pictures[1]


def test_a_page_slides_in_from_the_side_to_which_one_turns():
    menus = menus_with()
    menus.tick(1.0)
    menus.press(RIGHT)
    moving, still = menus.draw(1.02).pixels[10:21], menus.draw(1.5).pixels[10:21]
    assert (moving != still).any()
    middle = slice(WIDTH // 2 - 50, WIDTH // 2 + 50)
    moved = moving[:, middle].any(axis=0).nonzero()[0]
    rested = still[:, middle].any(axis=0).nonzero()[0]
    assert moved.size == 0 or moved.min() > rested.min()


@pytest.mark.parametrize("count", [2, 15, 16, 100, 503])
def test_the_title_tells_which_of_many_choices_is_shown(count):
    pictures = set()
    for index in range(count):
        dots = Dots()
        page_layout.title(dots, "TABLE", index, count)
        pictures.add(dots.pixels.tobytes())
        assert reads(dots, "TABLE")
        assert reads(dots, f"{index + 1}/{count}") == (count > page_layout.MAX_PAGE_DOTS)
    assert len(pictures) == count


def test_a_paddle_that_is_held_hurries_through_a_long_list():
    many = [TableEntry(f"t{number}", f"T{number}") for number in range(500)]
    menus = Menus(PlayerSettings(Settings(table="t0")), many, scores)
    choose(menus, "TABLE")
    menus.tick(1.0)
    menus.press(RIGHT)
    for tick in range(12 * 60):
        menus.tick(1.0 + tick / 60)
    assert menus.context.pages[-1].index > 250  # within twelve seconds
