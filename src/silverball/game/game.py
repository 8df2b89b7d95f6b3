"""One game: a world, the rules, and a recording of both. No window and no clock in here.

Whoever plays calls `step` with the buttons that are held, and `create_ball` and `jitter` in between; what
happens comes back as a `GameView`, as news and as events. The same table, seed, mode and inputs give the same
game bit for bit, whether its ticks are played one by one or many at once: where the rules must act within,
the world is stopped there.
"""

from __future__ import annotations

import json
import os
from collections import deque
from typing import TYPE_CHECKING, Any

import numpy as np

from silverball.errors import FaultError, NoRoom, SilverballError, StateError
from silverball.game import rules, stuck
from silverball.game.replay.digest import full_digest, short_digests
from silverball.game.replay.format import Replay
from silverball.game.replay.recorder import Recorder
from silverball.game.saved_game import pack_game, unpack_game
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase
from silverball.physics.records import WORLD
from silverball.world import World

if TYPE_CHECKING:
    from silverball.table import Table
    from silverball.world import Event

TICK_RATE = 240
TICK_RATES = (10, 1000)  # the least and the greatest
KEPT = 4096  # events and news that wait to be taken; older ones are dropped
LEAP = 64  # ticks that are played at once, at most: the log of a world holds 56 contacts
MARGIN = 0.1  # [u] kept from the gutter when ticks are played at once

