// A replay that is watched: pause, a slider, and what the digests say.

import { byId, element } from "./elements.js";
import { Follower } from "./follow.js";
import { Game } from "./game.js";
import { Input } from "./input.js";
import { kept } from "./settings.js";
import { Clock } from "./stage.js";

const CHECK_MS = 5; // a frame, for comparing digests ahead of what is shown

function clock(seconds) {
  return `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;
}

export class ReplayPage {
  /**
   * @param stage Shows the world.
   * @param makeGame Makes a game of a class in a world.
   * @param meta What web/page.py says.
   * @param checkedWorld Another world, in which the digests are compared.
   */
  constructor(stage, makeGame, meta, checkedWorld) {
    const { replay } = meta, [mode] = Object.keys(meta.rules), bar = byId("bar");
    this.stage = stage;
    this.follower = new Follower(makeGame(Game, stage.world, mode, replay.players), replay, false);
    this.checker = new Follower(makeGame(Game, checkedWorld, mode, replay.players), replay, true);
    this.clock = new Clock(stage.world.rate);
    this.isPaused = false;
    this.pauseButton = element(bar, "button", { onclick: () => this.toggle() });
    this.slider = element(bar, "input", { type: "range", min: 0, max: replay.ticks, step: 1, value: 0 });
    this.slider.setAttribute("aria-label", "time");
    this.slider.oninput = () => this.seek(Number(this.slider.value));
    this.soundButton = element(bar, "button", { onclick: () => this.act("mute") }, "Sound off");
    this.time = element(bar, "span", { className: "time" });
    this.verdict = element(bar, "span", { className: "verdict" });
    this.verdict.setAttribute("role", "status");
    this.input = new Input(byId("surface"), (action) => this.act(action));
    stage.display.startText = "REPLAY";
    stage.sounds.setVolumes(kept("volume"), kept("music"));
  }

  act(action) {
    const { sounds } = this.stage;
    sounds.start();
    if (action === "pause" || action === "create" || action === "touch") this.toggle();
    if (action === "restart") this.seek(0);
    if (action === "mute") this.soundButton.textContent = sounds.toggle() ? "Sound off" : "Sound on";
  }

  toggle() {
    if (this.follower.isAtEnd) this.seek(0);
    else this.isPaused = !this.isPaused;
    if (this.isPaused) this.stage.sounds.silence();
    this.stage.sounds.start();
  }

  seek(tick) {
    const { follower } = this;
    if (tick < follower.world.tick || follower.hasEnded) follower.restart();
    follower.advance(tick - follower.world.tick);
    follower.game.takeEvents();
    this.stage.clear();
    this.clock.stop();
    this.isPaused = false;
  }

  frame(now) {
    const { follower, checker, stage } = this, { world } = stage;
    this.input.poll();
    if (this.isPaused || follower.isAtEnd) this.clock.stop();
    else this.play(now);
    const end = performance.now() + CHECK_MS;
    while (!checker.isAtEnd && performance.now() < end) {
      checker.advance(world.rate);
      checker.game.takeEvents();
    }
    stage.draw(follower.game, now);
    this.tell();
  }

  play(now) {
    const { follower, stage } = this;
    follower.advance(this.clock.ticks(now), (moved) => stage.see(moved));
    stage.announce(follower.game);
    stage.sound(follower.game, now);
    if (follower.isAtEnd) stage.sounds.silence();
  }

  tell() {
    const { follower, checker } = this, { world, replay } = follower;
    const label = follower.isAtEnd ? "Again" : this.isPaused ? "Play" : "Pause";
    if (this.pauseButton.textContent !== label) this.pauseButton.textContent = label;
    if (document.activeElement !== this.slider || !this.isPaused) this.slider.value = world.tick;
    this.time.textContent = `${clock(world.time)} / ${clock(replay.ticks / world.rate)}`;
    this.verdict.textContent = checker.verdict;
    this.verdict.classList.toggle("differs", checker.differs > 0);
  }
}
