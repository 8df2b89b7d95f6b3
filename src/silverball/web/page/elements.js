// The elements of a page that are not the picture.

export const byId = (id) => document.getElementById(id);

/** Show a text over the table; nothing if it is empty. */
export function tell(text) {
  byId("notice").textContent = text;
}

/** Make an element within another one. */
export function element(parent, name, properties = {}, text = "") {
  const made = Object.assign(document.createElement(name), properties);
  made.textContent = text;
  // A button that was clicked must not keep the focus, or Space would press it again.
  if (name === "button") made.addEventListener("click", (event) => event.detail && made.blur());
  parent.append(made);
  return made;
}

/** A slider with a label. */
export function slider(parent, label, properties, onInput) {
  const row = element(parent, "label", { className: "slider" }, label);
  const input = element(row, "input", { type: "range", step: 1, ...properties });
  input.addEventListener("input", () => onInput(Number(input.value)));
  return input;
}
