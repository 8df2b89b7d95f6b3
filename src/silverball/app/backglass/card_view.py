"""Draws the rules card: running modes with their time, lit shots, groups of lamps, counters."""

from __future__ import annotations

import pygame

from silverball.app.backglass.card import BAR_STEPS, Card, GroupLine, ModeLine
from silverball.app.backglass.words import clipped, label_row
from silverball.app.rule_words import BLINKING, OFF, Shot
from silverball.drawing import themes
from silverball.drawing.text import line, wrapped
from silverball.drawing.themes import Theme

LINE = 1.45  # height of a line, by the size of its text
HEADING = 0.62  # size of headings, by that of the text
UNLIT = (70, 66, 96)


def draw_card(target: pygame.Surface, card: Card, size: int, theme: Theme, is_on: bool) -> None:
    """Draw a card; what does not fit is left out, the least important first.

    Args:
        target: Where to draw.
        card: The card.
        size: Size of the text [pixel].
        theme: Colours.
        is_on: Whether what blinks is lit now.
    """
    if card.rules:
        _draw_rules(target, card, size)
        return
    width, bottom, step = target.get_width(), target.get_height(), round(LINE * size)
    has_counters = bool(card.counters) and bottom > 5 * step
    heights = [_mode_height(mode, step) for mode in card.modes]
    used = sum(heights) + step * (len(card.shots) + has_counters) + round(0.8 * step)
    groups = card.groups[: max((bottom - used) // step, 1 if bottom > 8 * step else 0)]
    foot = bottom - step * (len(groups) + has_counters)
    top = 0
    for mode, height in zip(card.modes, heights, strict=True):
        _draw_mode(target, mode, top, size, theme)
        top += height
    if card.shots:
        heading = line("SHOOT", round(HEADING * size), themes.FAINT_TEXT)
        target.blit(heading, (0, top))
        top += round(0.8 * step)
    for shot in card.shots:
        if top + step > foot:
            break
        _draw_shot(target, shot, top, size, theme, is_on)
        top += step
    for number, group in enumerate(groups):
        _draw_group(target, group, foot + number * step, size, theme)
    if has_counters:
        text = "     ".join(f"{name} {value:,}" for name, value in card.counters)
        target.blit(clipped(text, round(0.8 * size), themes.LABEL, width), (0, bottom - round(0.9 * step)))


def _mode_height(mode: ModeLine, step: int) -> int:
    return step if mode.seconds is None else round(1.25 * step)


def _draw_mode(target: pygame.Surface, mode: ModeLine, top: int, size: int, theme: Theme) -> None:
    width = target.get_width()
    seconds = "" if mode.seconds is None else str(mode.seconds)
    label_row(target, mode.name.upper(), seconds, top, size, (themes.SCORE, themes.SCORE))
    if mode.seconds is None:
        return
    bar = pygame.Rect(0, top + round(1.2 * size), width, max(size // 6, 2))
    pygame.draw.rect(target, UNLIT, bar)
    bar.width = width * mode.bar // BAR_STEPS
    pygame.draw.rect(target, theme.panel_edges[0], bar)


def _draw_shot(target: pygame.Surface, shot: Shot, top: int, size: int, theme: Theme, is_on: bool) -> None:
    blinks = shot.is_blinking or shot.is_mission
    color = theme.panel_edges[0] if blinks else theme.heart
    _lamp(target, (size // 2, top + round(0.6 * size)), size, color if is_on or not blinks else UNLIT)
    label_row(target, shot.where, shot.what, top, size, (themes.TEXT, themes.SCORE), left=round(1.4 * size))


def _draw_group(target: pygame.Surface, group: GroupLine, top: int, size: int, theme: Theme) -> None:
    """Draw the name of a group, and each lamp with its name."""
    small = round(0.8 * size)
    name = clipped(group.name, small, themes.FAINT_TEXT, target.get_width() // 3)
    target.blit(name, (0, top))
    left = name.get_width() + size
    room = (target.get_width() - left) // max(len(group.lamps), 1)
    for lamp, state in group.lamps:
        color = UNLIT if state == OFF else theme.panel_edges[0] if state == BLINKING else theme.heart
        _lamp(target, (left + small // 2, top + round(0.6 * small)), small, color)
        words = themes.FAINT_TEXT if state == OFF else themes.TEXT
        target.blit(
            clipped(lamp, small, words, max(room - round(1.6 * small), 1)), (left + round(1.2 * small), top)
        )
        left += room


def _lamp(target: pygame.Surface, center: tuple[int, int], size: int, color: themes.Color) -> None:
    pygame.draw.aacircle(target, color, center, max(round(0.32 * size), 2))


def _draw_rules(target: pygame.Surface, card: Card, size: int) -> None:
    """Draw how to score, as many rules as fit."""
    width, top = target.get_width(), 0
    for rule in card.rules:
        words = wrapped(f"{rule.text}.", size, width)
        step = round(1.2 * size)
        if top + step * (len(words) + 1) > target.get_height():
            return
        target.blit(line(rule.title, size, themes.SCORE), (0, top))
        for number, text in enumerate(words, 1):
            target.blit(line(text, size, themes.TEXT), (0, top + number * step))
        top += round(step * (len(words) + 1.4))
