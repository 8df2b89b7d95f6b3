"""The player's settings: the model with its defaults, and the one object that owns the current ones.

`Settings` is a frozen model. Stored values may be older, newer or damaged: `Settings.of` uses every valid
value and the default for the rest, so a bad value never stops a game.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeAlias

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    InstanceOf,
    ValidationError,
    model_validator,
)

from silverball.app.cabinet_mode import CabinetMode

if TYPE_CHECKING:
    from silverball.game.scores.store import Store


def _text(value: Any) -> Any:
    """The value of an enum member: unlike later versions, Pydantic 2.7 does not accept the member itself."""
    return value.value if isinstance(value, Enum) else value


class Settings(BaseModel):
    """The choices of a player."""

    model_config = ConfigDict(frozen=True, extra="ignore", use_attribute_docstrings=True)

    theme: str = "neon"
    """Name of the colour theme (see `silverball.drawing.themes`)."""
    volume: Annotated[int, Field(ge=0, le=10)] = 7
    """Volume of all sounds; 0 is silence."""
    music: Annotated[int, Field(ge=0, le=10)] = 7
    """Volume of the music among all sounds; 0 is none."""
    muted: bool = False
    """Whether all sounds are off."""
    effects: Literal["full", "less"] = "full"
    """Sparks, trails and flashes; "less" for slow machines and sensitive eyes."""
    frame_rate: Literal["screen", "60", "120", "144"] = "screen"
    """Frames per second; "screen": the refresh rate of the screen."""
    cabinet: Annotated[CabinetMode, BeforeValidator(_text)] = CabinetMode.OFF
    """Whether the game runs in a cabinet, and how the picture stands on its screen."""
    full_screen: bool = False
    """Whether the game starts in full screen."""
    # A path may contain bytes that are not valid text, which `str` rejects.
    arcade_table: InstanceOf[str] = "silver_comet"
    """The table chosen last for arcade games: a built-in name or a path."""
    free_table: InstanceOf[str] = "original"
    """The table chosen last for free play, at first the original."""
    mode: Annotated[Literal["arcade", "free"], BeforeValidator(_text)] = "arcade"
    """The mode chosen last."""
    initials: Annotated[str, Field(pattern=r"^[A-Z0-9 .\-]{3}$")] = "AAA"
    """The initials entered last, suggested for the next score."""
    dot_game_best: Annotated[int, Field(ge=0)] = 0
    """The best score of the tiny game that is played while the physics is compiled."""
    is_guided: bool = False
    """Whether the hints of the first game have been given."""
    keys: dict[str, tuple[str, ...]] = {}
    """Keys by action where they differ from the defaults, by the names of `app/keyboard.py`."""
    pad: dict[str, tuple[str, ...]] = {}
    """Gamepad buttons by action where they differ from the defaults."""
    joysticks: dict[str, dict[str, tuple[str, ...]]] = {}
    """The same for joysticks without a gamepad mapping in SDL, by GUID."""

    @model_validator(mode="before")
    @classmethod
    def _one_table_for_the_mode(cls, values: dict[str, Any]) -> dict[str, Any]:
        return _with_table_of_mode(values)

    @property
    def table(self) -> str:
        """The table of the chosen mode."""
        return self.arcade_table if self.mode == "arcade" else self.free_table

    @classmethod
    def of(cls, values: dict[str, Any]) -> Self:
        """Return the settings in `values`, with the default for every value that is missing or invalid."""
        values = _with_table_of_mode(values)
        valid = {}
        for name in cls.model_fields:
            if name in values:
                try:
                    valid[name] = getattr(cls.model_validate({name: values[name]}), name)
                except ValidationError:
                    continue
        return cls(**valid)

    def changed(self, **values: Any) -> Self:
        """Return validated settings with some values changed; `table` is the one of the chosen mode."""
        return type(self).model_validate(self.model_dump() | values)


SettingsCallback: TypeAlias = Callable[[Settings, Settings], None]


class PlayerSettings:
    """The owner of the settings: all other code reads `current` and subscribes to changes.

    Args:
        current: The settings at the start.
        store: Store that changes are saved in; None: they are not saved. While another program locks it,
            the stored settings are unknown, and only changed values are saved.
    """

    def __init__(self, current: Settings, store: Store | None = None) -> None:
        self.current = current
        self._store = store
        self._is_unread = store is not None and store.is_unreadable
        self._callbacks: list[SettingsCallback] = []

    def subscribe(self, callback: SettingsCallback) -> None:
        """Call `callback(before, after)` after every change."""
        self._callbacks.append(callback)

    def change(self, **values: Any) -> None:
        """Change some values and save them."""
        self.replace(self.current.changed(**values))

    def replace(self, settings: Settings) -> None:
        """Replace all settings and save them."""
        before, self.current = self.current, settings
        if self._store is not None:
            values, old = settings.model_dump(mode="json"), before.model_dump(mode="json")
            if self._is_unread:
                values = {name: value for name, value in values.items() if value != old[name]}
            self._store.save_settings(values)
        self._notify(before)

    def read_when_unlocked(self) -> bool:
        """Read the stored settings once the store is no longer locked; the chosen table and mode stay.

        Returns:
            Whether they were read just now.
        """
        if not self._is_unread or self._store is None or self._store.has_pending:
            return False
        self._is_unread = False
        before = self.current
        stored = Settings.of(self._store.settings())
        self.current = stored.changed(table=before.table, mode=before.mode)
        self._notify(before)
        return True

    def _notify(self, before: Settings) -> None:
        for callback in self._callbacks:
            callback(before, self.current)


def _with_table_of_mode(values: dict[str, Any]) -> dict[str, Any]:
    """Assign `table` to the chosen mode; older settings have only one table for both modes."""
    if "table" not in values:
        return values
    mode = values.get("mode", Settings.model_fields["mode"].default)
    return values | {f"{mode}_table": values["table"]}