_WORDS = {name: int(field[1]) // 8 for name, field in (WORLD.fields or {}).items()}
_TICK, _COUNTS, _COUNTS_END = (
    _WORDS["tick"],
    _WORDS["draws"],
    _WORDS["fault"],
)  # places in the record, in words of eight bytes; what lies between the last two tells of every event


class Game:
    """One game on one board, from the first ball to the last.

    Args:
        table: A table, a built-in name, or a path to a file. A recipe makes a board with the seed.
        seed: Of everything random, 0 to 2⁶³ − 1.
        mode: Which game.
        tick_rate: Ticks per second, 10 to 1,000.
        record: Whether to write a replay; without, `replay` is refused.

    Attributes:
        world: What is played on. Look at it, but change it by this game's calls only.
        mode: Which game.
        fault: The fault of the world that ended the game, None if none did.

    Example:
        >>> from silverball.game.game import Game
        >>> game = Game("classic", seed=7)
        >>> game.create_ball()
        >>> game.step(left=True, ticks=240)
        >>> game.view.ball
        1
    """

    def __init__(
        self,
        table: Table | str | os.PathLike[str],
        seed: int = 0,
        mode: Mode = Mode.ARCADE,
        tick_rate: int = TICK_RATE,
        *,
        record: bool = True,
    ) -> None:
        least, most = TICK_RATES
        if isinstance(tick_rate, int) and not least <= tick_rate <= most:
            raise ValueError(f"tick_rate must be {least} to {most} ticks a second, got {tick_rate}")
        self.world = World(table, seed, tick_rate)
        self.mode = Mode(mode)
        self.fault: str | None = None
        self._laws = rules.RuleConfig.of(self.world.table, self.mode, self.world.tick_rate)
        self._points = rules.points_by_part(self.world.table)
        self._scores = any(self._points.values())
        self._now = rules.RuleState()
        self._waits = False  # whether a ball is to be put back: read in every tick, so kept beside
        self._watch = stuck.Watch()
        self._left = self._right = False
        self._shove = self._machine = False  # to come in the next tick: the player's, the machine's
        self._record = self.world.records[0]
        self._words = np.frombuffer(self._record, np.int64)
        self._counters = self._words[_COUNTS:_COUNTS_END]
        self._counted = self._counters.tobytes()
        self._world_score = 0
        self._board_x = self._record["ball"]["x"]
        self._board_id = self._record["ball"]["id"]
        board = self.world.table.board
        self._edge = board.gutter + MARGIN
        self._pace = self.world.tick_rate / board.speed_cap
        self._reach = float(self.world.records[1]["paddle_top"])
        self._look_ticks = max(self.world.tick_rate // stuck.LOOKS, 1)
        self._next_look = self._look_ticks
        self._next_second = self.world.tick_rate
        self._recorder = Recorder(self.world.tick_rate) if record else None
        self._stopped = False
        self._events: deque[Event] = deque(maxlen=KEPT)
        self._news: deque[GameEvent] = deque([GameEvent(GameEventKind.BALL_READY, 0, 1)], maxlen=KEPT)

    def __repr__(self) -> str:
        return f"<Game {self.mode} on {self.world.table.name!r}: {self.phase}, score {self.score}>"

    # --- what the player does
    # -------------------------------------------------------------------------------------------

    def step(self, left: bool = False, right: bool = False, ticks: int = 1) -> None:
        """Play on with the paddle buttons held or not; a game that is over stands still.

        A fault of the world ends the game; `fault` names it.

        Args:
            left: Whether the left button is held, in all ticks.
            right: The same of the right one.
            ticks: How many ticks.
        """
        if ticks <= 0 or self._now.over:
            return
        tick = self._words.item(_TICK)
        if left is not self._left or right is not self._right:
            self._press(bool(left), bool(right), tick)
        end = tick + ticks
        while tick < end and not self._now.over:
            count = end - tick
            if count > 1:
                count = self._free_ticks(min(count, self._next_look - tick, self._next_second - tick))
            self._play(count)
            tick = self._words.item(_TICK)
            if tick >= self._next_look and not self._now.over:
                self._look(tick)
            if tick >= self._next_second:
                self._end_second(tick)

    def create_ball(self) -> None:
        """Bring a ball: the first one of the game, the next one, or one more beside the ball in play.

        Raises:
            BoardFull, NoRoom: There cannot be one more now; the message says why. Nothing has changed.
            SilverballError: No ball is left, the table is tilted, or the game is over.
        """
        reason = rules.refusal(self._laws, self._now)
        if reason:
            raise SilverballError(reason)
        ball = self.world.create_ball()
        self._note("+")
        self._tell(rules.started(self._laws, self._now, self.tick, ball.id))
        self._read_creation()

    def jitter(self) -> bool:
        """Shove the table; the balls feel it in the next tick. Two shoves in one tick are one.

        Returns:
            Whether that is a shove: not so when the table is tilted, or was shoved already.

        Raises:
            SilverballError: There is no ball to shove.
        """
        if self._now.over or self._now.tilted or self._shove:
            return False
        if not self._board_id.any():
            raise SilverballError("there is no ball to shove; bring one first")
        self._shove = True
        self._note("!")
        self._tell(rules.shoved(self._laws, self._now, self.tick))
        if self._now.tilted:
            self._watch = self._watch._replace(released=self.tick)
        return True

    def end(self) -> None:
        """End the game here, as when the player leaves it."""
        if not self._now.over:
            self._stopped = True
            self._tell(rules.ended(self._now, self.tick))

    # --- what it shows
    # -------------------------------------------------------------------------------------------

    @property
    def view(self) -> GameView:
        """What there is to show."""
        now, laws, tick = self._now, self._laws, self.tick
        phase = self.phase
        left = max((ball.safe_until - tick for ball in now.balls), default=0)
        return GameView(
            mode=self.mode,
            phase=phase,
            score=now.score,
            ball=now.used + 1 if phase is Phase.READY else now.used,
            balls=laws.balls,
            on_board=int(np.count_nonzero(self._board_id)),
            combo=rules.running_combo(laws, now, tick),
            multiplier=rules.multiplier(laws, now, tick),
            save_left=0.0 if now.tilted else max(left, 0) / self.tick_rate,
            warnings=now.warnings,
            tilted=now.tilted,
            most_balls=laws.most_balls,
        )

    @property
    def phase(self) -> Phase:
        """Where the game stands."""
        if self._now.over:
            return Phase.OVER
        return Phase.PLAY if self._now.balls else Phase.READY

    @property
    def is_over(self) -> bool:
        """Whether nothing moves any more."""
        return self._now.over

    @property
    def score(self) -> int:
        """Points so far."""
        return self._now.score

    @property
    def table(self) -> Table:
        """The finished table."""
        return self.world.table

    @property
    def seed(self) -> int:
        """Of everything random."""
        return self.world.seed

    @property
    def tick_rate(self) -> int:
        """Ticks per second."""
        return self.world.tick_rate

    @property
    def tick(self) -> int:
        """Ticks so far."""
        return self._words.item(_TICK)

    @property
    def held(self) -> tuple[bool, bool]:
        """The buttons (left, right) as they were pressed in the last tick."""
        return self._left, self._right

    @property
    def has_still_ball(self) -> bool:
        """Whether a ball has been lying still; in free play the player may shove it."""
        return stuck.still_ball(self._watch, self._laws, self.tick)

    def take_world_events(self) -> list[Event]:
        """What happened to balls since this was last asked, at most the last 4,096 events."""
        events = list(self._events)
        self._events.clear()
        return events

    def take_game_events(self) -> list[GameEvent]:
        """What there is to tell since this was last asked."""
        news = list(self._news)
        self._news.clear()
        return news

    # --- what is kept of it
    # -------------------------------------------------------------------------------------------

    @property
    def replay(self) -> Replay:
        """The recording up to now, whole whether or not the game is over.

        Raises:
            SilverballError: Nothing was recorded, or the game was restored to another moment.
        """
        if self._recorder is None:
            raise SilverballError("this game has no replay: it was made without one, or was restored")
        return Replay.of(
            self.world,
            self.mode,
            lines=tuple(self._recorder.lines),
            tail=self._recorder.inputs,
            score=self.score,
            ended=self.ended,
            digest=self.digest(),
        )

    @property
    def ended(self) -> str:
        """How the game ended: "over", "stopped" by `end`, the name of a fault, or "running"."""
        if not self._now.over:
            return "running"
        return self.fault or ("stopped" if self._stopped else "over")

    @property
    def rules_text(self) -> str:
        """All that the game remembers beside the world, as JSON: equal texts, equal rules."""
        watch = self._watch._asdict() | {"rests": [rest._asdict() for rest in self._watch.rests]}
        now = self._now._asdict() | {"balls": [ball._asdict() for ball in self._now.balls]}
        own = {"left": self._left, "right": self._right, "shove": self._shove, "machine": self._machine}
        return json.dumps(now | {"watch": watch} | own, separators=(",", ":"))

    @property
    def short_digests(self) -> str:
        """The short digests of the state as they stand in replays."""
        return short_digests(self._words.tobytes(), self.rules_text)

    def digest(self) -> str:
        """A hash of the whole state: equal digests mean equal games."""
        return full_digest(self._words.tobytes(), self.rules_text)

    def save(self) -> bytes:
        """The whole game as bytes for `restore`; the recording is not among them."""
        return pack_game(self.mode, self.ended, self.world.save(), self.rules_text)

    def restore(self, state: bytes) -> None:
        """Go back or ahead to a saved moment, bit for bit; the game is not recorded any more.

        News and events that were not taken are dropped.

        Raises:
            StateError: The bytes are damaged, or of another table, tick rate or mode; nothing has changed.
        """
        mode, ended, world, text = unpack_game(state)
        if mode != self.mode:
            raise StateError(f"the state is one of {mode} play, this game is {self.mode}")
        now, watch, own = text
        self.world.restore(world)
        self._now, self._watch, self._waits = now, watch, bool(now.waiting)
        self._left, self._right, self._shove, self._machine = own
        self._stopped = ended == "stopped"
        self.fault = self.world.fault
        self._recorder = None
        self._counted, self._world_score = self._counters.tobytes(), self.world.score
        tick = self.tick
        self._next_look = (tick // self._look_ticks + 1) * self._look_ticks
        self._next_second = (tick // self.tick_rate + 1) * self.tick_rate
        self._events.clear()
        self._news.clear()

    # --- how it moves
    # -------------------------------------------------------------------------------------------

    def _press(self, left: bool, right: bool, tick: int) -> None:
        """The buttons change before this tick."""
        if left is not self._left:
            self._note("L")
        if right is not self._right:
            self._note("R")
        if (self._left and not left) or (self._right and not right):
            self._watch = self._watch._replace(released=tick)
        self._left, self._right = left, right

    def _free_ticks(self, count: int) -> int:
        """For how many of these ticks no ball can leave the board, at least 1."""
        if self._waits:
            return 1  # a ball that waits for room may come after every tick
        lowest = min(
            (x for x, ball in zip(self._board_x.tolist(), self._board_id.tolist(), strict=True) if ball),
            default=None,
        )
        if lowest is None:
            return count
        room = (lowest - self._edge) * self._pace - 1.0
        return min(count, LEAP, int(room)) if room >= 1.0 else 1  # a place that is no number has no room

    def _play(self, count: int) -> None:
        """Play ticks in which only hits happen, or one tick in which anything may."""
        before = self._words.copy() if count > 1 else None
        try:
            self._step_world(count)
        except FaultError as error:
            self.fault = error.fault
        counted = self._counters.tobytes()
        if counted != self._counted:
            events = self.world.events
            if before is not None and (
                self.world.events_lost or any(event.kind == "gutter" for event in events)
            ):
                self._play_singly(before, count)
                return
            self._counted = counted
            self._apply(events)
        self._shove = self._machine = False
        if self._waits:
            self._put_back()
        if self.fault is not None:
            self._tell(rules.ended(self._now, self.tick))

    def _play_singly(self, before: Any, count: int) -> None:
        """Go back to where these ticks began and play them one by one; `world.hits` counts them twice."""
        saved = before.view(WORLD)[0]
        for name in WORLD.names or ():
            self._record[name] = saved[name]
        self.fault = None
        for _ in range(count):
            if not self._now.over:
                self._play(1)

    def _step_world(self, count: int) -> None:
        """Move the world; the paddles of a tilted table are dead."""
        shove = self._shove or self._machine
        if self._now.tilted:
            self.world.step(False, False, shove, count)
        else:
            self.world.step(self._left, self._right, shove, count)

    def _apply(self, events: tuple[Event, ...]) -> None:
        """Let the rules see what happened."""
        self._events.extend(events)
        untold = self.world.score - self._world_score  # points of hits that found no room in the log
        self._world_score += untold
        for event in events:
            if event.kind == "hit":
                points = self._points.get(event.part, 0)
                if points:
                    untold -= points
                    self._tell(rules.hit(self._laws, self._now, event.tick, points, event.part))
            elif event.kind == "gutter":
                self._tell(rules.drained(self._laws, self._now, event.tick, event.ball))
        if untold > 0:
            self._tell(rules.hit(self._laws, self._now, self.tick - 1, untold, ""))
        if self.world.events_lost:
            here = self._board_id.tolist()
            for ball in self._now.balls:
                if ball.id and ball.id not in here:
                    self._tell(rules.drained(self._laws, self._now, self.tick - 1, ball.id))

    def _put_back(self) -> None:
        """Put a ball that was saved back on the board, if there is a place for it."""
        while self._waits:
            try:
                ball = self.world.create_ball()
            except (NoRoom, FaultError):
                return  # there will be a place when the other ball has moved on
            self._tell(rules.put_back(self._laws, self._now, self.tick, ball.id))
            self._read_creation()

    def _read_creation(self) -> None:
        """The ball that was just created is an event too; the log shows it behind those of the last tick."""
        self._events.extend(event for event in self.world.events[-1:] if event.kind == "created")
        self._counted = self._counters.tobytes()

    def _look(self, tick: int) -> None:
        """Look whether the machine must shove."""
        self._next_look = tick + self._look_ticks
        places = self._record["ball"][["id", "x", "z"]].tolist()
        balls = [(ball, x, z) for ball, x, z in places if ball]
        self._watch = stuck.looked(self._watch, balls, tick)
        if self.mode is Mode.FREE:
            return
        held = (self._left or self._right) and not self._now.tilted
        quiet_since = self._now.quiet_since if self._scores else None
        if stuck.wants_shove(
            self._watch, self._laws, tick, held=held, reach=self._reach, quiet_since=quiet_since
        ):
            self._machine = True
            self._watch = stuck.shoved(self._watch, tick)
            self._news.append(GameEvent(GameEventKind.UNSTUCK, tick))

    def _end_second(self, tick: int) -> None:
        self._next_second = tick + self.tick_rate
        if self._recorder is not None:
            self._recorder.end_second(self.short_digests)
            if self._recorder.is_full:
                self.end()

    def _note(self, kind: str) -> None:
        if self._recorder is not None:
            self._recorder.note(self.tick, kind)

    def _tell(self, outcome: rules.Outcome) -> None:
        self._now, news = outcome
        self._waits = bool(self._now.waiting)
        self._news.extend(news)
