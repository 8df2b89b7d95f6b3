// One world in the module: its record, its events, and the kernels that move it.

export const LEFT = 1;
export const RIGHT = 2;
export const JITTER = 4;
export const LAUNCH = 8;
export const NUDGES = { left: 16, right: 32, up: 64 };

export const KIND = {
  HIT: 1, TOUCH: 2, BALL_HIT: 3, BALL_TOUCH: 4, GUTTER: 5, CREATED: 6, JITTER: 7, JAM: 8, PASS: 9, SPIN: 10,
  CAPTURED: 11, RELEASED: 12, RESET: 13,
};
export const OTHER_BALL = -3;
const CAPTURED_MOTION = 4;

export class World {
  /**
   * @param memory The module's memory.
   * @param pack The bytes of all arrays.
   * @param meta What web/world_meta.py says about them.
   */
  constructor(memory, pack, meta) {
    this.memory = memory;
    this.meta = meta;
    this.rate = meta.rate;
    this.at = {};
    this.shape = {};
    for (const name of ["world", "board", "collider", "grid", "place", "log", "tally"]) {
      const [offset, size, shape] = meta.arrays[name];
      this.at[name] = memory.put(pack.subarray(offset, offset + size));
      this.shape[name] = shape;
    }
    const suffix = meta.isPlain ? "_plain" : "";
    this.stepKernel = memory.exports[`step${suffix}`];
    this.createKernel = memory.exports[`create_ball${suffix}`];
    this.addresses = memory.room(8 * meta.addresses.length);
    const lengths = { colliders: this.shape.collider[0], numbers: this.shape.grid[0], parts: this.shape.tally[1] };
    meta.addresses.forEach((name, index) => {
      const at = this.addresses + 8 * index;
      if (name === "tick") memory.view.setFloat64(at, 1 / this.rate, true);
      else memory.writeInt(at, this.at[name] ?? lengths[name] ?? 0);
    });
    this.size = meta.layout.world.size;
    this.first = memory.bytes.slice(this.at.world, this.at.world + this.size);
  }

  /** Begin again. */
  restart() {
    const { bytes } = this.memory, { log, tally } = this.meta.arrays;
    bytes.set(this.first, this.at.world);
    bytes.fill(0, this.at.log, this.at.log + log[1]);
    bytes.fill(0, this.at.tally, this.at.tally + tally[1]);
  }

  /** Advance by some ticks with these buttons; the shove comes before the first one. */
  step(buttons, ticks) {
    return this.stepKernel(this.addresses, 1, buttons, ticks);
  }

  /** Create a ball; false if there is no room for one. */
  createBall() {
    const { at, shape } = this;
    return this.createKernel(at.world, at.board, at.collider, shape.collider[0], at.place, ...shape.place, at.log) === 0;
  }

  int(name) {
    return this.memory.int(this.at.world + this.meta.layout.world.fields[name]);
  }

  /** The seed of everything random; a new one counts from the next beginning on. */
  get seed() {
    return Number(this.memory.view.getBigInt64(this.at.world + this.meta.layout.world.fields.seed, true));
  }

  set seed(seed) {
    const { seed: offset } = this.meta.layout.world.fields;
    new DataView(this.first.buffer).setBigInt64(offset, BigInt(seed), true);
  }

  get tick() {
    return this.int("tick");
  }

  get time() {
    return this.tick * (1 / this.rate); // as `Moment` computes it, to the last bit
  }

  get isFaulty() {
    return this.int("fault") !== 0;
  }

  /** The bytes of the record, without those of its cabinet if that is at rest; see `world_bytes`. */
  record() {
    const { bytes } = this.memory, still = this.at.world + this.meta.stillSize, end = this.at.world + this.size;
    return bytes.slice(this.at.world, bytes.subarray(still, end).some((byte) => byte) ? end : still);
  }

  /** How far a nudge has moved the cabinet, up and to the right [u]. */
  get cabinet() {
    const { fields } = this.meta.layout.world, { memory } = this;
    if (!this.meta.hasNudge) return [0, 0];
    return [memory.double(this.at.world + fields.cabinet_x), memory.double(this.at.world + fields.cabinet_z)];
  }

  /** The balls on the board. */
  balls() {
    const { world, ball } = this.meta.layout, { memory } = this, balls = [];
    for (let slot = 0; slot < ball.count; slot++) {
      const at = this.at.world + world.fields.ball + slot * ball.size, f = ball.fields;
      const id = memory.int(at + f.id);
      if (id === 0) continue;
      const isHeld = memory.int(at + f.motion) === CAPTURED_MOTION;
      balls.push({
        id, x: memory.double(at + f.x), z: memory.double(at + f.z),
        vx: memory.double(at + f.vx), vz: memory.double(at + f.vz), isHeld,
        level: f.level === undefined ? 0 : memory.int(at + f.level),
        holder: f.holder === undefined || !isHeld ? -1 : memory.int(at + f.holder),
        isDue: isHeld && f.due_tick !== undefined && memory.int(at + f.due_tick) !== 0,
      });
    }
    return balls;
  }

  /** The angle of a paddle [degrees]. */
  angle(number) {
    const { world, paddle } = this.meta.layout;
    const at = this.at.world + world.fields.paddle + number * paddle.size + paddle.fields.angle;
    return this.memory.double(at) * (180 / Math.PI);
  }

  /** A spinner: angle [rad], speed [rad/s], and the time at which it had both [s]. */
  blade(number) {
    const { world, spinner } = this.meta.layout, { memory } = this;
    if (!spinner) return { angle: 0, speed: 0, time: 0 };
    const at = this.at.world + world.fields.spinner + number * spinner.size, f = spinner.fields;
    return {
      angle: memory.double(at + f.angle), speed: memory.double(at + f.speed),
      time: memory.int(at + f.tick) * (1 / this.rate) + memory.double(at + f.offset),
    };
  }

  /** Whether a switch is off: a drop target has fallen, a gate is open. */
  isOff(bit) {
    const at = this.at.world + this.meta.layout.world.fields.off;
    return bit >= 0 && (this.memory.view.getBigInt64(at, true) >> BigInt(bit)) & 1n ? true : false;
  }

  /** How long the launch button has been held [s]. */
  get launchHeld() {
    return this.meta.isPlain ? 0 : this.int("launch_held") * (1 / this.rate);
  }

  /** The events of the last step, those of balls created before it included. */
  events() {
    const { log, event } = this.meta.layout, { memory } = this, f = event.fields, events = [];
    const count = memory.int(this.at.log + log.fields.count);
    for (let index = 0; index < count; index++) {
      const at = this.at.log + log.fields.event + index * event.size;
      events.push({
        kind: memory.int(at + f.kind), part: memory.int(at + f.part), ball: memory.int(at + f.ball),
        tick: memory.int(at + f.tick), offset: memory.double(at + f.offset),
        x: memory.double(at + f.x), z: memory.double(at + f.z),
        nx: memory.double(at + f.normal_x), nz: memory.double(at + f.normal_z), speed: memory.double(at + f.speed),
      });
    }
    return events;
  }

  /** Whether anything has happened in the last step. */
  get hasNewEvents() {
    const { count, carried } = this.meta.layout.log.fields, { log } = this.at;
    return this.memory.int(log + count) > this.memory.int(log + carried);
  }

  get eventsLost() {
    return this.memory.int(this.at.log + this.meta.layout.log.fields.lost);
  }

  /** Hits of every part since the beginning. */
  tally(part) {
    return this.memory.int(this.at.tally + 8 * part);
  }
}
