// Players in turn: the machine is handed on after each ball. The same as game/match.py.

import { CALL } from "./judge.js";

const ENDS_OF_TURNS = new Set(["BALL_READY", "OVER"]);

export class Match {
  /**
   * @param judge The rules, with the state of the player who is up.
   * @param players How many there are; with one, nothing is ever handed on.
   */
  constructor(judge, players) {
    this.judge = judge;
    this.restart(players);
  }

  /** Begin again, when the rules have begun again. */
  restart(players = this.players) {
    this.players = players;
    const blank = { rules: this.judge.ruleState(), table: this.judge.tableState(), since: 0 };
    this.waiting = Array(players).fill(blank);
    this.used = 0;
    this.up = 0;
  }

  /** The points of all players. */
  get scores() {
    return this.waiting.map(({ rules }, player) => Number(player === this.up ? this.judge.big("score") : rules.score));
  }

  /** The state of the match for the JSON of a game. */
  values() {
    const waiting = this.waiting.map(({ rules, table, since }) => (
      { rules: { ...rules, memory: null, open_gates: [] }, table, since }));
    return { up: this.up, used: this.used, waiting };
  }

  /** Hand the machine on if the turn is over; what was reported, with what that changes. */
  passOn(said, tick) {
    const { judge } = this;
    if (this.players === 1 || !said.some(({ kind }) => ENDS_OF_TURNS.has(kind))) return said;
    if (!judge.isOver && judge.int("used") <= this.used) return said; // an extra ball
    this.waiting[this.up] = { rules: judge.ruleState(), table: judge.tableState(), since: tick };
    const others = this.waiting.map((_, step) => (this.up + 1 + step) % this.players);
    const next = others.find((player) => !this.waiting[player].rules.over);
    if (next === undefined) {
      const best = Math.max(...this.scores);
      return said.map((event) => (event.kind === "OVER" ? { ...event, value: best } : event));
    }
    this.resume(next, tick);
    const at = said[said.length - 1].tick, ball = judge.int("used") + 1;
    return [
      ...said.filter(({ kind }) => !ENDS_OF_TURNS.has(kind)),
      { kind: "PLAYER_UP", tick: at, value: next + 1, part: -1 }, { kind: "BALL_READY", tick: at, value: ball, part: -1 },
    ];
  }

  /** Let a player go on; what happens to the table, such as fallen targets, is that of the machine. */
  resume(player, tick) {
    const { judge } = this, { rules, table, since } = this.waiting[player];
    const later = (end) => (end === judge.notRunning || end === judge.forever ? end : end + BigInt(tick - since));
    judge.setRuleState(rules);
    if (table) {
      const resets = BigInt(judge.layout.bankBits);
      judge.setTableState({ ...table, mode_end: table.mode_end.map(later), fallen: judge.big("fallen"), resets });
    }
    judge.setNextLook(tick);
    judge.judge(CALL.SWITCHES);
    this.up = player;
    this.used = Number(rules.used);
  }
}
