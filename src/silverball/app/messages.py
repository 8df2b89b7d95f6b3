"""What is the player told, and for how long? One short message at a time."""

from __future__ import annotations

from silverball.plain import plain

LEAST_SECONDS = 2.2
MOST_SECONDS_IN_PLAY = 2.5  # while a ball needs the player's eyes
SECONDS_PER_LETTER = 0.045  # an unhurried reader; chosen by reading them aloud
FADE_SECONDS = 0.4


class Messages:
    """The message on screen; a new one takes its place, the same one again changes nothing."""

    def __init__(self) -> None:
        self.text = ""
        self._left = 0.0

    def say(self, text: str) -> None:
        """Show a message, with a capital in front (but not of a file's name) and a full stop behind."""
        text = plain(text, keep="\n")
        if "." not in text.split(" ", 1)[0]:
            text = text[:1].upper() + text[1:]
        text = text if text.endswith((".", "!", "?", "…")) else f"{text}."
        if text == self.text and self._left > 0.0:
            return
        self.text = text
        self._left = LEAST_SECONDS + SECONDS_PER_LETTER * len(text)

    def clear(self) -> None:
        """Show none."""
        self._left = 0.0

    def pass_time(self, seconds: float, *, in_play: bool = False) -> None:
        """Let real time pass; while a ball is in play no message stays long."""
        most = MOST_SECONDS_IN_PLAY if in_play else self._left
        self._left = max(0.0, min(self._left, most) - seconds)

    @property
    def strength(self) -> float:
        """How visible the message is: 1, fading to 0."""
        return min(1.0, self._left / FADE_SECONDS)
