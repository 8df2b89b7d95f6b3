"""The table of keys, the held buttons and the clock, without a window."""

from __future__ import annotations

import pygame

from silverball.app.clock import TickClock
from silverball.app.controls import BINDINGS, Action, Buttons, action_of


def test_every_action_has_a_line_in_the_help():
    assert {binding.action for binding in BINDINGS} == set(Action)
    assert all(binding.shown and binding.does for binding in BINDINGS)


def test_every_key_in_the_help_does_what_its_line_says():
    for binding in BINDINGS:
        modifiers = pygame.KMOD_LSHIFT if binding.with_shift else 0
        assert {action_of(key, modifiers) for key in binding.keys} == {binding.action}


def test_a_tap_counts_in_the_first_tick_only_and_only_once():
    buttons = Buttons()
    buttons.press(pygame.K_d)
    buttons.release(pygame.K_d)
    assert buttons.take() == ((False, True), (False, False))
    assert buttons.take() == ((False, False), (False, False))


def test_the_clock_keeps_what_is_left_of_a_tick():
    clock = TickClock(240)
    assert sum(clock.advance(0.001) for _ in range(1000)) in (239, 240)


def test_the_clock_does_not_catch_up_with_a_stall():
    clock = TickClock(240)
    assert clock.advance(5.0) == clock.most_ticks == 12
    assert clock.advance(0.0) == 0
    assert clock.advance(-1.0) == 0
