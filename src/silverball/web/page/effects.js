// Effects that last for a moment: flashes, sparks and trails. The same as drawing/effects.py.

import { KIND } from "./world.js";

const FLASH = 0.45, TRAIL = 0.13, SPACING = 0.7, SINK = 0.2, LEAST_SINK = 2, AHEAD = 0.25;
const SPARK_SPEED = 6, SPARK = 0.38, SPARKS = 12, SPARK_GRAVITY = 14, HITS = 24;
const GOLDEN = 0.6180339887498949;
const LIT_BY = new Set([KIND.HIT, KIND.PASS, KIND.SPIN, KIND.CAPTURED]);

export class Effects {
  /**
   * @param radius Of a ball [u].
   * @param lightShows What web/look.py says of the light shows.
   */
  constructor(radius, lightShows) {
    this.radius = radius;
    this.lightShows = lightShows;
    this.clear();
  }

  clear() {
    this.hits = new Map();
    this.kicks = new Map();
    this.sparked = [];
    this.sinking = [];
    this.paths = new Map();
    this.begun = null; // the light show, and when it began
    this.isBallReady = false;
  }

  add(event, rate) {
    const time = event.tick / rate + event.offset, { x, z, nx, nz, speed } = event;
    if (LIT_BY.has(event.kind)) {
      this.hits.set(event.part, time);
      this.kicks.set(event.part, { time, x, z });
    } else if (event.kind === KIND.CREATED && this.isBallReady) {
      this.isBallReady = false;
      this.begun = { name: "ball start", time };
    } else if (event.kind === KIND.GUTTER) {
      this.sinking.push({ time, x, z, speed: Math.max(speed, LEAST_SINK) });
    }
    if ((event.kind === KIND.HIT || event.kind === KIND.BALL_HIT) && speed > SPARK_SPEED) {
      const at = { x: x - nx * this.radius, z: z - nz * this.radius };
      this.sparked.push({ time, number: event.tick + 7 * event.ball, ...at, normal: Math.atan2(nx, nz), speed });
      if (this.sparked.length > HITS) this.sparked.shift();
    }
  }

  /** Remember the light show that an event of a game begins. */
  addGameEvent({ kind, tick, text }, rate) {
    const { shows, ofEvents, always } = this.lightShows, time = tick / rate;
    const name = kind === "CUE" ? text : ofEvents[kind];
    if (kind === "BALL_READY") this.isBallReady = true;
    if (!Object.hasOwn(shows, name ?? "") || (kind === "BALL_READY" && tick === 0)) return;
    const running = this.show(time);
    if (always.includes(kind) || !running || shows[name].rank >= running.show.rank) this.begun = { name, time };
  }

  /** The light show that runs at a time [s]; null if none does. */
  show(time) {
    if (!this.begun) return null;
    const show = this.lightShows.shows[this.begun.name], age = time - this.begun.time;
    return -AHEAD < age && age < (show.seconds ?? Infinity) ? { show, age: Math.max(age, 0) } : null;
  }

  /** The show that runs while nobody plays. */
  attract(seconds) {
    return { show: this.lightShows.shows.attract, age: seconds };
  }

  /** Pairs of a part that flashes at a time [s], and its strength, 1 to 0. */
  flashes(time) {
    const found = [];
    for (const [part, hit] of [...this.hits]) {
      const left = 1 - (time - hit) / FLASH;
      if (left <= 0 || time - hit <= -AHEAD) this.hits.delete(part);
      else found.push([part, Math.min(left, 1) ** 2]);
    }
    return found;
  }

  /** The last hit of a part before a time [s]. */
  kick(part, time) {
    const kick = this.kicks.get(part);
    return kick === undefined || time - kick.time <= -AHEAD ? null : kick;
  }

  /** Balls that roll under the apron; the world has removed them already. */
  sinkingBalls(time) {
    this.sinking = this.sinking.filter((ball) => -AHEAD < time - ball.time && time - ball.time < SINK);
    return this.sinking.map((ball) => ({
      id: 0, x: ball.x - ball.speed * Math.max(time - ball.time, 0), z: ball.z, level: 0, holder: -1,
    }));
  }

  /** Record where the balls are at a time [s]; the spots of their trails, by the ids of the balls. */
  trails(time, balls) {
    for (const id of [...this.paths.keys()]) if (!balls.some((ball) => ball.id === id)) this.paths.delete(id);
    const found = new Map();
    for (const ball of balls) {
      if (!this.paths.has(ball.id)) this.paths.set(ball.id, []);
      const path = this.paths.get(ball.id);
      if (path.length && path[path.length - 1][0] > time) path.length = 0;
      if (!path.length || path[path.length - 1][0] < time) path.push([time, ball.x, ball.z]);
      while (time - path[0][0] > TRAIL) path.shift();
      found.set(ball.id, this.spots(path, time));
    }
    return found;
  }

  spots(path, now) {
    const spots = [], spacing = SPACING * this.radius;
    let along = 0;
    for (let index = 0; index + 1 < path.length; index++) {
      const [time0, x0, z0] = path[index], [time1, x1, z1] = path[index + 1];
      const length = Math.hypot(x1 - x0, z1 - z0);
      while (along < length) {
        const part = along / length;
        const fresh = Math.min(Math.max(1 - (now - (time0 + part * (time1 - time0))) / TRAIL, 0), 1);
        const radius = this.radius * (0.35 + 0.65 * fresh);
        spots.push({
          x: x0 + part * (x1 - x0), y: this.radius, z: z0 + part * (z1 - z0), radius, strength: fresh * fresh,
        });
        along += spacing;
      }
      along -= length;
    }
    return spots;
  }

  /** The sparks of each hard hit at a time [s]. */
  sparks(time) {
    return this.sparked
      .filter((hit) => 0 <= time - hit.time && time - hit.time < SPARK)
      .map((hit) => this.sparksOf(hit, time - hit.time));
  }

  sparksOf(hit, age) {
    const spots = [], r = this.radius;
    for (let index = 0; index < Math.min(4 + Math.trunc(hit.speed), SPARKS); index++) {
      const chance = (GOLDEN * (index + 1) + 0.317 * hit.number) % 1, other = (7 * chance + 0.113 * index) % 1;
      const fresh = 1 - age / (SPARK * (0.5 + 0.5 * other));
      if (fresh <= 0) continue;
      const direction = hit.normal + (chance - 0.5) * 2.6;
      const path = (2 + 0.32 * hit.speed * (0.4 + other)) * age * (1 - 0.9 * age);
      const rise = r + (1 + 3 * other) * age - 0.5 * SPARK_GRAVITY * age * age;
      spots.push({
        x: hit.x + path * Math.sin(direction), y: Math.max(rise, 0.03), z: hit.z + path * Math.cos(direction),
        radius: r * (0.12 + 0.22 * fresh), strength: fresh,
      });
    }
    return spots;
  }
}
