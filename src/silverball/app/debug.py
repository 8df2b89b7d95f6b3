"""The debug view: velocities, contact points and normals on the table, and figures beside it.

It is drawn over a picture through the same camera, at the height of the board: arrows show the solver's
positions, even of a ball behind a wall.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

import pygame

from silverball.app.timing import FrameTimes, LatencyMeter, median
from silverball.drawing import themes
from silverball.drawing.text import line
from silverball.table import Paddle

if TYPE_CHECKING:
    from silverball.drawing import Camera
    from silverball.table import Table
    from silverball.world import Event, World

VELOCITY_SECONDS = 0.12  # [s] of motion that an arrow shows
NORMAL_LENGTH = 0.9  # [u]
CONTACT_SECONDS = 1.0  # how long a contact is shown
LOG_LINES = 10
DOT_RADIUS = 3  # [pixel] of the dot at the end of a line
VELOCITY = (120, 255, 160)
NORMAL = (255, 210, 80)
TOUCH = (150, 160, 190)
OUTLINE = (255, 90, 150)
_TOUCH_KINDS = ("touch", "ball_touch")
_CONTACT_KINDS = ("hit", "ball_hit", *_TOUCH_KINDS)  # with a normal to draw


class _TimedEvent(NamedTuple):
    time: float
    event: Event


class DebugView:
    """Stores recent events and draws them on request."""

    def __init__(self) -> None:
        self._contacts: deque[_TimedEvent] = deque(maxlen=64)
        self._log: deque[str] = deque(maxlen=LOG_LINES)

    def reset(self) -> None:
        """Drop all events, because another session begins."""
        self._contacts.clear()
        self._log.clear()

    def add_events(self, events: Iterable[Event], tick_rate: int) -> None:
        """Add the events since the last call."""
        for event in events:
            time = event.tick / tick_rate + event.offset
            self._contacts.append(_TimedEvent(time, event))
            if event.kind not in _TOUCH_KINDS:
                what = f"{event.kind} {event.part}" if event.part else event.kind
                self._log.append(f"{time:8.4f} s  ball {event.ball}  {what}  {event.speed:.2f} u/s")

    def draw(self, target: pygame.Surface, camera: Camera, world: World) -> None:
        """Draw velocities and contacts onto a picture through its camera."""
        radius = world.table.board.ball_radius
        for part, number in paddle_numbers(world.table):
            corners = part.corners(math.degrees(world.paddles[number].angle))
            pygame.draw.aalines(target, OUTLINE, True, [camera.to_pixel(*c) for c in corners])
        recent = (one for one in self._contacts if 0.0 <= world.time - one.time < CONTACT_SECONDS)
        for _, event in recent:
            if event.kind not in _CONTACT_KINDS:
                continue
            x, _, z = event.position
            nx, _, nz = event.normal
            foot = camera.to_pixel(x - nx * radius, z - nz * radius)
            tip = camera.to_pixel(x + nx * (NORMAL_LENGTH - radius), z + nz * (NORMAL_LENGTH - radius))
            color = TOUCH if event.kind in _TOUCH_KINDS else NORMAL
            pygame.draw.aaline(target, color, foot, tip)
            pygame.draw.aacircle(target, color, foot, DOT_RADIUS)
        for ball in world.balls:
            x, _, z = ball.position
            vx, _, vz = ball.velocity
            start = camera.to_pixel(x, z)
            end = camera.to_pixel(x + VELOCITY_SECONDS * vx, z + VELOCITY_SECONDS * vz)
            pygame.draw.line(target, VELOCITY, start, end, 2)
            pygame.draw.aacircle(target, VELOCITY, end, DOT_RADIUS)
            rim = [camera.to_pixel(x + radius * c, z + radius * s) for c, s in _CIRCLE]
            pygame.draw.aalines(target, VELOCITY, True, rim)

    def draw_figures(
        self,
        target: pygame.Surface,
        world: World,
        frames: FrameTimes,
        latency: LatencyMeter,
        speed: float,
        area: pygame.Rect,
        size: int,
    ) -> None:
        """Draw figures into an area: frames, latency, counters of the world, the last events.

        Args:
            target: The picture.
            world: The world on screen.
            frames: Statistics of the frames.
            latency: Latency of the buttons.
            speed: Seconds of play per second of real time.
            area: Area to draw in [pixel].
            size: Size of the text [pixel].
        """
        lines = [
            f"{frames.per_second:.0f} frames/s, slowest {1e3 * frames.slowest:.1f} ms, "
            f"{world.tick_rate} ticks/s, speed {speed:g}",
            f"button to tick {1e3 * median(latency.to_tick):.1f} ms, "
            f"to picture {1e3 * median(latency.to_picture):.1f} ms (medians of {len(latency.to_tick)})",
            f"seed {world.seed}  tick {world.tick}  {world.time:.2f} s  jams {world.jams}",
            *(
                f"ball {ball.id}  x {ball.position[0]:+.4f}  z {ball.position[2]:+.4f}  "
                f"v {(ball.velocity[0] ** 2 + ball.velocity[2] ** 2) ** 0.5:6.3f} u/s"
                for ball in world.balls
            ),
            *self._log,
        ]
        height = round(1.15 * size)
        veil = pygame.Surface((area.width, height * len(lines) + size), pygame.SRCALPHA)
        veil.fill((0, 0, 0, 150))
        target.blit(veil, area.topleft)
        for row, text in enumerate(lines):
            target.blit(
                line(text, size, themes.TEXT), (area.left + size // 2, area.top + size // 2 + row * height)
            )


def paddle_numbers(table: Table) -> list[tuple[Paddle, int]]:
    """Return the paddles of a table, each with its number in `World.paddles`."""
    from silverball.physics.records import Part
    from silverball.world.compile import part_numbers

    numbers = part_numbers(table)
    return [
        (one.part, numbers[one.name] - Part.FIRST_PADDLE)
        for one in table.parts()
        if isinstance(one.part, Paddle)
    ]


_CIRCLE = [(math.cos(math.pi * i / 12), math.sin(math.pi * i / 12)) for i in range(24)]
