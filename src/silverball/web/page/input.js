// Keys, touches and gamepads, with the defaults of the window (app/bindings.py).

import { LAUNCH, LEFT, RIGHT } from "./world.js";

const HELD_KEYS = {
  KeyA: LEFT, ArrowLeft: LEFT, ShiftLeft: LEFT, KeyD: RIGHT, ArrowRight: RIGHT, ShiftRight: RIGHT, Enter: LAUNCH,
};
const KEYS = {
  Space: "create", KeyZ: "nudge left", KeyX: "nudge right", ArrowUp: "nudge up", KeyP: "pause", Escape: "pause", KeyM: "mute",
  KeyR: "restart",
};
// Of the standard layout: A, B, X, Y, the shoulders, the triggers, back, start, the sticks, the directions.
const HELD_BUTTONS = { 4: LEFT, 6: LEFT, 14: LEFT, 1: RIGHT, 5: RIGHT, 7: RIGHT, 15: RIGHT, 13: LAUNCH };
const BUTTONS = { 0: "create", 2: "nudge left", 3: "nudge left", 12: "nudge up", 9: "pause" };
// The axes of both sticks of the standard layout, and what a flick of one does.
const STICKS = [["nudge left", "nudge right"], ["nudge up", ""], ["nudge left", "nudge right"], ["nudge up", ""]];
const STICK_DOWN = 0.6;
const STICK_UP = 0.3;

export class Input {
  /**
   * @param surface The element whose left and right halves are the paddles' buttons.
   * @param onAction Called with the name of an action: create, nudge left (right, up), pause, mute, restart.
   * @param drawsPlunger Whether the button of a new ball draws the plunger back instead.
   */
  constructor(surface, onAction, drawsPlunger = () => false) {
    this.onAction = onAction;
    this.drawsPlunger = drawsPlunger;
    this.keys = new Map();
    this.touches = new Map();
    this.pads = 0;
    this.tapped = 0; // buttons that went down since the last look: a tap holds a paddle for one tick at least
    this.padsDown = new Set();
    this.drawing = new Set(); // buttons of pads that draw the plunger back
    addEventListener("keydown", (event) => this.keyDown(event));
    addEventListener("keyup", (event) => this.keys.delete(event.code));
    addEventListener("blur", () => this.clear());
    surface.addEventListener("pointerdown", (event) => this.touchDown(event, surface));
    for (const name of ["pointerup", "pointercancel"]) addEventListener(name, (event) => this.touches.delete(event.pointerId));
    surface.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  clear() {
    this.keys.clear();
    this.touches.clear();
    this.pads = this.tapped = 0;
  }

  keyDown(event) {
    const bit = HELD_KEYS[event.code], action = KEYS[event.code];
    if (event.ctrlKey || event.altKey || event.metaKey || (!bit && !action)) return;
    if (event.target.closest?.("input")) return;
    if (event.target.closest?.("button") && (event.code === "Space" || event.code === "Enter")) return;
    event.preventDefault();
    if (event.repeat) return;
    if (bit) this.hold(this.keys, event.code, bit);
    else if (action === "create" && this.drawsPlunger()) this.hold(this.keys, event.code, LAUNCH);
    else this.onAction(action);
  }

  touchDown(event, surface) {
    if (event.button !== 0 || event.target.closest?.("#menu")) return;
    event.preventDefault();
    const { left, width } = surface.getBoundingClientRect();
    this.hold(this.touches, event.pointerId, event.clientX < left + width / 2 ? LEFT : RIGHT);
    this.onAction("touch");
  }

  hold(held, name, bit) {
    held.set(name, bit);
    this.tapped |= bit;
  }

  /**
   * Let an element hold a button while it is pressed.
   * @param holds Whether it does so now; otherwise it acts.
   */
  bind(element, bit, holds, act) {
    element.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      if (holds()) this.hold(this.touches, event.pointerId, bit);
      else act();
    });
    element.addEventListener("click", (event) => event.detail === 0 && act()); // by a key
  }

  /** Look at the gamepads; to be called once a frame. */
  poll() {
    this.pads = 0;
    const down = new Set();
    for (const pad of navigator.getGamepads?.() ?? []) {
      pad?.buttons.forEach((button, index) => {
        if (!button.pressed) return;
        this.pads |= HELD_BUTTONS[index] ?? 0;
        const name = `${pad.index} ${index}`;
        down.add(name);
        if (this.drawing.has(name)) this.pads |= LAUNCH;
        if (this.padsDown.has(name) || !BUTTONS[index]) return;
        if (BUTTONS[index] === "create" && this.drawsPlunger()) this.drawing.add(name);
        else this.onAction(BUTTONS[index]);
      });
      pad?.axes.forEach((value, index) => this.flick(`${pad.index} axis ${index}`, value, STICKS[index], down));
    }
    this.padsDown = down;
    for (const name of this.drawing) if (!down.has(name)) this.drawing.delete(name);
  }

  /** A stick that is flicked acts once. */
  flick(name, value, actions, down) {
    (actions ?? []).forEach((action, side) => {
      const tilt = side ? value : -value, source = `${name} ${side}`, wasDown = this.padsDown.has(source);
      if (tilt < (wasDown ? STICK_UP : STICK_DOWN)) return;
      down.add(source);
      if (!wasDown && action) this.onAction(action);
    });
  }

  /** The bits of the buttons that are down. */
  get buttons() {
    let bits = this.pads;
    for (const bit of this.keys.values()) bits |= bit;
    for (const bit of this.touches.values()) bits |= bit;
    return bits;
  }

  /** The same with those that were only tapped since the last call. */
  takeButtons() {
    const bits = this.buttons | this.tapped;
    this.tapped = 0;
    return bits;
  }
}
