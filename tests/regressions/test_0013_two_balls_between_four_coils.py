"""A ball sank by 1e-10 u a tick into a coil's paddle that had stalled at another jammed ball.

Only a paddle that a ball's jam stopped turned back from that ball. One that was stopped already did not.
"""

from __future__ import annotations

import pytest

from boards import table_of
from silverball.physics.audit import deepest
from silverball.physics.tolerances import MAX_DEPTH
from silverball.table import Paddle
from silverball.world import World

PADDLES = (
    Paddle(
        side="right", pivot=(-2.7115050707762522, -3.6944093204662574), length=1.6423164803905181,
        base=0.23590381612440825, rest_angle=-13.698053015514688, up_angle=51.98975397482042,
        stroke=0.11224016686391387, return_stroke=0.10592383473631731, profile="coil", mass=20.0,
        restitution=0.0,
    ),
    Paddle(
        side="right", pivot=(-2.209660384960361, -3.7327655857782887), length=2.242204550576153,
        base=0.3021451031564279, rest_angle=-63.170093879769034, up_angle=93.92976884254477,
        stroke=0.3667607439214213, return_stroke=0.4657819381162403, button="left", profile="coil", mass=0.3,
    ),
    Paddle(
        side="left", pivot=(-2.6946133758893134, -3.85505015435914), length=2.0181563295665876,
        base=0.3359007577113664, rest_angle=50.562545198139446, up_angle=120.0,
        stroke=0.1590851353401956, return_stroke=0.16053077240870656, button="left", profile="coil", mass=1.0,
        restitution=0.0,
    ),
    Paddle(
        side="right", pivot=(-2.212330553066324, -3.723128667065033), length=1.1931834790393578,
        rest_angle=-84.1683843381573, up_angle=-68.71310087677048, shape="capsule",
        base_radius=0.20472098205099337, tip_radius=0.10731476621703638,
        stroke=0.014009094223194402, return_stroke=0.013114210582765372, button="right", mass=1.0,
        restitution=0.0,
    ),
)  # fmt: skip
BOARD = {
    "length": 20.578062256836454, "width": 10.759286556324376, "slope": 7.261655950073084, "gutter": -5.5,
    "speed_cap": 54.99584632599106, "wall_restitution": 0.0,
}  # fmt: skip
ANGLES = (0.882482891895982, -0.23907612623346922, 0.21233330933618938, -1.4690154327848732)
PLACES = ((-2.2542099391034647, -5.0296432781621885), (-2.7542099391034647, -5.0296432781621885))


@pytest.mark.parametrize("tick_rate", [60, 240, 1000])
def test_two_jammed_balls_do_not_sink_into_the_paddles_that_press_them(tick_rate: int) -> None:
    world = World(table_of(*PADDLES, **BOARD), tick_rate=tick_rate)
    record = world.records[0]
    for number, place in enumerate(PLACES):
        world.create_ball((2.0, 2.0 * number), (0.0, 0.0))
        record["ball"]["x"][number], record["ball"]["z"][number] = place
    for number, angle in enumerate(ANGLES):
        record["paddle"]["angle"][number] = record["paddle"]["angle_commanded"][number] = angle
    depths = []
    for _ in range(3 * tick_rate):
        world.step(left=True, right=True)
        assert world.fault is None
        depths.append(deepest(*world.records))
    assert world.jams > 20  # else nothing was tried
    assert max(depths) < 0.1 * MAX_DEPTH
