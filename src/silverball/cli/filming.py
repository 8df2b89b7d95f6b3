"""Records a session to a film or a picture, for `demo` and `replay`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from silverball.cli.console import print_lines
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.app.sessions import Session
    from silverball.app.sound.mixdown import FilmSound
    from silverball.drawing import Renderer
    from silverball.export.film import Picture
    from silverball.table import Table

ENDINGS = (".gif", ".mp4", ".png")
HEIGHTS = {".gif": 720, ".mp4": 1152, ".png": 1152}  # [pixel] default heights
GIF_LIMIT = (
    600_000_000  # pixels of all pictures together; a GIF is compressed in memory, at 1 to 2 bytes each
)


def film_size(out: Path, table: Table, seconds: float, height: int | None) -> tuple[int, int]:
    """Return width and height [pixel] of a film of a table.

    Raises:
        OutputError: A GIF of that size and length would be too large.
    """
    from silverball.drawing import best_size
    from silverball.errors import OutputError
    from silverball.export.film import FILM_RATES

    ending = out.suffix.lower()
    size = best_size(table.board, height or HEIGHTS[ending])
    if ending == ".gif" and size[0] * size[1] * seconds * FILM_RATES[ending] > GIF_LIMIT:
        raise OutputError(
            f"{out}: a GIF of {seconds:g} s at {size[0]} × {size[1]} pixels is too large to make; "
            "use fewer --seconds, a smaller --size, or an .mp4"
        )
    return size


def record(
    out: Path,
    session: Session,
    renderer: Renderer,
    seconds: float,
    *,
    theme: str = "neon",
    has_music: bool = True,
    quiet: bool = False,
) -> None:
    """Record a session to a file with a progress bar: a GIF, an MP4 with sound, or its last moment as PNG.

    Args:
        out: File to write; its ending selects the format.
        session: The session to record.
        renderer: A renderer of its table.
        seconds: Length of the recording [s].
        theme: Name of the theme, which has a sound set of its own.
        has_music: Whether an MP4 has music.
        quiet: Whether not to print the name of the file.
    """
    from rich.markup import escape
    from rich.progress import Progress

    from silverball.app.sound.mixdown import FilmSound
    from silverball.app.sound.sound_sets import sound_set
    from silverball.cli.console import error_console
    from silverball.export.film import FILM_RATES, write_film, write_picture

    ending = out.suffix.lower()
    with Progress(console=error_console, transient=True, disable=not error_console.is_terminal) as bar:
        task = bar.add_task(f"playing into {escape(plain(out.name))}", total=seconds)

        def advance(done: float) -> None:
            bar.update(task, completed=done)

        rate = FILM_RATES.get(ending, FILM_RATES[".mp4"])
        sound = None
        if ending == ".mp4":
            game = session.game
            sound = FilmSound(game.table, game.tick_rate, rate, sound_set(theme), has_music=has_music)
        pictures = session_pictures(
            session, renderer, seconds, rate, advance, sound, only_last=ending == ".png"
        )
        if ending == ".png":
            write_picture(out, next(pictures))
        else:
            write_film(out, pictures, sound.track if sound is not None else None)
    if not quiet:
        print_lines(f"wrote {out}")


def session_pictures(
    session: Session,
    renderer: Renderer,
    seconds: float,
    rate: float,
    advance: Callable[[float], None],
    sound: FilmSound | None = None,
    *,
    only_last: bool = False,
) -> Iterator[Picture]:
    """Advance a session and yield its pictures.

    Args:
        session: The session to record.
        renderer: A renderer of its table.
        seconds: Length of the recording [s].
        rate: Pictures per second.
        advance: Called after each picture with the recorded time [s].
        sound: Collects the sound of each picture.
        only_last: Whether to yield the last picture only.
    """
    from silverball.app.announcements import TableWords
    from silverball.app.controls import PaddleInput
    from silverball.app.score_display import ScoreDisplay
    from silverball.drawing import Moment

    no_buttons = PaddleInput((False, False), (False, False))
    display, world = ScoreDisplay(words=TableWords.of(session.game.table)), session.game.world
    start, count = world.tick, max(round(seconds * rate), 1)
    for number in range(1, count + 1):
        session.advance(no_buttons, start + round(number * world.tick_rate / rate) - world.tick)
        events, game_events = session.game.take_world_events(), session.game.take_game_events()
        display.add_events(game_events)
        renderer.add_events(events, world.tick_rate)
        renderer.add_game_events(game_events, world.tick_rate)
        if sound is not None:
            game = session.game
            sound.add_picture(world, events, (*game.held, game.is_launch_held), game_events, game)
        dots = display.frame(session.game.view, number / rate, modes=session.game.modes)
        moment = Moment.of_game(session.game)
        if not only_last or number == count:
            yield renderer.array(moment, dots)
        else:
            for _ in renderer.effects.trails(moment):
                pass  # the trails are recorded for the last picture
        advance(number / rate)
