// Sounds: the waves of web/waves.py, chosen as by app/sound/voices.py and played by the browser.

import { Music } from "./music.js";
import { KIND, OTHER_BALL } from "./world.js";

const REPEAT = 0.04, RUN = 2, SOFTEST = 0.02, RATTLE_DECAY = 0.25, RATTLE_LIMIT = 3;
const VARIATION = 0.04, ROLL_FULL = 20, ROLL_STILL = 0.15, ROLL_TIME = 0.08, MAX_NEW = 4;
const PADDLE_PLACE = 0.5, FULL_SCALE = 32767;
const BLOWS = new Set([KIND.HIT, KIND.TOUCH, KIND.BALL_HIT, KIND.BALL_TOUCH]);
const ONCE = new Set([KIND.CREATED, KIND.JITTER, KIND.RESET]);

const MOST = 10;

/** The strength of a volume of 0 to 10, as in the window. */
function strengthOf(volume) {
  return (volume / MOST) ** 1.6;
}

export class Sounds {
  /**
   * @param meta What web/waves.py says about the sounds; null: the page is silent.
   * @param bytes All waves, four bits a sample.
   */
  constructor(meta, bytes) {
    this.meta = meta;
    this.bytes = bytes;
    this.context = null;
    this.isOn = true;
    this.volume = this.musicVolume = MOST; // of 10
    this.clear();
  }

  /** Set the strength of all sounds, and of the music among them, 0 to 10. */
  setVolumes(volume, music) {
    [this.volume, this.musicVolume] = [volume, music];
    this.master?.gain.setTargetAtTime(strengthOf(volume), this.context.currentTime, ROLL_TIME);
  }

  /** Forget what was heard, because another moment is shown. */
  clear() {
    this.last = new Map();
    this.rattle = new Map();
    this.run = 0;
    this.runTime = -Infinity;
    this.held = 0;
    this.fresh = 0;
    this.call = { rank: 0, ends: -Infinity }; // the call that sounds
    this.ducked = 1; // how strong music and rolling are beside a call
    this.music?.moods.clear();
    this.silence();
  }

  /** Open the sound; browsers allow it only when somebody has touched or pressed something. */
  start() {
    if (!this.meta || !this.isOn || typeof AudioContext === "undefined") return;
    if (!this.context) this.open();
    if (this.context.state === "suspended") this.context.resume();
  }

  open() {
    this.context = new AudioContext({ latencyHint: "interactive" });
    this.master = new GainNode(this.context, { gain: strengthOf(this.volume) });
    this.master.connect(new DynamicsCompressorNode(this.context, { threshold: -8 })).connect(this.context.destination);
    this.buffers = {};
    for (const [name, layers] of Object.entries(this.meta.waves)) {
      const rate = Array.isArray(this.meta.calls[name]) ? this.meta.callRate : this.meta.rate;
      this.buffers[name] = layers.map(([offset, size]) => this.buffer(this.bytes.subarray(offset, offset + size), rate));
    }
    const drums = Object.fromEntries(this.meta.music.drums.map((name) => [name, this.buffers[`${name} drum`][0]]));
    this.music = new Music(this.context, this.meta.music, drums, this.master);
    this.roll = new GainNode(this.context, { gain: 0 });
    this.roll.connect(this.master);
    this.rolling = new AudioBufferSourceNode(this.context, { buffer: this.buffers.roll[0], loop: true });
    this.rolling.connect(this.roll);
    this.rolling.start();
  }

  buffer(packed, rate) {
    const { steps, changes } = this.meta;
    const buffer = this.context.createBuffer(1, 2 * packed.length, rate), samples = buffer.getChannelData(0);
    let value = 0, index = 0, at = 0;
    for (const byte of packed) for (const code of [byte & 15, byte >> 4]) {
      const size = code & 7, moved = ((2 * size + 1) * steps[index]) >> 3;
      value = Math.min(Math.max(code & 8 ? value - moved : value + moved, -FULL_SCALE), FULL_SCALE);
      index = Math.min(Math.max(index + changes[size], 0), steps.length - 1);
      samples[at++] = value / FULL_SCALE;
    }
    return buffer;
  }

  /** Switch the sound off or on again; whether it is on now. */
  toggle() {
    this.isOn = !this.isOn;
    if (this.isOn) this.start();
    else this.context?.suspend();
    return this.isOn;
  }

  silence() {
    this.roll?.gain.setTargetAtTime(0, this.context.currentTime, ROLL_TIME);
    this.music?.stop();
  }

  get isHeard() {
    return this.isOn && this.context?.state === "running";
  }

  play(name, layer, strength, side, speed = 1, delay = 0) {
    const layers = this.buffers[name];
    if (!layers || strength < SOFTEST) return;
    const buffer = layers[Math.min(layer, layers.length - 1)];
    const playbackRate = speed * (1 + VARIATION * (Math.random() - 0.5)); // no game depends on it
    const source = new AudioBufferSourceNode(this.context, { buffer, playbackRate });
    source.connect(new GainNode(this.context, { gain: strength }))
      .connect(new StereoPannerNode(this.context, { pan: this.meta.spread * side }))
      .connect(this.master);
    source.start(this.context.currentTime + delay);
  }

  /** Play the sound of an event. */
  hear(event, world) {
    if (!this.isHeard) return;
    const time = event.tick / world.rate + event.offset;
    const side = Math.min(Math.max((2 * event.z) / this.meta.width, -1), 1);
    if (BLOWS.has(event.kind)) this.blow(event, time, side);
    else this.mechanism(event, time, side);
  }

