"""The music of a window: the next bar always waits behind the one that plays, on one channel of the mixer.

The mixer continues with the waiting bar at the very sample at which the last one ends. A thread makes the
bars, some milliseconds each; when the mood changes, the waiting bar is replaced by one in the new mood. So
moods change at the end of a bar, and no frame waits for the music.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from silverball.app.sound.music import Band, Mood, Place
from silverball.background_thread import BackgroundThread

if TYPE_CHECKING:
    from silverball.app.sound.bank import Samples
    from silverball.app.sound.mixer import Mixer, MusicBar


class _Made(NamedTuple):
    """A bar that the thread has made, and what it follows."""

    place: Place
    before: Place | None
    bar: MusicBar
    game: int  # of which it is the music


class MusicPlayer:
    """Plays a band through a mixer.

    Attributes:
        mood: The mood of the bar that plays; None: there is no music.
        is_playing: Whether music plays.
    """

    def __init__(self) -> None:
        self._new_band: Callable[[], Band] | None = None
        self._band: Band | None = None
        self._thread: BackgroundThread | None = None
        self._made: _Made | None = None
        self._error: Exception | None = None
        self._bars: dict[int, Place] = {}  # what plays and what waits, by the identity of its sound
        self._playing: Place | None = None
        self._waiting: Place | None = None
        self._game = 0

    @property
    def is_playing(self) -> bool:
        """Whether music plays."""
        return self._playing is not None

    @property
    def mood(self) -> Mood | None:
        """The mood of the bar that plays; None: there is no music."""
        return None if self._playing is None else self._playing.mood

    def begin(self, new_band: Callable[[], Band]) -> None:
        """Let another band play from the next start; it is made in the thread."""
        self._new_band = new_band
        self._game += 1

    def stop(self, mixer: Mixer, milliseconds: int) -> None:
        """Fade out."""
        if self._playing is not None:
            mixer.stop_music(milliseconds)
        self._playing = self._waiting = None
        self._bars = {}

    def update(self, mixer: Mixer, mood: Mood) -> None:
        """Keep the music going in a mood; call it in every frame."""
        self._follow(mixer)
        made = self._take()
        if made is not None and made.before == self._playing and made.game == self._game:
            if self._playing is None:
                mixer.play_music(made.bar)
                self._playing = made.place
            else:
                mixer.queue_music(made.bar)
                self._waiting = made.place
            self._bars[id(made.bar)] = made.place
        wanted = self._wanted(mood)
        if wanted is not None and self._thread is None:
            self._start(mixer, wanted)

    def wait(self) -> None:
        """Wait for the thread."""
        if self._thread is not None:
            self._thread.join()

    def _follow(self, mixer: Mixer) -> None:
        """Note which bar plays now."""
        if self._playing is None:
            return
        bar = mixer.music
        if bar is None:  # the next one came too late, or the device stood still
            self._playing = self._waiting = None
            self._bars = {}
            return
        place = self._bars.get(id(bar))
        if place is not None and place == self._waiting:
            self._playing, self._waiting = place, None
            self._bars = {id(bar): place}

    def _wanted(self, mood: Mood) -> Place | None:
        """The bar that is to be made; None: all is there."""
        if self._playing is None:
            return Place(0, mood)
        following = Place(self._playing.number + 1, mood)
        return None if self._waiting == following else following

    def _take(self) -> _Made | None:
        """What the thread has made, once it has ended."""
        if self._thread is None or self._thread.is_alive():
            return None
        self._thread = None
        made, self._made = self._made, None
        if self._error is not None:
            raise self._error
        return made

    def _start(self, mixer: Mixer, place: Place) -> None:
        before, game = self._playing, self._game
        new_band, self._new_band = self._new_band, None

        def make() -> None:
            try:
                if new_band is not None:
                    self._band = new_band()
                assert self._band is not None
                samples: Samples = self._band.bar(place, before)
                self._made = _Made(place, before, mixer.music_bar(samples), game)
            except Exception as error:  # it is raised where the sounds of a window handle it
                self._error = error

        self._thread = BackgroundThread(make, "music")
        self._thread.start()
