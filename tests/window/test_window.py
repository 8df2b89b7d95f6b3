"""The window itself: time, size, drawing, and what remains after it closes."""

from __future__ import annotations

import time

import pygame
import pytest

from silverball.app.screen import Screen
from silverball.app.window import Window
from silverball.errors import NoDisplay
from silverball.game.replay.format import Replay
from silverball.game.replay.verify import verify
from silverball.game.scores.store import Store
from silverball.game.view import Mode


def pixels(player):
    return pygame.surfarray.array3d(player.window._screen.surface)


def test_ticks_follow_real_time_whatever_the_frame_rate(player):
    for frame_rate in (30, 60, 144, 1000):
        before = player.world.tick
        player.frames(frame_rate, 1.0 / frame_rate)
        assert player.world.tick - before == pytest.approx(240, abs=1)


def test_a_stall_of_five_seconds_costs_a_bounded_number_of_ticks(player):
    before = player.world.tick
    player.frames(1, 5.0)
    assert player.world.tick - before == 12
    player.frames(1)
    assert player.world.tick - before == 16


def test_between_two_ticks_a_ball_is_drawn_between_its_places(player):
    from silverball.drawing import Moment

    player.tap(pygame.K_SPACE)
    player.frames(20)
    first = Moment.of(player.world)
    player.frames(1, 1 / 240)
    second = Moment.of(player.world)
    middle = Moment.between(first, second, 0.25)
    assert middle.balls[0].x == pytest.approx(0.75 * first.balls[0].x + 0.25 * second.balls[0].x)
    assert Moment.between(first, second, 0.0).balls == first.balls
    assert Moment.between(first, second, 1.0).balls[0] == pytest.approx(second.balls[0])


def test_resizing_keeps_the_whole_table_in_the_middle(player):
    for size in ((600, 400), (200, 700), (333, 681), (170, 340)):
        player.window._screen.resize(size)
        player.frames(2)
        area = player.window._picture.area
        assert player.window._screen.surface.get_size() == size
        assert pygame.Rect((0, 0), size).contains(area)
        assert area.width >= size[0] - 1 or area.height >= size[1] - 1


def test_while_it_is_resized_the_window_goes_on_and_then_draws_at_the_new_size(player):
    player.tap(pygame.K_SPACE)
    tick = player.world.tick
    for height in range(420, 620, 20):
        player.window._screen.resize((height, height))
        player.frames(1)
    assert player.world.tick == tick + 40
    limit = time.monotonic() + 120.0
    while player.window._picture.renderer.camera.size != player.window._picture.area.size:
        assert time.monotonic() < limit
        player.frames(1, 0.0)
        time.sleep(0.02)


@pytest.mark.sharp
def test_a_window_shows_the_table_at_once_and_becomes_sharp_by_itself(player):
    limit = time.monotonic() + 240.0
    while not player.window._picture.is_sharp:
        assert time.monotonic() < limit
        player.frames(1, 0.0)
        time.sleep(0.05)


def test_help_pause_menu_and_debug_view_change_the_picture(player):
    player.tap(pygame.K_SPACE)
    seen = [pixels(player)]
    for key in (pygame.K_p, pygame.K_F3, pygame.K_F1):
        player.tap(key)
        seen.append(pixels(player))
        assert (seen[-1] != seen[-2]).any()


def test_the_debug_view_draws_what_the_physics_has_and_names_what_happened(player, monkeypatch):
    from silverball.app import debug

    written = []
    real = debug.line
    monkeypatch.setattr(debug, "line", lambda text, *rest: written.append(text) or real(text, *rest))
    player.tap(pygame.K_SPACE)
    player.tap(pygame.K_F3)
    player.press(pygame.K_a)
    player.seconds(3.0)
    text = "\n".join(written)
    assert "button to tick" in text
    assert "to picture" in text
    assert f"seed {player.world.seed}" in text
    assert "hit " in text
    assert "u/s" in text


def test_a_message_hides_no_play(player):
    player.tap(pygame.K_SPACE)
    player.tap(pygame.K_p)
    player.frames(1, 0.0)
    before = pixels(player).astype(int)
    player.window.messages.show("two balls are the most")
    player.frames(1, 0.0)
    changed = (pixels(player).astype(int) != before).any(axis=2)
    apron = player.window._picture.apron.top + player.window._picture.area.top
    assert changed.any()
    assert not changed[:, : apron - 1].any()


def test_a_long_seed_can_be_read_in_full_with_the_keys(open_window, monkeypatch):
    from silverball.app import overlay

    written = []
    real = overlay.line
    monkeypatch.setattr(overlay, "line", lambda text, *rest: written.append(text) or real(text, *rest))
    player = open_window("random", seed=1234567890123456789)
    player.tap(pygame.K_F1)  # how to score
    player.tap(pygame.K_d)  # the keys
    assert "seed 1234567890123456789" in written


def test_compiling_without_a_cache_is_said_to_come_at_every_start(monkeypatch):
    from silverball.app.startup import compiling_message
    from silverball.physics import code_cache as codecache, kernel

    assert "once" in compiling_message()
    with monkeypatch.context() as patch:
        patch.setattr(codecache.Damage, "message", "damaged")
        assert "damaged" in compiling_message()
    monkeypatch.setattr(kernel, "cache_folder", lambda *_: None)
    assert "every start" in compiling_message()
    assert "once" not in compiling_message()


def test_the_first_window_fits_a_screen_of_768_pixels(player):
    screen = player.window._screen
    screen.desktop = (1366, 768)
    title_and_task_bar = 60  # [pixel] of the common desktops together
    assert 600 < screen.max_initial_size[1] <= 768 - title_and_task_bar


