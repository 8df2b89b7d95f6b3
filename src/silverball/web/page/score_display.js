// The score display during a game: the score, the ball, and recent events. The same as `frame` of
// app/score_display.py: the same events at the same times light the same dots.

import { Announcements, HIGH_SCORE, bonus } from "./announcements.js";
import { fireworks, tilt } from "./dot_animations.js";
import { Dots, FULL, HEIGHT, WIDTH } from "./dots.js";
import { round } from "./poses.js";

const MAX_HIDDEN = 0.85, LEAST_VISIBLE = 0.6, COUNT_TIME = 0.25, POINTS_TIME = 0.7, MESSAGE_TIME = 2.5;
const SCROLL_SPEED = 45, MAX_MESSAGES = 4, COMBO_FULL = 8, STATUS_Y = 24, HALF = 130, SMALL = ["bold", "normal", "tiny"];

function thousands(number) {
  return number.toLocaleString("en-US");
}

/** A queue of short messages, shown one after the other. */
class Messages {
  constructor() {
    this.texts = [];
    this.began = null;
  }

  add(text) {
    const { texts } = this;
    if (texts.length && texts[texts.length - 1] === text) return;
    if (texts.length >= MAX_MESSAGES) texts.splice(1, texts.length - MAX_MESSAGES + 1);
    texts.push(text);
  }

  /** The message at a time, and the column where it begins; null if there is none. */
  at(seconds, dots) {
    while (this.texts.length) {
      this.began ??= seconds;
      const [text] = this.texts, at = seconds - this.began, width = dots.width("normal", text);
      if (width <= WIDTH && at < MESSAGE_TIME) return [text, Math.floor((WIDTH - width) / 2)];
      if (width > WIDTH && at < (WIDTH + width) / SCROLL_SPEED) return [text, WIDTH - round(at * SCROLL_SPEED)];
      this.texts.shift();
      this.began = null;
    }
    return null;
  }
}

/** The score display of one game. */
export class ScoreDisplay {
  /**
   * @param fonts What web/look.py says about the fonts.
   * @param words What web/display_words.py says of the table's rules.
   */
  constructor(fonts, words) {
    this.dots = new Dots(fonts);
    this.words = words;
    this.note = "";
    this.startText = "PRESS SPACE";
    this.isCalm = false;
    this.clear();
  }

  /** Begin with another game. */
  clear() {
    this.announcements = new Announcements(this.words);
    this.messages = new Messages();
    this.points = 0;
    this.pointsBegan = null;
    [this.scoreFrom, this.scoreTo, this.scoreChanged] = [0, -1, 0];
    this.hiddenSince = null;
    this.seenSince = -LEAST_VISIBLE;
    this.tiltedSince = null;
    this.phaseSince = ["ready", 0];
    this.beatsHighScore = false;
    this.best = 0;
  }

  add(events) {
    for (const event of events) {
      if (event.kind === "SCORED" && event.value) [this.points, this.pointsBegan] = [event.value, null];
      if (event.kind === "UNSTUCK") this.say("STUCK BALL SHOVED");
      else if (event.kind === "PLAYER_UP") this.say(`PLAYER ${event.value}`, true);
      else this.announcements.addEvent(event);
    }
  }

  /** Count out the bonus at the end of a ball. */
  countBonus(points) {
    this.announcements.add(bonus(points));
  }

  /** Show a short message below the score; a long one scrolls. */
  say(text, replaces = false) {
    if (replaces) this.messages = new Messages();
    this.messages.add(text.toUpperCase());
  }

  /** Draw a frame; the dots are those of `dots`. */
  draw(view, seconds, best = 0) {
    this.dots.clear();
    this.advance(view, seconds, best);
    const message = this.messages.at(seconds, this.dots);
    this.drawPicture(view, seconds, message !== null);
    if (message === null) return this.dots;
    this.dots.box(0, STATUS_Y - 1, WIDTH, HEIGHT - STATUS_Y + 1, 0);
    this.dots.text(message[0], message[1], STATUS_Y);
    return this.dots;
  }

