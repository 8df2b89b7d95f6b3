// A game: a world and its rules, driven by buttons, new balls and shoves. The same as game/core.py; the
// recording as in game/replay/recording.py, so that Python verifies what is saved here.

import { joined, rulesDigest, sha256, shortDigests } from "./digests.js";
import { CALL } from "./judge.js";
import { Match } from "./match.js";
import { toJson } from "./python_json.js";
import { viewOf } from "./view.js";
import { JITTER, KIND, LAUNCH, LEFT, NUDGES, RIGHT } from "./world.js";

const LETTERS = 26;
const NUDGE_KINDS = { left: "(", right: ")", up: "!" };
const SCORING = new Set([KIND.HIT, KIND.PASS, KIND.SPIN, KIND.CAPTURED]);

export class Game {
  /**
   * @param world A world at its beginning.
   * @param judge Its rules.
   * @param meta What the page says about games: points of parts, plungers.
   * @param groups The spans of the groups of digests.
   * @param players How many take turns.
   */
  constructor(world, judge, meta, groups, players = 1) {
    this.world = world;
    this.judge = judge;
    this.meta = meta;
    this.groups = groups;
    this.match = new Match(judge, players);
    this.restart();
  }

  /** Begin again, with as many players as before or with others. */
  restart(players = this.match.players) {
    this.world.restart();
    this.judge.restart();
    this.match.restart(players);
    this.left = this.right = this.launch = this.wasStopped = false;
    this.pointsSeen = 0;
    this.said = [{ kind: "BALL_READY", tick: 0, value: 1, part: -1 }]; // reported, and nobody has taken it
  }

  /** The points; in a match those of the player who leads. */
  get score() {
    return Math.max(...this.match.scores);
  }

  get view() {
    return viewOf(this);
  }

  get isOver() {
    return this.judge.isOver;
  }

  get hasPlunger() {
    return this.meta.plungers.length > 0;
  }

  /** Whether a ball lies on a plunger that will not launch it by itself. */
  get hasBallToLaunch() {
    const isLying = (ball) => this.meta.plungerRows.includes(ball.holder) && !ball.isDue;
    return this.hasPlunger && this.world.balls().some(isLying);
  }

  /** How the game ended, as `Game.ended` says. */
  get ended() {
    if (!this.isOver) return "running";
    if (this.world.isFaulty) return this.meta.faults[this.world.int("fault")];
    return this.wasStopped ? "stopped" : "over";
  }

  // --- for a recording -------------------------------------------------------------------------------

  record() {}

  endSecond() {}

  // --- actions ---------------------------------------------------------------------------------------

  tell(call, value = 0) {
    this.said.push(...this.judge.judge(call, value));
  }

  takeEvents() {
    const { said } = this;
    this.said = [];
    return said;
  }

  /** Start a ball; why not, or an empty text. */
  createBall() {
    const { world, judge } = this, reason = judge.refusal();
    if (reason) return reason;
    if (world.isFaulty || !world.createBall()) return "NO ROOM FOR A BALL";
    this.record("+", world.tick);
    this.tell(CALL.START, world.int("created"));
    return "";
  }

  /** Nudge the cabinet, or on a table without nudge shove the balls, before the next tick; whether it was done. */
  nudge(direction) {
    const { judge, world } = this, { hasNudge } = world.meta;
    if (this.isOver || judge.isTilted || judge.int("shove") || !world.balls().length) return false;
    judge.write("shove", hasNudge ? NUDGES[direction] : JITTER);
    this.record(hasNudge ? NUDGE_KINDS[direction] : "!", world.tick);
    this.tell(CALL.SHOVE);
    return true;
  }

  end() {
    if (this.isOver) return;
    this.wasStopped = true;
    this.tell(CALL.END);
  }

  /**
   * Play one tick with these buttons.
   * @param buttons Bits LEFT, RIGHT and LAUNCH.
   */
  playTick(buttons) {
    if (this.isOver) return;
    const { world, judge } = this;
    this.press((buttons & LEFT) !== 0, (buttons & RIGHT) !== 0);
    if (this.hasPlunger) this.pressLaunch((buttons & LAUNCH) !== 0);
    const shoves = judge.int("shove") | (judge.int("auto_shove") ? JITTER : 0);
    world.step((judge.isTilted ? this.held & LAUNCH : this.held) | shoves, 1);
    if (world.hasNewEvents || judge.int("next_end") < world.tick) this.judgeTick();
    judge.write("shove", 0);
    judge.write("auto_shove", 0);
    if (judge.isLate) {
      this.returnBalls();
      this.tell(CALL.SWITCHES);
    }
    if (world.isFaulty) this.tell(CALL.END);
    if (world.tick >= judge.int("next_look") && !this.isOver) this.tell(CALL.STILLNESS);
    if (world.tick % world.rate === 0) this.endSecond();
  }

