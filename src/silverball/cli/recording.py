"""How does play become a film or a picture in a file? The same way for `demo` and for `replay`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from silverball.cli.say import say
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.app.sessions import Session
    from silverball.app.sound.mixdown import FilmSound
    from silverball.drawing import Renderer
    from silverball.export.film import Picture
    from silverball.table import Table

ENDINGS = (".gif", ".mp4", ".png")
HEIGHTS = {".gif": 720, ".mp4": 1152, ".png": 1152}  # [pixel] if no size is asked for
GIF_LIMIT = 600_000_000  # pixels of all pictures together: a GIF is packed in memory, a byte or two for each


def film_size(out: Path, table: Table, seconds: float, height: int | None) -> tuple[int, int]:
    """Width and height [pixel] of a film of a table.

    Raises:
        OutputError: A GIF of that size would be too large.
    """
    from silverball.drawing import best_size
    from silverball.errors import OutputError
    from silverball.export.film import FILM_RATES

    ending = out.suffix.lower()
    size = best_size(table.board, height or HEIGHTS[ending])
    if ending == ".gif" and size[0] * size[1] * seconds * FILM_RATES[ending] > GIF_LIMIT:
        raise OutputError(
            f"{out}: a GIF of {seconds:g} s at {size[0]} × {size[1]} pixels is too large to make; "
            "ask for fewer --seconds, a smaller --size, or an .mp4"
        )
    return size


def shoot(out: Path, stage: Session, renderer: Renderer, seconds: float, *, quiet: bool = False) -> None:
    """Film what goes on on a stage with a moving line, and say where it is; of a PNG only the last moment.

    An MP4 has the sounds of the game.
    """
    from rich.markup import escape
    from rich.progress import Progress

    from silverball.app.sound.mixdown import FilmSound
    from silverball.cli.console import errors
    from silverball.export.film import FILM_RATES, write_film, write_picture

    ending = out.suffix.lower()
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        task = bar.add_task(f"playing into {escape(plain(out.name))}", total=seconds)

        def advance(done: float) -> None:
            bar.update(task, completed=done)

        rate = FILM_RATES.get(ending, FILM_RATES[".mp4"])
        sound = FilmSound(stage.game.table, stage.game.tick_rate, rate) if ending == ".mp4" else None
        pictures = filmed(stage, renderer, seconds, rate, advance, sound, only_last=ending == ".png")
        if ending == ".png":
            write_picture(out, next(pictures))
        else:
            write_film(out, pictures, sound.track if sound is not None else None)
    if not quiet:
        say(f"wrote {out}")


def filmed(
    stage: Session,
    renderer: Renderer,
    seconds: float,
    rate: float,
    advance: Callable[[float], None],
    sound: FilmSound | None = None,
    *,
    only_last: bool = False,
) -> Iterator[Picture]:
    """The pictures of what goes on on a stage.

    Args:
        stage: Is moved on.
        renderer: Of its table.
        seconds: How long.
        rate: Pictures for every second of play.
        advance: Told after each picture how many seconds are done.
        sound: Collects what is heard.
        only_last: Whether only the last picture is wanted.
    """
    from silverball.app.controls import Held
    from silverball.app.score_display import ScoreDisplay
    from silverball.drawing import Moment

    nothing = Held((False, False), (False, False))
    display, world = ScoreDisplay(), stage.game.world
    start, count = world.tick, max(round(seconds * rate), 1)
    for number in range(1, count + 1):
        stage.advance(nothing, start + round(number * world.tick_rate / rate) - world.tick)
        events, news = stage.game.take_events(), stage.game.take_news()
        display.add_events(news)
        renderer.note(events, world.tick_rate)
        if sound is not None:
            sound.add_picture(world, events, stage.game.held, news)
        dots, moment = display.frame(stage.game.face, number / rate), Moment.of(world)
        if not only_last or number == count:
            yield renderer.array(moment, dots)
        else:
            for _ in renderer.effects.trails(moment):
                pass  # they remember the way of the balls
        advance(number / rate)
