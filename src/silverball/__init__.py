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
    from silverball.drawing import (
        Renderer as Renderer,
    )
    from silverball.errors import (
        BoardFull as BoardFull,
    )
    from silverball.errors import (
        FaultError as FaultError,
    )
    from silverball.errors import (
        MissingExtra as MissingExtra,
    )
    from silverball.errors import (
        NoDisplay as NoDisplay,
    )
    from silverball.errors import (
        NoRoom as NoRoom,
    )
    from silverball.errors import (
        OutputError as OutputError,
    )
    from silverball.errors import (
        SilverballError as SilverballError,
    )
    from silverball.errors import (
        StateError as StateError,
    )
    from silverball.errors import (
        TableError as TableError,
    )
    from silverball.errors import (
        UnknownTable as UnknownTable,
    )
    from silverball.game.builtin_rules import (
        ArcadeRules as ArcadeRules,
    )
    from silverball.game.builtin_rules import (
        FreeRules as FreeRules,
    )
    from silverball.game.game import (
        Game as Game,
    )
    from silverball.game.replay.format import (
        Replay as Replay,
    )
    from silverball.game.replay.verify import (
        Verdict as Verdict,
    )
    from silverball.game.rules import (
        InPlay as InPlay,
    )
    from silverball.game.rules import (
        RuleConfig as RuleConfig,
    )
    from silverball.game.rules import (
        Rules as Rules,
    )
    from silverball.game.rules import (
        RuleState as RuleState,
    )
    from silverball.game.view import (
        GameEvent as GameEvent,
    )
    from silverball.game.view import (
        GameEventKind as GameEventKind,
    )
    from silverball.game.view import (
        GameView as GameView,
    )
    from silverball.game.view import (
        Mode as Mode,
    )
    from silverball.game.view import (
        Phase as Phase,
    )
    from silverball.table import (
        Table as Table,
    )
    from silverball.table import (
        check_table as check_table,
    )
    from silverball.table import (
        generate_table as generate_table,
    )
    from silverball.table import (
        load_table as load_table,
    )
    from silverball.table import (
        parts as parts,
    )
    from silverball.table import (
        save_table as save_table,
    )
    from silverball.table import (
        table_names as table_names,
    )
    from silverball.world import (
        BallState as BallState,
    )
    from silverball.world import (
        Event as Event,
    )
    from silverball.world import (
        PaddleState as PaddleState,
    )
    from silverball.world import (
        Snapshot as Snapshot,
    )
    from silverball.world import (
        World as World,
    )
    from silverball.world import (
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

__all__ = ["__version__", *_MODULE_OF]  # noqa: PLE0604  (the names are strings)


def __getattr__(name: str) -> Any:
    """Load a public name when it is first asked for."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'silverball' has no attribute {name!r}")
    value = getattr(import_module(_MODULE_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