  /** The bits of the buttons that are held. */
  get held() {
    return (this.left ? LEFT : 0) | (this.right ? RIGHT : 0) | (this.launch ? LAUNCH : 0);
  }

  press(left, right) {
    if (left === this.left && right === this.right) return;
    const { tick } = this.world;
    if (left !== this.left) this.record("L", tick);
    if (right !== this.right) this.record("R", tick);
    this.left = left;
    this.right = right;
    this.tell(CALL.BUTTONS, this.held);
  }

  pressLaunch(launch) {
    if (launch === this.launch) return;
    this.record("^", this.world.tick);
    this.launch = launch;
    this.tell(CALL.BUTTONS, this.held);
  }

  judgeTick() {
    const { world } = this, { points } = this.meta;
    let seen = 0, lost = 0;
    for (const event of world.events()) if (SCORING.has(event.kind)) seen += points[event.part] ?? 0;
    if (world.eventsLost) {
      const all = points.reduce((sum, worth, part) => sum + worth * world.tally(part), 0);
      lost = Math.max(all - this.pointsSeen - seen, 0);
    }
    this.said.push(...this.match.passOn(this.judge.judge(CALL.TICKS, lost), world.tick));
    this.pointsSeen += lost + seen;
  }

  /** Put the balls that wait on the board, as far as there is room for them. */
  returnBalls() {
    const { world, judge } = this;
    while (judge.hasWaiting) {
      if (world.isFaulty || !world.createBall()) return;
      this.tell(CALL.RETURN, world.int("created"));
    }
  }

  // --- digests ---------------------------------------------------------------------------------------

  /** The state of the game without that of the world, as JSON. */
  rulesText() {
    const state = this.judge.state({ left: this.left, right: this.right, launch: this.launch });
    if (this.match.players > 1) state.match = this.match.values();
    return toJson(state);
  }

  /** The short digests of all groups. */
  shortDigests() {
    return shortDigests(this.world.record(), this.groups) + rulesDigest(this.rulesText());
  }

  digest() {
    return sha256(joined([this.world.record(), new TextEncoder().encode(this.rulesText())]));
  }
}

/** A game whose inputs are written down. */
export class RecordedGame extends Game {
  restart(players) {
    super.restart(players);
    this.seconds = []; // of each: record, state of the rules, inputs
    this.inputs = "";
    this.lastInput = 0;
  }

  record(kind, tick) {
    const ticks = tick - this.lastInput, more = Math.floor(ticks / LETTERS), code = ticks % LETTERS;
    const letter = String.fromCharCode((kind === "R" ? 65 : 97) + code);
    this.inputs += `${kind === "L" || kind === "R" ? "" : kind}${more || ""}${letter}`;
    this.lastInput = tick;
  }

  /** Keep what the digests of the second are made of; they are computed when the game is saved. */
  endSecond() {
    this.seconds.push({ record: this.world.record(), rules: this.rulesText(), inputs: this.inputs });
    this.inputs = "";
    this.lastInput = this.world.tick;
  }

  /** The game so far as the text of a replay; see game/replay/format.py. */
  toReplay() {
    const { world } = this, head = this.judge.meta.replayHeads[this.match.players - 1], lines = [];
    lines.push(head.replace(/^seed = .*$/m, `seed = ${world.seed}`), this.judge.meta.replayTable, "--- play");
    for (const { record, rules, inputs } of this.seconds) {
      lines.push(shortDigests(record, this.groups) + rulesDigest(rules) + (inputs ? ` ${inputs}` : ""));
    }
    if (this.inputs) lines.push(`= ${this.inputs}`);
    else if (world.tick % world.rate) lines.push("=");
    lines.push("--- end", `ticks = ${world.tick}`, `score = ${this.score}`, `ended = ${this.ended}`);
    lines.push(`digest = ${this.digest()}`);
    const body = `${lines.join("\n")}\n`;
    return `${body}checksum = ${sha256(new TextEncoder().encode(body)).slice(0, 32)}\n`;
  }
}
