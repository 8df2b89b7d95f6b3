"""Sound: everything is synthesised at start; nothing is loaded from files.

`Sounds` plays sounds for a window, `FilmSound` collects them for a film. Sounds are recipes (`hits.py`,
`tunes.py`, `rolling.py`) on top of `synth.py`; `bank.py` makes them all at the right loudness; `voices.py`
selects them; `mixer.py` plays them.
"""

from silverball.app.sound.mixdown import FilmSound, Frame, mixdown, rolling_balls, write_wav
from silverball.app.sound.rolling import RollingBall
from silverball.app.sound.sounds import Sounds

__all__ = ["FilmSound", "Frame", "RollingBall", "Sounds", "mixdown", "rolling_balls", "write_wav"]
