"""The window itself: time, size, what it draws, and what it leaves behind."""

from __future__ import annotations

import time

import pygame
import pytest

from silverball.app.inputlog import InputLog, replay
from silverball.app.screen import Screen
from silverball.app.window import Window
from silverball.errors import FaultError, NoDisplay


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


def test_resizing_keeps_the_whole_table_in_the_middle(player):
    for size in ((600, 400), (200, 700), (333, 681), (170, 340)):
        player.window._screen.resize(size)
        player.frames(2)
        area = player.window._picture.area
        assert player.window._screen.surface.get_size() == size
        assert pygame.Rect((0, 0), size).contains(area)
        assert area.width >= size[0] - 1 or area.height >= size[1] - 1


def test_a_large_window_is_drawn_at_once_and_becomes_sharp_by_itself(player):
    player.window._screen.resize((700, 1400))
    player.frames(1)
    assert not player.window._picture.is_sharp
    limit = time.monotonic() + 20.0
    while not player.window._picture.is_sharp and time.monotonic() < limit:
        player.frames(1)
        time.sleep(0.01)
    assert player.window._picture.is_sharp


def test_help_pause_hint_and_frame_rate_change_the_picture(player):
    seen = [pixels(player)]
    for key in (pygame.K_F1, pygame.K_F1, pygame.K_p, pygame.K_p, pygame.K_F3, pygame.K_SPACE):
        player.tap(key)
        seen.append(pixels(player))
        assert (seen[-1] != seen[-2]).any()


def covered(player):
    """Where a message changes the picture while time stands still."""
    player.tap(pygame.K_p)
    before = pixels(player).astype(int)
    player.window.messages.say("two balls are the most")
    player.frames(1, 0.0)
    return (pixels(player).astype(int) != before).any(axis=2)


def test_a_message_hides_no_play_and_lies_above_the_veil_of_the_pause(player):
    player.tap(pygame.K_SPACE)
    changed = covered(player)
    apron = player.window._picture.apron.top + player.window._picture.area.top
    assert changed.any()
    assert not changed[:, : apron - 1].any()
    assert pixels(player)[:, apron:].max() > 220  # its letters, not dimmed


def test_a_long_seed_can_be_read_in_full_with_the_keys_and_with_the_frame_rate(open_window, monkeypatch):
    from silverball.app import overlay

    written = []
    real = overlay.line
    monkeypatch.setattr(overlay, "line", lambda text, *rest: written.append(text) or real(text, *rest))
    player = open_window("random", seed=1234567890123456789)
    for key in (pygame.K_F1, pygame.K_F1, pygame.K_F3):
        written.clear()
        player.tap(key)
        assert ("seed 1234567890123456789" in written) == (
            player.window.shows_help or player.window.shows_frame_rate
        )


def test_the_frame_rate_stands_above_the_apron(player):
    player.tap(pygame.K_p)
    before = pixels(player)
    player.tap(pygame.K_F3)
    apron = player.window._picture.apron.top + player.window._picture.area.top
    assert (pixels(player) != before)[:, :apron].any()
    assert (pixels(player) == before)[:, apron:].all()


def test_compiling_without_a_cache_is_said_to_come_at_every_start(monkeypatch):
    from silverball.app.startup import compiling_words
    from silverball.physics import kernel

    assert "once" in compiling_words()
    monkeypatch.setattr(kernel, "cache_folder", lambda: None)
    assert "every start" in compiling_words()
    assert "once" not in compiling_words()


def test_the_first_window_fits_a_screen_of_768_pixels(player):
    screen = player.window._screen
    screen.desktop = (1366, 768)
    title_and_task_bar = 60  # [pixel] of the common desktops together
    assert 600 < screen.first_height <= 768 - title_and_task_bar


def test_a_dummy_display_is_no_display_and_the_message_names_the_demo():
    with pytest.raises(NoDisplay, match="silverball demo"):
        Screen("a test")


def test_closing_keeps_a_log_that_plays_the_same_game_again(open_window, tmp_path):
    player = open_window("random", seed=3)
    player.tap(pygame.K_SPACE)
    player.seconds(0.5)
    player.tap(pygame.K_SPACE)
    for key in (pygame.K_a, pygame.K_d, pygame.K_z, pygame.K_a):
        player.press(key)
        player.seconds(0.3)
        player.release(key)
        player.frames(3)
    digest = player.world.digest()
    player.window.close()
    folder = tmp_path / "data"
    assert [path.name for path in folder.iterdir()] == ["last-game.jsonl"]
    log = InputLog.from_text((folder / "last-game.jsonl").read_text(encoding="utf-8"))
    assert log.digest == digest
    assert replay(log).digest() == digest


def test_closing_without_a_game_writes_nothing(open_window, tmp_path):
    player = open_window()
    player.window.close()
    assert not (tmp_path / "data").exists()


def test_a_folder_that_cannot_be_written_is_no_trouble(open_window, tmp_path):
    in_the_way = tmp_path / "file"
    in_the_way.write_text("not a folder", encoding="utf-8")
    player = open_window(data_folder=in_the_way / "data")
    player.tap(pygame.K_SPACE)
    player.window.close()
    assert in_the_way.read_text(encoding="utf-8") == "not a folder"


def test_a_fault_stops_the_board_keeps_a_log_and_says_where(open_window, tmp_path, monkeypatch):
    player = open_window()
    player.tap(pygame.K_SPACE)

    def stop(*_, **__):
        raise FaultError("stopped", "outside", b"")

    monkeypatch.setattr(player.world, "step", stop)
    player.frames(1)
    logs = list((tmp_path / "data").glob("fault-*.jsonl"))
    assert len(logs) == 1
    assert str(logs[0]) in player.says
    player.tap(pygame.K_r)
    assert not player.world.balls


def test_a_crash_keeps_a_log_and_says_where(open_window, tmp_path, monkeypatch, capsys):
    player = open_window()
    player.tap(pygame.K_SPACE)
    monkeypatch.setattr(player.window, "_draw", lambda: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        player.window.run()
    logs = list((tmp_path / "data").glob("crash-*.jsonl"))
    assert len(logs) == 1
    assert str(logs[0]) in capsys.readouterr().err


def test_space_before_the_physics_is_ready_brings_the_ball_as_soon_as_it_is(tmp_path):
    window = Window("classic", 7, height=400, without_display=True, data_folder=tmp_path)
    try:
        pygame.event.clear()
        window._create_ball()
        if not window.is_ready:
            assert "One moment" in window.messages.text
        while not window.is_ready:
            window.frame(0.0)
        assert len(window.session.world.balls) == 1
    finally:
        window.close()


def test_a_window_plays_for_a_given_time(player):
    start = time.perf_counter()
    player.window.run(seconds=0.3)
    assert time.perf_counter() - start == pytest.approx(0.3, abs=0.2)
