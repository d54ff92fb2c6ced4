// The printed sheet: what was launched, what became of it, the scene and the curves.

import { ALL, kindOf, scaleOf } from "./dials.js";
import { part, t } from "./i18n.js";
import { fieldValue } from "./setup.js";
import { questionOf, veilOf } from "./story.jsx";
import { digits, shown } from "./units.js";
import { tell } from "./words.js";

// Two plots beside each other on a sheet, and the picture's pixels for each of the screen's.
const PLOT = [340, 162];
const FINE = 2;

export function printSheet(lab) {
  addEventListener("beforeprint", () => {
    if (!lab.track) return;
    const sheet = document.createElement("section");
    sheet.className = "print";
    // Before a guess, the question is printed and not its answer.
    const { headline, details } = veilOf(lab.state)
      ? { headline: questionOf(lab.state.step), details: [] }
      : tell(lab.track, lab.state.units);
    // Paper is white.
    lab.player.setTheme("light");
    lab.drawPlots(false);
    sheet.append(
      text("h1", t("page.title")),
      text("h2", headline),
      text("p", details.join(" ")),
      table(lab),
      picture(lab.player),
    );
    lab.plots.size(...PLOT);
    document.querySelector("main").before(sheet);
    sheet.after(text("p", lab.link(), "print address"));
  });
  addEventListener("afterprint", () => {
    for (const one of document.querySelectorAll(".print")) one.remove();
    lab.plots?.size();
    const { theme } = document.documentElement.dataset;
    lab.player.setTheme(theme);
    lab.drawPlots(theme === "dark");
  });
}

function text(kind, words, name = "") {
  const element = document.createElement(kind);
  element.textContent = words;
  element.className = name;
  return element;
}

function table({ state: { setup, units } }) {
  const { kind } = setup.problem.friction;
  const row = (name, value) => {
    const line = document.createElement("tr");
    line.append(text("th", name), text("td", value));
    return line;
  };
  const rows = ALL.map((dial) => {
    const value = fieldValue(setup, dial.field);
    if (!value) return null;
    return row(
      part(`quantities.${dial.field}`).name,
      shown(value / scaleOf(dial, setup), kindOf(dial, setup), units),
    );
  });
  const element = document.createElement("table");
  element.append(row(t("controls.law"), t(`laws.${kind}`)), ...rows.filter(Boolean));
  return element;
}

// The scene as it is now, with the moment that it shows.
function picture(player) {
  const figure = document.createElement("figure");
  const image = new Image();
  image.src = player.finely(FINE, () => player.canvas.toDataURL("image/png"));
  figure.append(
    image,
    text("figcaption", `${t("plots.time").replace(/ \(s\)$/, "")} ${digits(player.time, 4)} s`),
  );
  return figure;
}
