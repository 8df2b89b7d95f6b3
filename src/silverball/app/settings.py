"""What can a player choose, and what is chosen if nobody did?

The settings are one frozen model. What is kept on disk may be older, newer or damaged: `Settings.of` takes
every value that still makes sense and the default for the rest, so that a bad value never stops a game.
"""

from __future__ import annotations

from enum import Enum
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    InstanceOf,
    ValidationError,
    model_validator,
)


def _text(value: Any) -> Any:
    """The text of an enum's member: Pydantic 2.7 does not take the one for the other, as later ones do."""
    return value.value if isinstance(value, Enum) else value


class Settings(BaseModel):
    """What a player has chosen."""

    model_config = ConfigDict(frozen=True, extra="ignore", use_attribute_docstrings=True)

    theme: str = "neon"
    """Name of the colours (see `silverball.drawing.themes`)."""
    volume: Annotated[int, Field(ge=0, le=10)] = 7
    """Of all sounds; 0 is silence."""
    muted: bool = False
    """Whether there are no sounds for now."""
    effects: Literal["full", "less"] = "full"
    """Sparks, trails and flashes; "less" for slow machines and sensitive eyes."""
    frame_rate: Literal["screen", "60", "120", "144"] = "screen"
    """Pictures a second; "screen": as many as it shows."""
    full_screen: bool = False
    """Whether the game starts in full screen."""
    # A path may have bytes that are no text, which `str` refuses.
    arcade_table: InstanceOf[str] = "classic"
    """The table that was chosen last for arcade games: a built-in name or a path."""
    free_table: InstanceOf[str] = "original"
    """The same for free play, which begins with the original."""
    mode: Annotated[Literal["arcade", "free"], BeforeValidator(_text)] = "arcade"
    """The game that was chosen last."""
    initials: Annotated[str, Field(pattern=r"^[A-Z0-9 .\-]{3}$")] = "AAA"
    """Entered last, offered again."""
    keys: dict[str, tuple[str, ...]] = {}
    """Keys by action where they differ from the defaults, as `app/keyboard.py` names them."""
    pad: dict[str, tuple[str, ...]] = {}
    """Gamepad buttons by action where they differ from the defaults."""
    joysticks: dict[str, dict[str, tuple[str, ...]]] = {}
    """The same for joysticks that SDL has no common names for, by their GUID."""

    @model_validator(mode="before")
    @classmethod
    def _one_table_for_the_mode(cls, values: dict[str, Any]) -> dict[str, Any]:
        return _with_table_of_mode(values)

    @property
    def table(self) -> str:
        """The table of the game that is chosen."""
        return self.arcade_table if self.mode == "arcade" else self.free_table

    @classmethod
    def of(cls, values: dict[str, Any]) -> Self:
        """The settings in `values`, with the default for every value that is missing or makes no sense."""
        values = _with_table_of_mode(values)
        good = {}
        for name in cls.model_fields:
            if name in values:
                try:
                    good[name] = getattr(cls.model_validate({name: values[name]}), name)
                except ValidationError:
                    continue
        return cls(**good)

    def changed(self, **values: Any) -> Self:
        """These settings with some values changed, checked like all others; `table` is that of the mode."""
        return type(self).model_validate(self.model_dump() | values)


def _with_table_of_mode(values: dict[str, Any]) -> dict[str, Any]:
    """`table` as that of the mode; settings that were kept before each mode had its own have only this."""
    if "table" not in values:
        return values
    mode = values.get("mode", Settings.model_fields["mode"].default)
    return values | {f"{mode}_table": values["table"]}
