"""A pinball table in Python: exact, fast and deterministic.

    import silverball as sb

    world = sb.World("classic", seed=7)
    world.create_ball()
    world.step(left=True, ticks=24)

Every public name is reachable from here and loaded on first use, so `import silverball` is fast.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from silverball import players as players
    from silverball.drawing import (
        Renderer as Renderer,
    )
    from silverball.errors import (
        BoardFull as BoardFull,
        FaultError as FaultError,
        MissingExtra as MissingExtra,
        NoDisplay as NoDisplay,
        NoRoom as NoRoom,
        OutputError as OutputError,
        SilverballError as SilverballError,
        StateError as StateError,
        TableError as TableError,
        UnknownTable as UnknownTable,
    )
    from silverball.game.builtin_rules import (
        ArcadeRules as ArcadeRules,
        FreeRules as FreeRules,
    )
    from silverball.game.game import (
        Game as Game,
    )
    from silverball.game.game_batch import (
        GameBatch as GameBatch,
        GameSnapshot as GameSnapshot,
    )
    from silverball.game.replay.format import (
        Replay as Replay,
    )
    from silverball.game.replay.verify import (
        Verdict as Verdict,
    )
    from silverball.game.rules import (
        InPlay as InPlay,
        RuleConfig as RuleConfig,
        Rules as Rules,
        RuleState as RuleState,
    )
    from silverball.game.view import (
        GameEvent as GameEvent,
        GameEventKind as GameEventKind,
        GameView as GameView,
        Mode as Mode,
        Phase as Phase,
    )
    from silverball.table import (
        Table as Table,
        check_table as check_table,
        generate_table as generate_table,
        load_table as load_table,
        parts as parts,
        save_table as save_table,
        table_names as table_names,
    )
    from silverball.world import (
        BallState as BallState,
        Event as Event,
        PaddleState as PaddleState,
        Snapshot as Snapshot,
        World as World,
        WorldBatch as WorldBatch,
    )

__version__ = "0.1.0"

_HOME = {
    "silverball.drawing": ("Renderer",),
    "silverball.errors": (
        "BoardFull", "FaultError", "MissingExtra", "NoDisplay", "NoRoom", "OutputError", "SilverballError",
        "StateError", "TableError", "UnknownTable",
    ),
    "silverball.game.builtin_rules": ("ArcadeRules", "FreeRules"),
    "silverball.game.game": ("Game",),
    "silverball.game.game_batch": ("GameBatch", "GameSnapshot"),
    "silverball.game.replay.format": ("Replay",),
    "silverball.game.replay.verify": ("Verdict",),
    "silverball.game.rules": ("InPlay", "RuleConfig", "Rules", "RuleState"),
    "silverball.game.view": ("GameEvent", "GameEventKind", "GameView", "Mode", "Phase"),
    "silverball.table": (
        "Table", "check_table", "generate_table", "load_table", "parts", "save_table", "table_names",
    ),
    "silverball.world": ("BallState", "Event", "PaddleState", "Snapshot", "World", "WorldBatch"),
}  # fmt: skip
_MODULE_OF = {name: module for module, names in _HOME.items() for name in names}

__all__ = ["__version__", "players", *_MODULE_OF]  # noqa: PLE0604  (the names are strings)


if not TYPE_CHECKING:  # a type checker reads the imports above, and so finds names that do not exist

    def __getattr__(name: str) -> Any:
        """Load a public name when it is first asked for."""
        if name == "players":
            return import_module("silverball.players")
        if name not in _MODULE_OF:
            raise AttributeError(f"module 'silverball' has no attribute {name!r}")
        value = getattr(import_module(_MODULE_OF[name]), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
