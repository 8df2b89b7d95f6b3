"""The numbers of a game on a table, with durations in ticks."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Self

if TYPE_CHECKING:
    from silverball.table import Table

NO_COMBOS = -1  # `combo_ticks` of rules without combos


class RuleConfig(NamedTuple):
    """The numbers of one game, with durations in ticks; see `silverball.table.Arcade` for their meaning.

    Attributes:
        balls: Balls of the whole game; 0 means any number.
        max_balls: The most balls on the board at once.
        save_ticks: A ball lost within this time after its start is returned [ticks].
        saves: How often one ball is returned.
        combo_ticks: Time for the next hit of a combo [ticks]; `NO_COMBOS`: there are no combos.
        combo_step: Hits in a row that raise the multiplier by one.
        combo_limit: Greatest multiplier of a combo.
        double: Multiplier while two or more balls are in play.
        tilt_decay: Time constant of the tilt bob [ticks].
        tilt_warning: Swing that causes a warning.
        tilt_limit: Swing that causes a tilt.
        warnings: Warnings per ball.
        unstick_ticks: An automatic shove moves a ball that has lain still for this time [ticks].
        stall_ticks: There is an automatic shove if nothing has scored for this time [ticks].
        auto_shove: Whether there are automatic shoves.

    Examples:
        >>> import silverball as sb
        >>> sb.RuleConfig.of(sb.load_table("classic"), tick_rate=240).balls
        3
    """

    balls: int
    max_balls: int
    save_ticks: int
    saves: int
    combo_ticks: int
    combo_step: int
    combo_limit: int
    double: int
    tilt_decay: float
    tilt_warning: float
    tilt_limit: float
    warnings: int
    unstick_ticks: int
    stall_ticks: int
    auto_shove: bool

    @classmethod
    def of(cls, table: Table, tick_rate: int) -> Self:
        """The numbers of the table's `[arcade]` section.

        Args:
            table: The table.
            tick_rate: Ticks per second.
        """
        arcade = table.arcade
        return cls(
            balls=arcade.balls,
            max_balls=table.board.max_balls,
            save_ticks=round(arcade.ball_save * tick_rate),
            saves=arcade.ball_saves,
            combo_ticks=round(arcade.combo_window * tick_rate) if arcade.combo_window else NO_COMBOS,
            combo_step=arcade.combo_step,
            combo_limit=arcade.combo_limit,
            double=arcade.double,
            tilt_decay=arcade.tilt_decay * tick_rate,
            tilt_warning=arcade.tilt_warning,
            tilt_limit=arcade.tilt_limit,
            warnings=arcade.warnings,
            unstick_ticks=round(arcade.un_stick * tick_rate),
            stall_ticks=round(arcade.stall * tick_rate),
            auto_shove=True,
        )
