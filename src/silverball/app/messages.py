"""What is the player told, and for how long? One short message at a time."""

from __future__ import annotations

LEAST_SECONDS = 2.2
SECONDS_PER_LETTER = 0.045  # an unhurried reader; chosen by reading them aloud
FADE_SECONDS = 0.4


class Messages:
    """The message on screen; a new one takes its place."""

    def __init__(self) -> None:
        self.text = ""
        self._left = 0.0

    def say(self, text: str) -> None:
        """Show a message; its first letter is made a capital, a full stop is added."""
        text = text[:1].upper() + text[1:]
        self.text = text if text.endswith((".", "!", "?", "…")) else f"{text}."
        self._left = LEAST_SECONDS + SECONDS_PER_LETTER * len(text)

    def clear(self) -> None:
        """Show none."""
        self._left = 0.0

    def pass_time(self, seconds: float) -> None:
        """Let real time pass."""
        self._left = max(0.0, self._left - seconds)

    @property
    def strength(self) -> float:
        """How visible the message is: 1, fading to 0."""
        return min(1.0, self._left / FADE_SECONDS)
