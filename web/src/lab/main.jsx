// Starts the page.

import { render } from "preact";

import { App } from "./app.jsx";
import { Lab } from "./lab.js";
import { printSheet } from "./sheet.js";
import "uplot/dist/uPlot.min.css";
import "./page.css";

const lab = new Lab();
globalThis.tippetopLab = lab;
document.addEventListener("keydown", (event) => {
  if (
    !(event.ctrlKey || event.metaKey) ||
    event.key !== "z" ||
    event.target.matches("input[type=text]")
  )
    return;
  event.preventDefault();
  lab.undo();
});
printSheet(lab);
render(<App lab={lab} />, document.getElementById("lab"));
