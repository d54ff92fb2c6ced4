// Starts the page.

import { render } from "preact";

import { followTheme } from "../player/theme.js";
import { App, isDark } from "./app.jsx";
import { preferred, speak } from "./i18n.js";
import { Lab } from "./lab.js";
import { printSheet } from "./sheet.js";
import { TorquePicture } from "./torque.jsx";
import "uplot/dist/uPlot.min.css";
import "./page.css";

const TYPED = "textarea, input:not([type=range], [type=checkbox], [type=radio], [type=file])";
const host = document.getElementById("lab");
const query = new URLSearchParams(location.hash.slice(1));
if (query.get("picture") === "torque") showPicture(query.get("lang") ?? preferred());
else showLab();

function showLab() {
  const lab = new Lab();
  globalThis.tippetopLab = lab;
  document.addEventListener("keydown", (event) => {
    const isUndo = (event.ctrlKey || event.metaKey) && event.key === "z";
    // What is typed somewhere is taken back there.
    if (!isUndo || event.target.matches(TYPED)) return;
    event.preventDefault();
    lab.undo();
  });
  printSheet(lab);
  followTheme((theme) => lab.set({ theme }));
  render(<App lab={lab} />, host);
}

// The picture of the torque alone, for pages that show it in a frame.
function showPicture(language) {
  speak(language);
  document.documentElement.lang = language;
  const { dataset } = document.documentElement;
  dataset.theme = isDark("auto") ? "dark" : "light";
  followTheme((theme) => {
    dataset.theme = theme;
  });
  render(
    <main class="alone">
      <TorquePicture />
    </main>,
    host,
  );
}
