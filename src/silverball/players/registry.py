"""Players by name: the built-in ones, those registered in Python, and those of installed packages.

A player is an object with a method `press(world)`. `register` adds one from Python; a package adds one with
an entry point in the group `silverball.players`, which is imported when it is first needed. All of them are
used by name: in `make_player`, `rollout.play` and `metrics.ball_time.time_balls`, wherever the command line
takes a `--player`, and under WATCH in the menu.
"""

from __future__ import annotations

import difflib
import inspect
import re
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from importlib.metadata import EntryPoint, entry_points
from threading import RLock
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from silverball.errors import SilverballError

if TYPE_CHECKING:  # the menu lists players before the compiler is loaded
    from silverball.world import World, WorldBatch

ENTRY_POINT_GROUP = "silverball.players"
NAME = re.compile("[a-z][a-z0-9_-]{0,19}")


class Player(Protocol):
    """Presses the buttons of one world."""

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick.

        Args:
            world: Only read it. In a rollout it is a copy, so changes have no effect.
        """


@runtime_checkable
class BatchPlayer(Protocol):
    """A player that can also press the buttons of many worlds in one call, which is faster."""

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick."""

    def press_batch(self, batch: WorldBatch) -> NDArray[np.bool_]:
        """The buttons (left, right) to hold in the next tick of every world, bool [world, 2].

        Args:
            batch: Only read it: these are the worlds that are played.
        """


Factory = Callable[..., Player]
"""Makes a player; called without arguments, or with `seed=` if it has a parameter of that name."""


class PlayerError(SilverballError):
    """A registered player cannot be used: its factory or one of its methods failed."""


_registered: dict[str, Factory] = {}  # by `register`, and from entry points once they have been imported
_refused: set[str] = set()  # entry points that a warning has been given about
_lock = RLock()  # the window imports entry points in a thread


def register(name: str, factory: Factory) -> None:
    """Add a player under a new name.

    Args:
        name: A lower-case letter, then up to 19 lower-case letters, digits, `_` or `-`.
        factory: Makes one player, for example its class. Called without arguments, or with `seed=` (of the
            world, an integer ≥ 0) if it has a parameter of that name.

    Raises:
        PlayerError: The name is taken or malformed, or the factory cannot be called.

    Examples:
        >>> from silverball import World, players
        >>> class Lefty:
        ...     def press(self, world):
        ...         return any(ball.position[0] < -6.0 for ball in world.balls), False
        >>> players.register("lefty", Lefty)
        >>> players.make_player("lefty").press(World("classic"))
        (False, False)
        >>> players.unregister("lefty")
    """
    with _lock:
        _check_registration(name, factory)
        _registered[name] = factory


def unregister(name: str) -> None:
    """Remove a registered player.

    Raises:
        PlayerError: No player has been registered under that name.
    """
    with _lock:
        if _registered.pop(name, None) is None:
            raise PlayerError(f"no player {name!r} has been registered")


def player_names() -> tuple[str, ...]:
    """The names of all players: built-in, registered, then those of installed packages.

    Imports the entry points that have not been imported yet. One that cannot be used is skipped, with one
    warning.
    """
    with _lock:
        for entry in entry_points(group=ENTRY_POINT_GROUP):
            if entry.name in _registered or entry.name in _refused:
                continue
            try:
                _import(entry)
            except PlayerError as error:
                _refused.add(entry.name)
                warnings.warn(f"{error}; it is skipped", stacklevel=2)
        return *BUILT_IN, *_registered


def registered_names() -> tuple[str, ...]:
    """The names of the players registered so far; imports nothing."""
    return tuple(_registered)


def registered_factory(name: str) -> Factory:
    """The factory of a registered player, for processes that do not know it.

    Raises:
        PlayerError: No player has been registered under that name, or its entry point cannot be imported.
    """
    return _factory(name)


def check_name(name: str, others: Sequence[str] = ()) -> None:
    """Refuse a name that no player has.

    Args:
        name: The name.
        others: Further names that are allowed where it was given.

    Raises:
        PlayerError: The name is unknown, or its entry point cannot be imported.
    """
    if name not in (*BUILT_IN, *others):
        _factory(name, others)


def make_player(name: str, seed: int = 0) -> Player:
    """A player for a single world.

    Args:
        name: "idle" (presses nothing), "random" (holds and releases at random), "blind" (a fixed rhythm),
            "reflex" (hits what comes), "hold" (keeps both paddles up), "planner" (plays copies of the world
            ahead), "trained" (asks a small network), or the name of a registered player.
        seed: For the factory of a registered player. Built-in players use the world's seed.

    Raises:
        PlayerError: No player has that name, or it cannot be created.
    """
    if name in BUILT_IN:
        return BUILT_IN[name]()
    return CheckedPlayer(name, seed)


