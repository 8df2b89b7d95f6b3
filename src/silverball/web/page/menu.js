// The menu of a page: begin and go on, mode and players, volumes, saving; and what a finished game came to.

import { element, slider } from "./elements.js";
import { DEFAULTS, keep, kept } from "./settings.js";

const MODE_NAMES = { arcade: "Arcade", free: "Free play" }, MOST_VOLUME = 10, MOST_PLAYERS = 4;

export class Menu {
  /**
   * @param panel The element that it fills.
   * @param page The page that it is the menu of.
   */
  constructor(panel, page) {
    this.panel = panel;
    this.page = page;
    this.title = element(panel, "h1", {}, page.stage.title);
    this.lines = element(panel, "div", { className: "lines" });
    this.playButton = element(panel, "button", { className: "main", onclick: () => page.goOn() });
    this.againButton = element(panel, "button", { onclick: () => page.begin() }, "Again");
    this.modes = this.choices(page.modes.map((mode) => [MODE_NAMES[mode], () => page.choose(mode, page.players)]));
    this.players = this.choices(Array.from({ length: MOST_PLAYERS }, (_, index) => [
      String(index + 1), () => page.choose(page.mode, index + 1)]), "Players");
    this.addSounds();
    this.saveButton = element(panel, "button", { onclick: () => page.save() }, "Save replay");
    this.shakeButton = element(panel, "button", { onclick: () => this.toggleShakes(), hidden: true });
    element(panel, "p", { className: "keys" }, page.keyText());
    element(panel, "p", { className: "touches" }, "Touch the left and the right half: paddles");
  }

  get isOpen() {
    return !this.panel.hidden;
  }

  /** A row of buttons of which one is chosen. */
  choices(entries, label = "") {
    const row = element(this.panel, "div", { className: "row" });
    if (label) element(row, "span", {}, label);
    return entries.map(([label, onclick]) => element(row, "button", { onclick }, label));
  }

  addSounds() {
    const { sounds } = this.page.stage;
    if (!sounds.meta) return;
    const row = element(this.panel, "div", { className: "row" }), change = () => {
      const [volume, music] = [this.volume, this.music].map((input) => Number(input.value));
      sounds.start();
      sounds.setVolumes(volume, music);
      keep("volume", volume);
      keep("music", music);
    };
    const make = (label, name) => slider(row, label, { min: 0, max: MOST_VOLUME, value: kept(name, DEFAULTS[name]) }, change);
    this.volume = make("Sound", "volume");
    this.music = make("Music", "music");
    this.soundButton = element(row, "button", { onclick: () => this.page.act("mute") }, "Sound off");
  }

  open() {
    this.panel.hidden = false;
    this.show();
  }

  close() {
    this.panel.hidden = true;
  }

  /** Bring what it says up to date. */
  show() {
    const { page } = this, isNew = page.isWaiting || page.game.isOver;
    this.playButton.textContent = isNew ? "Play" : "Go on";
    this.againButton.hidden = isNew;
    this.saveButton.hidden = page.isWaiting;
    this.lines.replaceChildren();
    for (const line of page.results()) element(this.lines, "p", {}, line);
    this.mark(this.modes, page.modes.indexOf(page.mode));
    this.mark(this.players, page.players - 1);
    for (const button of this.players) button.disabled = page.mode !== "arcade";
  }

  mark(buttons, chosen) {
    buttons.forEach((button, index) => button.setAttribute("aria-pressed", String(index === chosen)));
  }

  showSound(isOn) {
    if (this.soundButton) this.soundButton.textContent = isOn ? "Sound off" : "Sound on";
  }

  /** Show the button of the shakes, on a device that feels them. */
  offerShakes() {
    this.shakeButton.hidden = false;
    this.showShakes();
  }

  async toggleShakes() {
    await this.page.shakes.toggle();
    this.showShakes();
  }

  showShakes() {
    this.shakeButton.textContent = this.page.shakes.isOn ? "Shaking nudges: on" : "Shaking nudges: off";
  }
}
