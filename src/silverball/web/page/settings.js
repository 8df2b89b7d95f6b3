// What the player has chosen, and the best scores, kept by the browser where it allows that.

const PREFIX = "silverball ";
export const DEFAULTS = { volume: 7, music: 7, shakes: 1 };

/** A number that was kept; `otherwise` if there is none. */
export function kept(name, otherwise = DEFAULTS[name] ?? 0) {
  try {
    const value = Number(localStorage.getItem(PREFIX + name) ?? otherwise);
    return Number.isFinite(value) ? value : otherwise;
  } catch {
    return otherwise;
  }
}

/** Keep a number, if the browser allows it. */
export function keep(name, value) {
  try {
    localStorage.setItem(PREFIX + name, String(value));
  } catch {
    // a page without storage plays all the same
  }
}
