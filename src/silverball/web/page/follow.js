// A replay: a game that is played with recorded inputs, and compared with the digests of every second. The
// same as game/replay/player.py and verify.py.

const TOKEN = /([+!^()]?)(\d{0,4})([A-Za-z])/g;
const LETTERS = 26;
const DIRECTIONS = { "(": "left", ")": "right", "!": "up" };

/** The inputs of a second: kinds and ticks, counted from its beginning. */
export function parseInputs(text) {
  const inputs = [];
  let tick = 0;
  for (const [, prefix, more, letter] of text.matchAll(TOKEN)) {
    const isLower = letter >= "a";
    tick += LETTERS * Number(more || 0) + letter.charCodeAt(0) - (isLower ? 97 : 65);
    inputs.push({ tick, kind: prefix || (isLower ? "L" : "R") });
  }
  return inputs;
}

export class Follower {
  /**
   * @param game A game at its beginning.
   * @param replay What web/replay_inputs.py says about the replay.
   * @param compares Whether the digests are compared; without it the game is played faster.
   */
  constructor(game, replay, compares) {
    this.game = game;
    this.replay = replay;
    this.compares = compares;
    this.restart();
  }

  restart() {
    this.game.restart();
    this.buttons = 0;
    this.second = -1;
    this.agreed = 0; // seconds
    this.differs = 0; // the first second that differs
    this.hasEnded = false;
  }

  get world() {
    return this.game.world;
  }

  get isAtEnd() {
    return this.hasEnded || this.differs > 0;
  }

  /**
   * Play some ticks.
   * @param onTick Called after each with the world.
   */
  advance(ticks, onTick = () => {}) {
    const { world, game, replay } = this;
    for (let count = 0; count < ticks && !this.isAtEnd && world.tick < replay.ticks; count++) {
      this.applyInputs();
      const { tick } = world;
      game.playTick(this.buttons);
      onTick(world);
      if (world.tick === tick) this.differ(); // the game has ended earlier
      else if (this.compares && world.tick % world.rate === 0) this.compare(world.tick / world.rate);
    }
    if (!this.isAtEnd && world.tick >= replay.ticks) this.finish();
  }

  applyInputs() {
    const { world, game, replay } = this, second = Math.floor(world.tick / world.rate);
    if (second !== this.second) {
      this.second = second;
      this.inputs = parseInputs(replay.inputs[second] ?? "");
      this.next = 0;
    }
    const at = world.tick - second * world.rate;
    for (; this.inputs[this.next]?.tick === at; this.next++) {
      const { kind } = this.inputs[this.next];
      if (kind === "+") {
        if (game.createBall()) this.differ();
      } else if (DIRECTIONS[kind]) {
        if ((kind !== "!" && !world.meta.hasNudge) || !game.nudge(DIRECTIONS[kind])) this.differ();
      } else {
        this.buttons ^= { L: 1, R: 2, "^": 8 }[kind];
      }
    }
  }

  /** What comes after the last tick. */
  finish() {
    const { game, replay } = this;
    this.applyInputs();
    if (replay.ended === "stopped") game.end();
    this.hasEnded = true;
    const isSame = game.ended === replay.ended && game.score === replay.score && game.digest() === replay.digest;
    if (this.compares && !isSame) this.differ();
  }

  differ() {
    this.differs ||= Math.floor(this.world.tick / this.world.rate) + 1;
  }

  compare(second) {
    if (this.game.shortDigests() === this.replay.digests[second - 1]) this.agreed++;
    else this.differs ||= second;
  }

  /** Whole seconds of the replay. */
  get seconds() {
    return this.replay.digests.length;
  }

  /** What has been compared so far, in one sentence. */
  get verdict() {
    if (!this.differs) return `same bits: ${this.agreed} of ${this.seconds} s`;
    const where = this.differs > this.seconds ? "the end" : `second ${this.differs}`;
    return `not the same bits: ${where} differs, ${this.agreed} s before it agree`;
  }
}
