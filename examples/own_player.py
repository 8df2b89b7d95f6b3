"""Give a player of your own a name, then use it wherever a player is asked for."""

import silverball as sb


class Sleepy:
    """Lift a paddle when a ball comes down on its side."""

    def press(self, world: sb.World) -> tuple[bool, bool]:
        low = [ball for ball in world.balls if ball.position[0] < -6.5 and ball.velocity[0] < 0]
        return any(ball.position[2] < 0 for ball in low), any(ball.position[2] >= 0 for ball in low)


sb.players.register("sleepy", Sleepy)
player = sb.players.make_player("sleepy")
world = sb.World("classic", seed=3)
world.create_ball()
while world.balls and world.time < 60:
    left, right = player.press(world)
    world.step(left=left, right=right)
print(f"sleepy kept the ball for {world.time:.1f} s and scored {world.score} points")
