// The printed sheet: what was launched, what became of it, the scene and the curves.

import { ALL, scaleOf } from "./dials.js";
import { part, t } from "./i18n.js";
import { valueOf } from "./setup.js";
import { shown } from "./units.js";
import { tell } from "./words.js";

export function printSheet(lab) {
  let sheet = null;
  addEventListener("beforeprint", () => {
    if (!lab.track) return;
    sheet = document.createElement("section");
    sheet.className = "print";
    const { headline, details } = tell(lab.track, lab.state.prospect, lab.state.units);
    sheet.append(text("h1", t("page.title")), text("h2", headline), text("p", details.join(" ")), table(lab), picture(lab.player));
    document.querySelector("main").before(sheet);
    sheet.after(text("p", lab.link(), "print address"));
  });
  addEventListener("afterprint", () => {
    for (const one of document.querySelectorAll(".print")) one.remove();
    sheet = null;
  });
}

function text(kind, words, name = "") {
  const element = document.createElement(kind);
  element.textContent = words;
  element.className = name;
  return element;
}

function table({ state: { setup, units } }) {
  const rows = ALL.map((dial) => {
    const value = valueOf(setup, dial.field);
    if (!value) return null;
    const row = document.createElement("tr");
    row.append(text("th", part(`quantities.${dial.field}`).name), text("td", shown(value / scaleOf(dial, setup), dial.kind, units)));
    return row;
  });
  const element = document.createElement("table");
  element.append(...rows.filter(Boolean));
  return element;
}

// What WebGL has drawn is gone after its frame: as an image it stays.
function picture(player) {
  player.draw();
  const image = new Image();
  image.src = player.canvas.toDataURL("image/png");
  return image;
}