  /** Draw what is shown while nobody plays: the name of the table, the best score, and how to begin. */
  title(name, seconds, best) {
    const { dots } = this, text = name.toUpperCase(), isBest = best > 0 && seconds % 6 >= 4;
    dots.clear();
    dots.text(text, WIDTH / 2, 4, dots.fitting(text), "center");
    if (seconds % 1 < 0.65 || isBest) dots.text(isBest ? `BEST ${thousands(best)}` : this.startText, WIDTH / 2, 20, "normal", "center");
    return dots;
  }

  /** Bring what is shown up to date. */
  advance(view, seconds, best) {
    this.startCounting(view.score, seconds);
    this.best = best;
    if (view.phase !== this.phaseSince[0]) this.phaseSince = [view.phase, seconds];
    if (best > 0 && best < view.score && !this.beatsHighScore && view.phase !== "over") {
      this.beatsHighScore = true;
      this.announcements.add(HIGH_SCORE);
    }
    if (!view.tilted) {
      this.tiltedSince = null;
    } else if (this.tiltedSince === null) {
      this.tiltedSince = seconds;
      this.announcements.clear();
    }
    if (this.pointsBegan === null && this.points) this.pointsBegan = seconds;
    this.announcements.advance(seconds);
  }

  /** Draw a full-display animation if one is due, otherwise the score and the announcements. */
  drawPicture(view, seconds, hasMessage) {
    const { dots } = this, { current, began } = this.announcements, scene = this.scene(seconds);
    if (scene && this.mayHide(seconds)) {
      scene();
      return;
    }
    if (this.hiddenSince !== null) [this.hiddenSince, this.seenSince] = [null, seconds];
    const [headline, isLit] = this.headline(view, seconds), light = isLit ? FULL : HALF;
    if (!headline) {
      this.drawPlay(view, seconds);
    } else if (hasMessage) {
      dots.text(headline, WIDTH / 2, 0, "normal", "center", light);
      this.drawScore(10, seconds);
    } else if (current) {
      if (current === HIGH_SCORE) fireworks(dots, (seconds - began) % 2.4, 0, 16);
      current.drawText(dots, seconds - began, headline, 2);
      this.drawScore(19, seconds);
    } else if (view.tilted) {
      dots.text(headline, WIDTH / 2, 2, "bold", "center", light);
      this.drawScore(19, seconds);
    } else if (view.phase === "ready") {
      this.drawReady(view, isLit ? headline : "", seconds);
    } else {
      dots.text(headline, WIDTH / 2, 1, "normal", "center", light);
      dots.number(this.displayedScore(seconds), WIDTH / 2, 10);
    }
  }

  /** The animation that should fill the display now; null if there is none. */
  scene(seconds) {
    if (this.isCalm) return null;
    if (this.tiltedSince !== null) {
      const at = seconds - this.tiltedSince;
      return at % (MAX_HIDDEN + LEAST_VISIBLE) < MAX_HIDDEN ? () => tilt(this.dots, at) : null;
    }
    const { current, began } = this.announcements, since = seconds - began;
    return current?.full && since < current.fullTime ? () => current.full(this.dots, since) : null;
  }

  mayHide(seconds) {
    if (this.hiddenSince !== null) return seconds - this.hiddenSince < MAX_HIDDEN;
    if (seconds - this.seenSince < LEAST_VISIBLE) return false;
    this.hiddenSince = seconds;
    return true;
  }

  /** The text above the score, and whether it is bright; empty during normal play. */
  headline(view, seconds) {
    const since = seconds - this.phaseSince[1], { current } = this.announcements;
    if (current) return [current.text, true];
    if (view.tilted) return ["TILT", seconds % 0.5 < 0.25];
    if (view.phase === "ready") return [this.startText, since % 1 < 0.65];
    return view.phase === "over" ? ["GAME OVER", seconds % 1 < 0.6] : ["", true];
  }

