"""What becomes of an action before it presses buttons: sticky actions, and coils that share a power supply.

    with the probability `sticky` the action of the last step is executed again
    → a stroke lifts one paddle, and none is lifted for `recharge` after it; a lifted one may be held

Without them a fixed rhythm makes a good score, which a learner finds before it learns to look: a paddle that
buzzes is up when the ball comes, whoever presses. With one charge for both coils a stroke has a price, the
next one, and must be aimed: at the moment, and at the side where the ball comes down. If both buttons are
pressed in one step, chance chooses the paddle. Sticky actions keep a memorised sequence of buttons from
meeting the same game again.
Sources: M. C. Machado and others, "Revisiting the Arcade Learning Environment", JAIR 61 (2018), for sticky
actions; the supply is ours, chosen by `silverball bench blind` (docs/benchmark.md says what else was tried).

Chance is a function of the world's seed and tick, so it is saved, copied and restored with the world.
"""

from __future__ import annotations

from typing import Any

from silverball.envs import pointers as views
from silverball.envs.pointers import Pointers
from silverball.envs.state import ControlRecord, RulesRecord
from silverball.physics.kernel import inlined, internal
from silverball.physics.portable_math import WORD, threefry
from silverball.physics.records import LEFT, RIGHT, WorldRecord

CONTROL_KEY = 0x571C4  # makes these numbers independent of the world's others


@internal
def executed_buttons(ptr: Pointers, rules: RulesRecord, index: int, chosen: int) -> int:
    """The buttons that an environment holds in this step when an agent has chosen these; stores them."""
    control, world = views.controls(ptr)[index], views.worlds(ptr)[index]
    low, high = world.seed & WORD, (world.seed >> 32) & WORD
    repeats, side = threefry(low ^ CONTROL_KEY, high, world.tick & WORD, (world.tick >> 32) & WORD)
    bits = control.action if repeats < rules.sticky_below else chosen
    if rules.recharge_ticks != 0:
        strokes = bits & ~control.action & (LEFT | RIGHT)
        if strokes != 0 and world.tick < control.ready:
            bits &= ~strokes
        elif strokes != 0:
            control.ready = world.tick + rules.recharge_ticks
            if strokes == LEFT | RIGHT:
                bits &= ~(LEFT if side & 1 != 0 else RIGHT)
    control.action = bits
    return int(bits)


@inlined
def clear_controls(control: ControlRecord) -> None:
    """Set what the buttons remember when an episode begins: nothing is held, the supply is charged."""
    control.action, control.ready = 0, 0


@internal
def write_supply(control: ControlRecord, rules: RulesRecord, world: WorldRecord, row: Any) -> None:
    """Write how far the power supply is charged into a row of an observation."""
    left = max(0, control.ready - world.tick)
    row[rules.supply_at] = 1.0 - min(1.0, left / rules.recharge_ticks)