  mechanism(event, time, side) {
    const sound = this.meta.mechanisms[event.part]?.[event.kind] ?? this.meta.events[event.kind];
    if (!sound || (ONCE.has(event.kind) && this.isRepeat(`0 ${event.kind}`, time, sound[1]))) return;
    this.play(sound[0], 0, sound[1], side);
  }

  blow(event, time, side) {
    const { meta } = this, sound = event.part === OTHER_BALL ? meta.ball : meta.blows[event.part];
    if (!sound || this.fresh >= MAX_NEW) return;
    const [name, least, climbs] = sound, isHit = event.kind === KIND.HIT || event.kind === KIND.BALL_HIT;
    let strength = Math.min(Math.max(event.speed, 0) / meta.fullSpeed, 1) ** meta.power;
    strength = Math.max(strength, isHit ? least : 0) * this.rattleFactor(event.ball, time);
    if (strength < SOFTEST || this.isRepeat(`${event.ball} ${event.part}`, time, strength)) return;
    if (isHit && climbs) this.climb(time);
    this.fresh++;
    const speed = meta.waves[name].length === 1 && isHit && climbs ? this.bell() : 1;
    this.play(name, event.speed >= meta.hard ? 1 : 0, strength, side, speed);
  }

  isRepeat(key, time, strength) {
    const [before, asStrong] = this.last.get(key) ?? [-Infinity, 0];
    const isRepeat = time - before >= 0 && time - before < REPEAT && strength < 2 * asStrong;
    if (!isRepeat) this.last.set(key, [time, strength]);
    return isRepeat;
  }

  /** 1 for a ball that was quiet, less for one that rattles. */
  rattleFactor(ball, time) {
    const [before, load] = this.rattle.get(ball) ?? [time, 0];
    const more = load * Math.exp(-Math.max(time - before, 0) / RATTLE_DECAY) + 1;
    this.rattle.set(ball, [time, more]);
    return Math.min(1, (RATTLE_LIMIT / more) ** 2);
  }

  climb(time) {
    this.run = time - this.runTime >= 0 && time - this.runTime < RUN ? this.run + 1 : 1;
    this.runTime = time;
  }

  /** The speed of the bell for the n-th hit in a row: up the scale, then around its upper half. */
  bell() {
    const { bells } = this.meta, step = Math.max(this.run, 1) - 1, half = bells.length / 2;
    return bells[step < bells.length ? step : half + ((step - half) % half)];
  }

  /** The sounds of the buttons and of rolling balls; once a frame. */
  hold(buttons, world) {
    this.fresh = 0;
    if (!this.isHeard) {
      this.held = buttons;
      return;
    }
    for (const [bit, up, back] of this.meta.paddles) {
      const isDown = (buttons & bit) !== 0, side = bit === 1 ? -PADDLE_PLACE : PADDLE_PLACE;
      if (isDown === ((this.held & bit) !== 0)) continue;
      if (isDown) this.play("coil", 0, 0.8, side);
      this.play("stop", isDown ? 1 : 0, isDown ? 0.75 : 0.45, side, 1, isDown ? up : back);
    }
    this.held = buttons;
    const speed = Math.max(0, ...world.balls().filter((ball) => !ball.isHeld).map((ball) => Math.hypot(ball.vx, ball.vz)));
    const now = this.context.currentTime, strength = speed > ROLL_STILL ? Math.min(speed / ROLL_FULL, 1) ** 0.6 : 0;
    const beside = this.ducked * (this.music.isPlaying ? this.meta.ducking.rollUnderMusic : 1);
    this.roll.gain.setTargetAtTime(strength * beside, now, ROLL_TIME);
    this.rolling.playbackRate.setTargetAtTime(Math.max(speed / this.meta.rollSpeed, 0.1) ** 0.45, now, ROLL_TIME);
  }

  /** The sounds of what the rules report. */
  announce(events) {
    if (!this.isHeard) return;
    for (const { kind } of events) if (this.meta.messages[kind]) this.play(this.meta.messages[kind], 0, 1, 0);
    this.sing(events.map((event) => this.callOf(event)).filter(Boolean));
  }

  /** The call of an event; nothing if it has none. */
  callOf({ kind, text }) {
    const { cues, modes, kinds } = this.meta.calls;
    return kind === "CUE" ? cues[text] : kind === "MODE_STARTED" ? modes[text] : kinds[kind];
  }

  /** Play the call of the highest rank, unless one of a higher rank still sounds. */
  sing(names) {
    const { calls } = this.meta, now = this.context.currentTime;
    const [name] = names.sort((a, b) => calls[b][0] - calls[a][0]);
    if (!name) return;
    const [rank, seconds] = calls[name];
    if (now < this.call.ends && rank < this.call.rank) return;
    this.call = { rank, ends: now + seconds };
    this.play(name, 0, 1, 0);
  }

  /** Let the music follow a game, some seconds after the last call. */
  follow(game, seconds) {
    if (!this.isHeard) return;
    const { ducked, down, up, tail } = this.meta.ducking, isSung = this.context.currentTime < this.call.ends - tail;
    const goal = isSung ? ducked : 1;
    this.ducked = goal + (this.ducked - goal) * Math.exp(-seconds / (isSung ? down : up));
    this.music.follow(game, seconds, this.ducked * strengthOf(this.musicVolume));
  }
}