class CheckedPlayer:
    """A registered player whose failures and invalid results raise `PlayerError`.

    Args:
        name: Under which it was registered.
        seed: For its factory.

    Attributes:
        name: Under which it was registered.
        has_batch_form: Whether it can press the buttons of a whole batch.

    Raises:
        PlayerError: The player cannot be created.
    """

    def __init__(self, name: str, seed: int) -> None:
        self.name = name
        factory = _factory(name)
        try:
            self._player = factory(seed=seed) if _takes_seed(factory) else factory()
        except Exception as error:
            raise PlayerError(f"player {name!r}: its factory raised {_shown(error)}") from error
        if not callable(getattr(self._player, "press", None)):
            raise PlayerError(
                f"player {name!r}: its factory must return an object with a method press(world), "
                f"got {type(self._player).__name__}"
            )
        self.has_batch_form = isinstance(self._player, BatchPlayer)

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick.

        Raises:
            PlayerError: The player failed, or answered something else.
        """
        pressed = self._answer("press", world)
        if (
            not isinstance(pressed, tuple | list | np.ndarray)
            or len(pressed) != 2
            or not all(isinstance(button, bool | np.bool_) for button in pressed)
        ):
            raise PlayerError(
                f"player {self.name!r}: press() must return two booleans (left, right), got {pressed!r:.80}"
            )
        return bool(pressed[0]), bool(pressed[1])

    def press_batch(self, batch: WorldBatch) -> NDArray[np.bool_]:
        """The buttons (left, right) to hold in the next tick of every world, bool [world, 2].

        Raises:
            PlayerError: The player failed, or answered something else.
        """
        pressed = self._answer("press_batch", batch)
        is_array = isinstance(pressed, np.ndarray)
        if not is_array or pressed.dtype != np.bool_ or pressed.shape != (batch.count, 2):
            got = f"{pressed.dtype} {pressed.shape}" if is_array else f"{pressed!r:.80}"
            raise PlayerError(
                f"player {self.name!r}: press_batch() must return a boolean array of shape "
                f"({batch.count}, 2), got {got}"
            )
        boolean: NDArray[np.bool_] = pressed
        return boolean

    def _answer(self, method: str, worlds: World | WorldBatch) -> Any:
        try:
            return getattr(self._player, method)(worlds)
        except Exception as error:
            raise PlayerError(f"player {self.name!r}: {method}() raised {_shown(error)}") from error


def _factory(name: str, others: Sequence[str] = ()) -> Factory:
    """The factory of a registered player; imports its entry point."""
    with _lock:
        if name not in _registered:
            for entry in entry_points(group=ENTRY_POINT_GROUP, name=name):
                _import(entry)
                break
        if name in _registered:
            return _registered[name]
    names = (*player_names(), *others)
    near = difflib.get_close_matches(name, names, 1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise PlayerError(f"no player is called {name!r}; there are {', '.join(names)}{hint}")


def _import(entry: EntryPoint) -> None:
    """Import an entry point and register its factory."""
    package = entry.dist.name if entry.dist else "an installed package"
    try:
        factory = entry.load()
    except Exception as error:
        raise PlayerError(
            f"player {entry.name!r} of {package}: {entry.value} cannot be imported, {_shown(error)}"
        ) from error
    try:
        _check_registration(entry.name, factory)
    except PlayerError as error:
        raise PlayerError(f"player {entry.name!r} of {package}: {error}") from None
    _registered[entry.name] = factory


def _check_registration(name: str, factory: Any) -> None:
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise PlayerError(
            "a player's name must be a lower-case letter and up to 19 lower-case letters, digits, _ or -, "
            f"got {name!r:.80}"
        )
    if name in BUILT_IN:
        raise PlayerError(f"the name {name!r} is taken by a built-in player; choose another name")
    if name in _registered:
        raise PlayerError(f"the name {name!r} is taken; choose another name, or unregister({name!r}) first")
    if not callable(factory):
        raise PlayerError(f"the factory of player {name!r} must be callable, got {factory!r:.80}")


def _takes_seed(factory: Factory) -> bool:
    try:
        return "seed" in inspect.signature(factory).parameters
    except (TypeError, ValueError):  # a callable written in C may have no signature
        return False


def _shown(error: Exception) -> str:
    """An exception on one line."""
    words = " ".join(str(error).split())
    return f"{type(error).__name__}: {words}" if words else type(error).__name__


def _simple(name: str) -> Player:
    from silverball.players.simple import SimplePlayer

    return SimplePlayer(name)


def _planner() -> Player:
    from silverball.players.planner import Planner

    return Planner()


def _trained() -> Player:
    from silverball.players.trained import Trained

    return Trained()


BUILT_IN: dict[str, Callable[[], Player]] = {
    **{name: partial(_simple, name) for name in ("idle", "random", "blind", "reflex", "hold")},
    "planner": _planner,
    "trained": _trained,
}
"""Factories of the players that come with the package."""
