// A game that is played: its buttons, its menu, and what a finished game came to.

import { byId, element } from "./elements.js";
import { RecordedGame } from "./game.js";
import { Input } from "./input.js";
import { Menu } from "./menu.js";
import { keep, kept } from "./settings.js";
import { Shakes } from "./shakes.js";
import { Clock } from "./stage.js";
import { LAUNCH } from "./world.js";

const CONFIRM_SECONDS = 3, NEW_BALL_LOCK = 1, OVER_MS = 2600, SEEDS = 2 ** 31;

export class GamePage {
  /**
   * @param stage Shows the world.
   * @param makeGame Makes a game of a class in a world.
   * @param meta What web/page.py says.
   */
  constructor(stage, makeGame, meta) {
    this.stage = stage;
    this.meta = meta;
    this.modes = Object.keys(meta.rules);
    this.games = Object.fromEntries(this.modes.map((mode) => [mode, makeGame(RecordedGame, stage.world, mode)]));
    this.mode = this.modes[0];
    this.players = 1;
    this.clock = new Clock(stage.world.rate);
    this.isPaused = true;
    this.isWaiting = true; // for somebody who plays
    const drawsPlunger = () => !this.isPaused && this.game.hasBallToLaunch;
    this.input = new Input(byId("surface"), (action) => this.act(action), drawsPlunger);
    this.addButtons(drawsPlunger);
    this.shakes = new Shakes((direction) => this.act(`nudge ${direction}`), () => this.menu.offerShakes());
    this.menu = new Menu(byId("menu"), this);
    document.addEventListener("visibilitychange", () => document.hidden && this.hide());
    stage.sounds.setVolumes(kept("volume"), kept("music"));
    if (matchMedia("(hover: none)").matches) stage.display.startText = "TOUCH TO START";
    this.reset(stage.world.seed);
    this.menu.open();
  }

  get game() {
    return this.games[this.mode];
  }

  addButtons(drawsPlunger) {
    const bar = byId("bar"), nudge = this.stage.world.meta.hasNudge ? "Nudge" : "Shove";
    this.ballButton = element(bar, "button", { className: "main" }, "New ball");
    this.input.bind(this.ballButton, LAUNCH, drawsPlunger, () => this.act("create"));
    element(bar, "button", { onclick: () => this.act("nudge up") }, nudge);
    this.menuButton = element(bar, "button", { onclick: () => this.act("pause") }, "Menu");
    this.keys = element(bar, "span", { className: "keys" }, this.keyText());
  }

  keyText() {
    const launch = this.game.hasPlunger ? ", held: launch" : "";
    const nudge = this.stage.world.meta.hasNudge ? "Z X ↑: nudge" : "Z: shove";
    return `A D or arrows: paddles, Space: ball${launch}, ${nudge}, P: menu, M: sound`;
  }

  act(action) {
    const { game, stage, menu } = this;
    stage.sounds.start();
    if (action === "mute") menu.showSound(stage.sounds.toggle());
    else if (action === "restart") this.begin();
    else if (action === "pause") menu.isOpen ? this.goOn() : this.pause();
    else if (menu.isOpen) {
      if (action === "create" || action === "touch") this.goOn();
    } else if (action === "create" || (action === "touch" && !game.judge.balls)) this.createBall();
    else if (action.startsWith("nudge ")) game.nudge(action.slice("nudge ".length));
  }

  /** Leave the menu: go on, or begin a game with its first ball. */
  goOn() {
    if (this.isWaiting || this.game.isOver) {
      this.begin();
      this.createBall();
    } else {
      this.unpause();
    }
  }

  pause() {
    this.isPaused = true;
    this.input.clear();
    this.clock.stop();
    this.stage.sounds.silence();
    this.menu.open();
  }

  unpause() {
    this.isPaused = false;
    this.input.clear();
    this.clock.stop();
    this.menu.close();
  }

  hide() {
    if (!this.menu.isOpen) this.pause();
  }

  /** Begin another game; every one but the first has a seed of its own. */
  begin(seed = this.hasPlayed ? Math.floor(Math.random() * SEEDS) : this.stage.world.seed) {
    this.hasPlayed = true;
    this.isWaiting = false;
    this.reset(seed);
    this.unpause();
  }