def test_a_dummy_display_is_no_display_and_the_message_names_the_demo():
    with pytest.raises(NoDisplay, match="silverball demo"):
        Screen("a test")


def test_closing_keeps_a_replay_that_leads_to_the_same_game(open_window, tmp_path):
    player = open_window("random", seed=3)
    player.tap(pygame.K_SPACE)
    player.seconds(0.5)
    for key in (pygame.K_a, pygame.K_d, pygame.K_z, pygame.K_a):
        player.press(key)
        player.seconds(0.3)
        player.release(key)
        player.frames(3)
    digest = player.game.digest()
    player.window.close()
    with Store(tmp_path / "data") as store:
        replay = Replay.from_text(store.last_game())
    assert replay.digest == digest
    assert verify(replay).ok


def test_a_window_that_is_closed_without_a_game_keeps_none(open_window, tmp_path):
    open_window().window.close()
    with Store(tmp_path / "data") as store:
        assert store.last_game() is None


def test_a_folder_that_cannot_be_written_is_told_and_the_game_goes_on(open_window, tmp_path):
    in_the_way = tmp_path / "file"
    in_the_way.write_text("not a folder", encoding="utf-8")
    player = open_window(folder=in_the_way / "data")
    assert player.window.store.warning
    player.tap(pygame.K_SPACE)
    assert player.world.balls
    player.window.close()
    assert in_the_way.read_text(encoding="utf-8") == "not a folder"


def test_without_an_audio_device_there_is_silence_and_no_error(open_window, monkeypatch):
    monkeypatch.setenv("SDL_AUDIODRIVER", "no such driver")
    player = open_window()
    assert player.window.sounds.warning.startswith("no sound")
    player.tap(pygame.K_SPACE)
    player.press(pygame.K_a)
    player.seconds(1.0)
    assert player.world.tick > 200


def test_a_fault_ends_the_game_keeps_a_replay_and_says_where(open_window, tmp_path):
    player = open_window()
    player.tap(pygame.K_SPACE)
    player.world.records[0]["ball"][0]["vx"] = float("nan")
    player.seconds(1.0)
    kept = list((tmp_path / "data" / "replays").glob("fault-*.replay"))
    assert len(kept) == 1
    assert str(kept[0]) in player.says
    player.tap(pygame.K_r)
    player.frames(1)
    assert not player.world.balls


def test_a_crash_keeps_a_replay_and_says_where(open_window, tmp_path, monkeypatch, capsys):
    player = open_window()
    player.tap(pygame.K_SPACE)
    monkeypatch.setattr(player.window, "_draw", lambda: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        player.window.run()
    kept = list((tmp_path / "data" / "replays").glob("crash-*.replay"))
    assert len(kept) == 1
    assert str(kept[0]) in capsys.readouterr().err


def test_a_game_chosen_before_the_physics_is_ready_begins_as_soon_as_it_is(tmp_path):
    window = Window("classic", 7, mode=Mode.ARCADE, height=400, without_display=True, folder=tmp_path)
    try:
        if not window.is_ready:
            assert "One moment" in window.messages.text or "ompiling" in window.messages.text
        while not window.is_ready:
            window.frame(0.0)
        assert window.program.is_playing
    finally:
        window.close()


def test_a_game_on_a_table_of_the_other_layout_is_loaded_in_a_thread_while_the_window_goes_on(open_window):
    player = open_window("classic")
    window, program = player.window, player.program
    program.play(Mode.ARCADE, "silver_comet", 3)
    assert program.session is None
    limit = time.monotonic() + 600.0
    frames, longest = 0, 0.0
    while not window.is_ready:
        assert time.monotonic() < limit, "the other layout was not loaded within ten minutes"
        start = time.thread_time()
        window.frame(0.0)
        frames, longest = frames + 1, max(longest, time.thread_time() - start)
        time.sleep(0.02)
    assert frames > 0
    assert longest < 5.0  # [s] of this thread; it compiles nothing
    assert program.session.game.table.name == "Silver Comet"
    assert program.is_playing


def test_a_window_plays_for_a_given_time(player):
    start = time.perf_counter()
    player.window.run(seconds=0.3)
    assert 0.3 <= time.perf_counter() - start < 30.0  # a busy machine takes longer, but not for ever


def test_a_table_chosen_long_ago_that_is_gone_gives_way_to_the_default(tmp_path, open_window):
    with Store(tmp_path / "data") as store:
        store.save_settings({"table": str(tmp_path / "gone.toml")})
    player = open_window(None, None, mode=None)
    assert player.program.board.recipe.name == "Silver Comet"


@pytest.mark.parametrize(("mode", "name"), [(Mode.FREE, "Original"), (Mode.ARCADE, "Silver Comet")])
def test_each_game_begins_on_its_own_table(open_window, mode, name):
    player = open_window(None, None, mode=mode)
    assert player.program.board.recipe.name == name
    assert player.program.is_playing


def test_a_table_that_is_named_is_that_of_every_game_the_player_may_choose(open_window):
    player = open_window("rolling", None, mode=None)
    settings = player.program.settings.current
    assert {settings.changed(mode=mode).table for mode in Mode} == {"rolling"}
    named_with_a_game = open_window("rolling", None, mode=Mode.FREE).program.settings.current
    assert named_with_a_game.table == "rolling"
    assert named_with_a_game.changed(mode=Mode.ARCADE).table == "silver_comet"
