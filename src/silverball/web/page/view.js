// What a display of a game shows, as plain values. The same as `GameCore.view`.

/** The state of a game at this moment. */
export function viewOf(game) {
  const { world, judge, match } = game, { tick } = world, balls = judge.inPlay();
  const phase = judge.isOver ? "over" : balls.length ? "play" : "ready", used = judge.int("used"), tilted = judge.isTilted;
  const safeUntil = balls.reduce((latest, ball) => Math.max(latest, Number(ball.safe_until)), 0);
  const combo = tick - judge.int("combo_tick") <= judge.setup("combo_ticks") ? judge.int("combo") : 0;
  const factor = Math.min(1 + Math.floor(Math.max(combo - 1, 0) / judge.setup("combo_step")), judge.setup("combo_limit"));
  return {
    mode: judge.meta.mode, phase, score: judge.int("score"), ball: phase === "ready" ? used + 1 : used,
    balls: judge.setup("balls"), onBoard: world.balls().length, combo,
    multiplier: factor * (balls.length > 1 ? judge.setup("double") : 1),
    saveLeft: tilted ? 0 : Math.max(safeUntil - tick, 0) / world.rate, warnings: judge.int("warnings"), tilted,
    maxBalls: judge.setup("max_balls"), player: match.up + 1, scores: match.players > 1 ? match.scores : [],
  };
}