  reset(seed) {
    this.stage.world.seed = seed;
    this.game.restart(this.mode === "arcade" ? this.players : 1);
    this.createdAt = this.askedAt = -Infinity;
    this.endedAt = null;
    this.best = kept(this.bestName);
    this.stage.clear();
  }

  /** Choose a mode and how many take turns; the game that was played is over. */
  choose(mode, players) {
    [this.mode, this.players] = [mode, mode === "arcade" ? players : 1];
    this.isWaiting = true;
    this.reset(this.stage.world.seed);
    this.menu.show();
  }

  get bestName() {
    return `best ${this.mode} ${this.meta.tableKey}`;
  }

  /** Start a ball; an extra one beside one in play must be asked for twice, because there are few. */
  createBall() {
    const { game, stage } = this, { judge } = game, { tick, rate } = stage.world;
    if (game.isOver) {
      this.goOn();
      return;
    }
    const balls = judge.setup("balls"), used = judge.int("used"), onBoard = stage.world.balls().length;
    if (balls && game.hasPlunger && onBoard) return; // they come one after the other
    if (balls && judge.balls && used < balls && !judge.isTilted && onBoard < judge.setup("max_balls")) {
      if (tick - this.createdAt < NEW_BALL_LOCK * rate) return;
      if (tick - this.askedAt > CONFIRM_SECONDS * rate) {
        this.askedAt = tick;
        stage.say(`AGAIN: BALL ${used + 1} OF ${balls}`);
        return;
      }
    }
    const refusal = game.createBall();
    if (refusal) stage.say(refusal);
    else [this.createdAt, this.askedAt] = [tick, -Infinity];
  }

  /** Give the game so far to the player as a file. */
  save() {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([this.game.toReplay()], { type: "text/plain" }));
    link.download = `silverball-${this.meta.fileName}-${this.game.score}.replay`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }

  frame(now) {
    const { game, stage, input } = this;
    input.poll();
    if (!this.isPaused) this.play(now);
    stage.draw(game, now, this.best, this.isWaiting);
    this.label();
    if (game.isOver && this.endedAt !== null && now - this.endedAt > OVER_MS && !this.menu.isOpen) this.pause();
  }

  play(now) {
    const { game, stage } = this, ticks = this.clock.ticks(now);
    const buttons = ticks ? this.input.takeButtons() : 0; // a tap waits for the tick that it is played in
    for (let count = 0; count < ticks && !game.isOver; count++) {
      game.playTick(buttons);
      stage.see(stage.world);
    }
    stage.announce(game);
    stage.sound(game, now);
    if (game.isOver && this.endedAt === null) this.end(now);
  }

  /** A game is over: keep its score if it is the best. */
  end(now) {
    this.endedAt = now;
    this.previousBest = this.best;
    if (this.game.score > this.best && this.game.ended === "over") keep(this.bestName, this.game.score);
  }

  /** Say what the button of the ball does now. */
  label() {
    const text = !this.isPaused && this.game.hasBallToLaunch ? "Hold to launch" : "New ball";
    if (this.ballButton.textContent !== text) this.ballButton.textContent = text;
  }

  /** What a finished game came to, line by line; nothing while one is played. */
  results() {
    const { game, stage, meta } = this;
    if (!game.isOver) return [];
    const points = (number) => number.toLocaleString("en-US"), { scores } = game.match, lines = [];
    if (scores.length > 1) {
      const best = Math.max(...scores), winners = scores.flatMap((score, player) => (score === best ? [player + 1] : []));
      lines.push(winners.length === 1 ? `Player ${winners[0]} wins` : `Players ${winners.join(" and ")} draw`);
      scores.forEach((score, player) => lines.push(`Player ${player + 1}: ${points(score)}`));
      return lines;
    }
    const { score } = game, goal = meta.medals.find(([, least]) => score < least);
    const won = meta.medals.filter(([, least]) => score >= least).pop();
    lines.push(`${points(score)} points`);
    if (score > this.previousBest) lines.push("The best so far");
    else if (this.previousBest) lines.push(`${points(this.previousBest - score + 1)} to beat the best`);
    if (won) lines.push(`${won[0]} medal`);
    if (goal) lines.push(`${points(goal[1] - score)} to ${goal[0]}`);
    for (const [name, worth] of stage.tally.causes().slice(0, 4)) lines.push(`${name.toLowerCase()}: ${points(worth)}`);
    return lines;
  }
}