  drawScore(y, seconds) {
    this.dots.number(this.displayedScore(seconds), WIDTH / 2, y, WIDTH, SMALL);
  }

  drawPlay(view, seconds) {
    const { dots } = this;
    dots.number(this.displayedScore(seconds), WIDTH / 2, 1, WIDTH - 12);
    this.drawCombo(view.combo, seconds);
    this.drawBalls(view);
    if (view.multiplier > 1) {
      const text = `×${view.multiplier}`, width = dots.width("normal", text) + 4, isLit = seconds % 0.6 < 0.4;
      dots.box(WIDTH - width, STATUS_Y - 1, width, 8, isLit ? FULL : 0);
      dots.text(text, WIDTH - 2, STATUS_Y, "normal", "right", isLit ? 0 : FULL);
    }
    const [middle, light] = this.middle(view, seconds);
    dots.text(middle, WIDTH / 2 + 4, STATUS_Y, "normal", "center", light);
  }

  /** The text in the middle of the lowest line, and its brightness. */
  middle(view, seconds) {
    if (view.saveLeft > 0) {
      const isFast = view.saveLeft < 2;
      return ["BALL SAVE", seconds % (isFast ? 0.25 : 0.5) < (isFast ? 0.15 : 0.3) ? FULL : 0];
    }
    const since = seconds - this.pointsBegan;
    if (this.pointsBegan !== null && since < POINTS_TIME) {
      return [`+${thousands(this.points)}`, round(FULL * (1 - 0.7 * (since / POINTS_TIME)))];
    }
    return view.combo > 1 && !this.note ? [`COMBO ${view.combo}`, 200] : [this.note, HALF];
  }

  drawReady(view, headline, seconds) {
    const { dots } = this, isBest = this.best && !view.score && (seconds - this.phaseSince[1]) % 4 >= 2;
    dots.text(headline, WIDTH / 2, 4, dots.fitting(headline), "center");
    let text = view.balls ? `BALL ${view.ball} OF ${view.balls}` : "FREE PLAY";
    if (view.scores.length) text = `PLAYER ${view.player}, BALL ${view.ball}`;
    if (isBest) text = `BEST ${thousands(this.best)}`;
    dots.text(text, 1, STATUS_Y, "normal", "left", HALF);
    dots.number(this.displayedScore(seconds), WIDTH - 1, 20, WIDTH - dots.width("normal", text) - 8, SMALL, "right");
  }

  drawCombo(combo, seconds) {
    const lit = combo > 1 ? Math.min(combo, COMBO_FULL) : 0, light = lit < COMBO_FULL || seconds % 0.2 < 0.1 ? FULL : HALF;
    for (let cell = 0; cell < lit; cell++) for (const x of [0, WIDTH - 4]) this.dots.box(x, 21 - 3 * cell, 4, 2, light);
  }

  /** Draw the current ball's number, or in free play one dot for each ball. */
  drawBalls(view) {
    if (view.mode === "arcade" && view.balls) {
      this.dots.text(`BALL ${view.ball}/${view.balls}`, 0, STATUS_Y, "normal", "left", HALF);
      return;
    }
    for (let ball = 0; ball < view.maxBalls; ball++) {
      this.dots.text(ball < view.onBoard ? "●" : "○", 7 * ball, STATUS_Y);
    }
  }

  /** Count up to a new score; a lower one belongs to another game and is shown at once. */
  startCounting(score, seconds) {
    if (score === this.scoreTo) return;
    const now = this.displayedScore(seconds);
    this.scoreFrom = now >= 0 && now < score && this.scoreTo >= 0 ? now : score;
    [this.scoreTo, this.scoreChanged] = [score, seconds];
    if (score === 0) this.beatsHighScore = false;
  }

  displayedScore(seconds) {
    const share = Math.min(Math.max((seconds - this.scoreChanged) / COUNT_TIME, 0), 1);
    return this.scoreFrom + round(share * (this.scoreTo - this.scoreFrom));
  }
}
