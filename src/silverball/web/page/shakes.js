// Shakes of a phone that nudge the table, where the device feels them and its browser tells.

import { keep, kept } from "./settings.js";

const LEAST = 9, REST_MS = 350; // [m/s²] a shove of the hands; a step on the stairs is less
const DIRECTIONS = { 0: ["left", "right", "up"], 90: ["up", "up", "right"], 180: ["right", "left", "up"], 270: ["up", "up", "left"] };

export class Shakes {
  /**
   * @param onShake Called with a direction.
   * @param onFound Called when the device turns out to feel shakes, or may be asked for them.
   */
  constructor(onShake, onFound) {
    this.onShake = onShake;
    this.onFound = onFound;
    this.isKnown = false;
    this.isOn = false;
    this.last = -Infinity;
    if (typeof DeviceMotionEvent === "undefined") return;
    this.mustAsk = typeof DeviceMotionEvent.requestPermission === "function";
    if (this.mustAsk && navigator.maxTouchPoints > 0) setTimeout(onFound);
    addEventListener("devicemotion", (event) => this.feel(event));
  }

  /** Switch them on or off; some browsers ask the player first. */
  async toggle() {
    if (!this.isKnown && this.mustAsk && (await DeviceMotionEvent.requestPermission()) !== "granted") return;
    this.isKnown = true;
    this.isOn = !this.isOn;
    keep("shakes", Number(this.isOn));
  }

  feel({ acceleration, timeStamp }) {
    if (!acceleration || acceleration.x === null) return;
    if (!this.isKnown) {
      this.isKnown = true;
      this.isOn = kept("shakes") !== 0;
      this.onFound();
    }
    const { x, y } = acceleration, size = Math.max(Math.abs(x), Math.abs(y));
    if (!this.isOn || size < LEAST || timeStamp - this.last < REST_MS) return;
    this.last = timeStamp;
    const [left, right, up] = DIRECTIONS[screen.orientation?.angle ?? 0] ?? DIRECTIONS[0];
    this.onShake(Math.abs(x) > Math.abs(y) ? (x < 0 ? left : right) : up);
  }
}
