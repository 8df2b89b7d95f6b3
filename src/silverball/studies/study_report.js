"use strict";
const stage = document.getElementById("stage");
const buttons = document.querySelectorAll("[data-game]");
for (const button of buttons) {
  button.addEventListener("click", () => {
    for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
    const frame = document.createElement("iframe");
    frame.title = button.textContent;
    frame.srcdoc = JSON.parse(document.getElementById(`game-${button.dataset.game}`).textContent);
    stage.replaceChildren(frame);
    stage.hidden = false;
    stage.scrollIntoView({ behavior: "smooth", block: "nearest" });
  });
}
