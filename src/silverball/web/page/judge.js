// The rules of a game: the compiled referee, with its record. The same as game/scorekeeper.py.

import { Float } from "./python_json.js";
import { NUDGES } from "./world.js";

export const CALL = { TICKS: 0, START: 1, RETURN: 2, SHOVE: 3, BUTTONS: 4, STILLNESS: 5, SWITCHES: 6, END: 7 };

const NAMES = { MESSAGE: "texts", CUE: "texts", MODE_STARTED: "modes", MODE_ENDED: "modes" };
const RULE_FIELDS = [
  "score", "used", "balls", "combo", "combo_tick", "warnings", "swing", "swing_tick", "tilted", "quiet_since", "over",
];
const FLAGS = ["tilted", "over"], TABLE_ROWS = { lamp: "lamps", counter: "counters", mode_end: "modes" };

export class Judge {
  /**
   * @param world The world that is played.
   * @param pack The bytes of all arrays.
   * @param meta What web/rules_meta.py says about the rules of a mode.
   * @param layout What it says about the records of all modes.
   */
  constructor(world, pack, meta, layout) {
    this.world = world;
    this.memory = world.memory;
    this.meta = meta;
    this.layout = layout;
    this.forever = BigInt(layout.forever); // of a mode that has no end
    this.notRunning = BigInt(layout.notRunning);
    this.kernel = this.memory.exports[`judge${world.meta.isPlain ? "_plain" : ""}`];
    const at = {
      world: world.at.world, board: world.at.board, colliders: world.at.collider, grid: world.at.grid,
      places: world.at.place, log: world.at.log,
    };
    const lengths = {
      world: 1, board: 1, log: 1, colliders: world.shape.collider[0], grid: world.shape.grid[0],
      places: world.shape.place[0],
    };
    for (const [name, [offset, size, shape]] of Object.entries(meta.arrays)) {
      at[name] = this.memory.put(pack.subarray(offset, offset + size));
      lengths[name] = shape[0];
    }
    this.at = at;
    this.first = this.memory.bytes.slice(at.game, at.game + layout.game.size);
    this.addresses = this.memory.room(8 * layout.addresses.length);
    layout.addresses.forEach((name, index) => {
      const value = name.endsWith("_length") ? lengths[name.slice(0, -"_length".length)] : at[name];
      this.memory.writeInt(this.addresses + 8 * index, value ?? 0);
    });
  }

  restart() {
    this.memory.bytes.set(this.first, this.at.game);
    this.memory.bytes.fill(0, this.at.report, this.at.report + this.layout.report.size);
  }

  /** Let the rules act; what they report. */
  judge(call, value = 0) {
    const { memory, at } = this, { report, reported } = this.layout;
    memory.writeInt(at.report + report.fields.count, 0);
    memory.writeInt(at.report + report.fields.touched, 0);
    this.kernel(this.addresses, 1, call, value);
    const said = [], count = memory.int(at.report + report.fields.count), f = reported.fields;
    for (let index = 0; index < count; index++) {
      const row = at.report + report.fields.event + index * reported.size;
      const event = {
        kind: this.layout.said[memory.int(row + f.kind)], tick: memory.int(row + f.tick),
        value: memory.int(row + f.value), part: memory.int(row + f.part),
      };
      const names = NAMES[event.kind];
      if (names) event.text = this.meta[names][event.value];
      said.push(event);
    }
    return said;
  }

  // --- the record ------------------------------------------------------------------------------------

  place(name) {
    return this.at.game + this.layout.game.fields[name];
  }

  big(name) {
    return this.memory.view.getBigInt64(this.place(name), true);
  }

  int(name) {
    return Number(this.big(name));
  }

  write(name, value) {
    this.memory.writeInt(this.place(name), value);
  }

  setup(name) {
    return this.memory.int(this.at.setup + this.layout.setup.fields[name]);
  }

  get isLate() {
    return this.memory.int(this.at.report + this.layout.report.fields.late) !== 0;
  }

  get isOver() {
    return this.int("over") !== 0;
  }

  get isTilted() {
    return this.int("tilted") !== 0;
  }

  get balls() {
    return this.int("balls");
  }

  get hasWaiting() {
    return this.inPlay().some((ball) => ball.id === 0n);
  }

  rows(name, count, layout, floats) {
    const start = this.place(name), { view } = this.memory;
    return Array.from({ length: count }, (_, index) => Object.fromEntries(
      Object.entries(layout.fields).map(([field, offset]) => {
        const at = start + index * layout.size + offset;
        return [field, floats.includes(field) ? new Float(view.getFloat64(at, true)) : view.getBigInt64(at, true)];
      })));
  }

  inPlay() {
    return this.rows("ball", this.balls, this.layout.inPlay, []);
  }

  list(name, count) {
    const start = this.place(name);
    return Array.from({ length: count }, (_, index) => this.memory.view.getBigInt64(start + 8 * index, true));
  }

