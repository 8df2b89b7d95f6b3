"""What does the game sound like? Everything is synthesised at start; nothing is loaded.

`Sounds` (sounds.py) is for a window, `FilmSound` for a film. Sounds are recipes (`recipes.py`, `hits.py`,
`tunes.py`, `rolling.py`) on top of `synth.py`; `bank.py` makes them all at their loudness; `voices.py`
decides which are heard; `mixer.py` plays them.
"""

from silverball.app.sound.mixdown import FilmSound, Frame, mixdown, rolling_balls, write_wav
from silverball.app.sound.rolling import RollingBall
from silverball.app.sound.sounds import Sounds

__all__ = ["FilmSound", "Frame", "RollingBall", "Sounds", "mixdown", "rolling_balls", "write_wav"]
