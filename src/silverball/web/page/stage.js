// All that a page shows a world with: the picture, the score display and the sounds.

import { Card } from "./card.js";
import { byId } from "./elements.js";
import { Effects } from "./effects.js";
import { DotPanel } from "./dot_panel.js";
import { ScoreDisplay } from "./score_display.js";
import { Tally } from "./tally.js";

export class Stage {
  /**
   * @param world The world that is shown.
   * @param painter Who paints it.
   * @param sounds Its sounds.
   * @param meta What web/page.py says.
   * @param canvas Where it is shown.
   */
  constructor(world, painter, sounds, meta, canvas) {
    const { look, words, title } = meta;
    this.world = world;
    this.painter = painter;
    this.sounds = sounds;
    this.title = title;
    this.effects = new Effects(look.radius, look.lightShows);
    this.display = new ScoreDisplay(look.panel.fonts, words);
    this.tally = new Tally(words);
    this.panel = new DotPanel(look.panel);
    this.card = new Card(byId("card"), meta.card);
    this.canvas = canvas;
    [canvas.width, canvas.height] = look.size;
    this.scale = look.scale; // pixels of the canvas per u
    this.context = canvas.getContext("2d", { alpha: false });
    this.lastFrame = 0;
  }

  /** Take over what happened in a tick. */
  see(world) {
    for (const event of world.events()) {
      this.effects.add(event, world.rate);
      this.sounds.hear(event, world);
    }
  }

  /** Forget what was shown, because another game or another moment comes. */
  clear() {
    this.effects.clear();
    this.sounds.clear();
    this.display.clear();
    this.tally.clear();
  }

  /** Announce what the rules of a game have reported. */
  announce(game) {
    const events = game.takeEvents(), { rate } = this.world;
    if (!events.length) return;
    for (const event of events) this.effects.addGameEvent(event, rate);
    this.tally.add(events);
    this.display.add(events);
    const bonus = this.tally.takeBonus();
    if (bonus) this.display.countBonus(bonus);
    this.sounds.announce(events);
  }

  /** The sounds that go on: buttons, rolling and music. */
  sound(game, now) {
    this.sounds.hold(game.judge.isTilted ? 0 : game.held, this.world);
    this.sounds.follow(game, Math.min(Math.max((now - this.lastFrame) / 1000, 0), 0.1));
  }

  say(text, replaces = true) {
    this.display.say(text, replaces);
  }

  /** Move the picture as far as a nudge has moved the cabinet. */
  shift() {
    const { canvas } = this, [up, right] = this.world.cabinet;
    let place = "";
    if (up !== 0 || right !== 0) {
      const shown = Math.min(canvas.clientWidth / canvas.width, canvas.clientHeight / canvas.height);
      place = `translate(${right * this.scale * shown}px, ${-up * this.scale * shown}px)`;
    }
    if (canvas.style.transform !== place) canvas.style.transform = place;
  }

  /**
   * Draw a game now.
   * @param now The time [ms].
   * @param best The best score so far; 0 if there is none.
   * @param isWaiting Whether nobody plays, so that the lamps show themselves.
   */
  draw(game, now, best = 0, isWaiting = false) {
    const running = isWaiting ? this.effects.attract(now / 1000) : null;
    this.painter.compose(this.world, this.effects, game.judge, running);
    this.context.putImageData(this.painter.image(), 0, 0);
    this.shift();
    const dots = isWaiting ? this.display.title(this.title, now / 1000, best) : this.display.draw(game.view, now / 1000, best);
    this.panel.draw(this.context, dots);
    this.card.show(game, now);
    this.lastFrame = now;
  }
}

/** Counts the ticks that are due. */
export class Clock {
  constructor(rate) {
    this.rate = rate;
    this.stop();
  }

  stop() {
    this.last = null;
    this.due = 0;
  }

  ticks(now) {
    const seconds = this.last === null ? 0 : Math.max(Math.min((now - this.last) / 1000, MAX_DUE), 0);
    this.last = now;
    this.due += seconds * this.rate;
    const ticks = Math.floor(this.due);
    this.due -= ticks;
    return ticks;
  }
}

const MAX_DUE = 0.1; // [s] of play in one frame; a slow machine plays slower