  /** The state of every lamp: 0 off, 1 on, 2 blinking; none by the standard rules. */
  get lamps() {
    return this.meta.isOwn ? this.list("lamp", this.setup("lamps")).map(Number) : [];
  }

  /** What the rules of the table keep, for the card: lamps, counters, and whether each mode runs. */
  standing() {
    if (!this.meta.isOwn) return { lamps: [], counters: [], isRunning: [] };
    const ends = this.list("mode_end", this.setup("modes"));
    return {
      lamps: this.lamps, counters: this.list("counter", this.setup("counters")).map(Number),
      isRunning: ends.map((end) => end !== this.notRunning),
    };
  }

  /** The colour of the first mode that runs and has one. */
  modeColour({ ofModes, plain }) {
    const ends = this.meta.isOwn ? this.list("mode_end", this.setup("modes")) : [];
    return ofModes.find((color, mode) => color !== plain && mode < ends.length && ends[mode] >= 0n) ?? plain;
  }

  /** The modes that run: names, and how long they still do [s], or without an end Infinity. */
  runningModes(tick, rate) {
    if (!this.meta.isOwn) return [];
    return this.list("mode_end", this.setup("modes")).flatMap((end, mode) => {
      if (end === this.notRunning) return [];
      return [[this.meta.modes[mode], end === this.forever ? Infinity : Math.max(Number(end) - tick, 0) / rate]];
    });
  }

  /** Why the player cannot start a ball now; empty if the rules allow it. */
  refusal() {
    const balls = this.setup("balls"), used = this.int("used");
    if (this.isOver) return "THE GAME IS OVER";
    if (this.isTilted) return "TILT";
    if (balls && used >= balls) return `BALL ${used} OF ${balls}: THE LAST ONE`;
    if (this.hasWaiting && this.balls >= this.setup("max_balls")) return "A SAVED BALL COMES FIRST";
    return "";
  }

  /** The state of the rules that all games have, in the order of `RuleState`. */
  ruleState() {
    return Object.fromEntries(RULE_FIELDS.map((name) => {
      if (name === "balls") return [name, this.inPlay()];
      if (name === "swing") return [name, new Float(this.memory.double(this.place(name)))];
      return [name, FLAGS.includes(name) ? this.int(name) !== 0 : this.big(name)];
    }));
  }

  /** What the rules of the table keep; null if it has none of its own. */
  tableState() {
    if (!this.meta.isOwn) return null;
    const state = {};
    for (const [name, count] of Object.entries(TABLE_ROWS)) state[name] = this.list(name, this.setup(count));
    for (const name of this.layout.tableFields) state[name] = this.big(name);
    return state;
  }

  setRuleState(state) {
    const { view, bytes } = this.memory, { inPlay, game } = this.layout, start = this.place("ball");
    for (const name of RULE_FIELDS) {
      if (name === "swing") view.setFloat64(this.place(name), state.swing.value, true);
      else if (name !== "balls") this.write(name, state[name]);
    }
    bytes.fill(0, start, start + inPlay.size * game.maxBalls);
    this.write("balls", state.balls.length);
    state.balls.forEach((ball, index) => {
      for (const [field, offset] of Object.entries(inPlay.fields)) {
        view.setBigInt64(start + index * inPlay.size + offset, ball[field], true);
      }
    });
    bytes.fill(0, this.place("rest"), this.place("rest") + this.layout.rest.size * game.maxBalls);
    this.write("rests", 0);
  }

  setTableState(state) {
    for (const name of Object.keys(TABLE_ROWS)) {
      state[name].forEach((value, index) => this.memory.view.setBigInt64(this.place(name) + 8 * index, value, true));
    }
    for (const name of this.layout.tableFields) this.write(name, state[name]);
    const running = state.mode_end.filter((end) => end !== this.notRunning);
    this.write("next_end", running.reduce((first, end) => (end < first ? end : first), this.forever));
  }

  /** Set the tick after which balls that lie still are looked for, in a game that goes on from a tick. */
  setNextLook(tick) {
    const every = this.setup("check_ticks");
    this.write("next_look", (Math.floor(tick / every) + 1) * every);
  }

  /**
   * The state of the game without that of the world, for its JSON; see `GameState.to_json`.
   * @param buttons Whether left, right and launch are held.
   */
  state(buttons) {
    const rests = this.rows("rest", this.int("rests"), this.layout.rest, ["x", "z"]);
    const state = {
      ...this.ruleState(), watch: { rests, released: this.big("released"), shoved: this.big("shoved") },
      left: buttons.left, right: buttons.right, shove: this.int("shove") !== 0, machine: this.int("auto_shove") !== 0,
    };
    if (Object.values(NUDGES).includes(this.int("shove"))) state.nudge = this.big("shove");
    if (buttons.launch) state.launch = true;
    if (this.meta.isOwn) state.table = this.tableState();
    return state;
  }
}
