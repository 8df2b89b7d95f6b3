"""Score a game by rules of your own: each part that the ball meets for the first time gives 100 points."""

import silverball as sb
from silverball.players import make_player


class Collect(sb.ArcadeRules):
    """Arcade play in which `memory` holds the parts that were hit."""

    name = "collect"

    def hit(self, config, state, tick, points, part):
        if part in (state.memory or []):
            return state, ()
        state = state._replace(memory=[*(state.memory or []), part], score=state.score + 100)
        return state, (sb.GameEvent(sb.GameEventKind.SCORED, tick, 100, part),)


game, player = sb.Game("classic", seed=3, rules=Collect()), make_player("reflex")
game.create_ball()
while game.tick < 2400:
    game.step(*player.press(game.world))
print(f"{game.score} points for {', '.join(game.state.memory)}")
assert game.replay.verify(rules=Collect()).ok
assert game.score == 100 * len(game.state.memory) > 0
