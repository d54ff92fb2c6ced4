// The map: where launches end over spin and friction, computed from coarse to fine; a square is a launch.

import { useEffect, useRef, useState } from "preact/hooks";

import { Chart, fineness, HIGHEST } from "./chart.js";
import { frictionKind } from "./dials.js";
import { Crew } from "./engine.js";
import { t, translated } from "./i18n.js";
import { changed } from "./setup.js";
import { shown } from "./units.js";

export const COLUMNS = 48;
export const ROWS = 24;

// The launches of a map around one: spins to the highest of the slider, friction over a factor of 100.
export function planOf(setup) {
  const mu = Math.max(setup.problem.friction.mu, 1e-3);
  const round = (value, count) => Number(value.toPrecision(count));
  return {
    setup,
    spins: Array.from({ length: COLUMNS }, (_, k) => round(((k + 0.5) / COLUMNS) * HIGHEST, 4)),
    frictions: Array.from({ length: ROWS }, (_, k) =>
      round(round(mu, 1) * 10 ** (-1 + (2 * k) / (ROWS - 1)), 3),
    ),
  };
}

export function cellOf(plan, { row, column }) {
  return changed(plan.setup, {
    "launch.spin": plan.spins[column],
    "friction.mu": plan.frictions[row],
  });
}

export function MapPanel({ lab }) {
  const host = useRef();
  const [note, say] = useState("");
  const [tip, point] = useState("");
  const [crew, work] = useState(null);
  const { units, setup } = lab.state;
  const hasFriction = setup.problem.friction.mu !== undefined;
  useEffect(() => {
    const chart = new Chart(host.current, {
      choose: (cell) => lab.go(cellOf(chart.plan, cell)),
      point: (cell) => point(cell ? wordsOf(chart.plan, cell, lab.state.units) : ""),
    });
    lab.chart = chart;
    if (lab.map) chart.load(lab.map);
    return () => chart.dispose();
  }, []);
  useEffect(() => lab.chart.paint(lab.state), [units, setup, lab.state.theme]);
  const begin = async () => {
    const plan = planOf(setup);
    lab.map = { plan, cells: new Array(COLUMNS * ROWS).fill(null) };
    lab.chart.load(lab.map);
    const helpers = new Crew();
    work(helpers);
    let count = 0;
    await helpers.follow(jobsOf(plan), (key, answer) => {
      lab.map.cells[key] = answer;
      count += 1;
      lab.chart.redraw();
      if (count % 8 === 0) say(t("map.under", { count, all: COLUMNS * ROWS }));
    });
    if (!helpers.over) say(t("map.done", { count }));
    helpers.stop();
    work(null);
  };
  const stop = () => {
    crew.stop();
    work(null);
  };
  return (
    <div class="map">
      <p>{t("map.intro")}</p>
      {hasFriction ? (
        <Command crew={crew} isComputed={Boolean(lab.map)} onBegin={begin} onStop={stop} />
      ) : (
        <p>{t("map.none")}</p>
      )}
      <p class="hint" role="status">
        {note}
      </p>
      <div class="chart">
        {/* biome-ignore lint/a11y/noInteractiveElementToNoninteractiveRole: arrow keys move a mark on the drawing */}
        <canvas ref={host} tabIndex={0} role="application" aria-label={t("map.label")} />
      </div>
      <div class="key" aria-hidden="true">
        <span>
          {t("map.upright")} <i /> {t("map.inverted")}
        </span>
        <span>
          <b /> {t("map.leaves")}
        </span>
        <span>
          <b class="back" /> {t("map.back")}
        </span>
      </div>
      <p class="hint tip" aria-live="polite">
        {tip}
      </p>
    </div>
  );
}

// The button that begins to compute a map, or stops that.
function Command({ crew, isComputed, onBegin, onStop }) {
  if (crew) {
    return (
      <button type="button" onClick={onStop}>
        {t("map.stop")}
      </button>
    );
  }
  return (
    <button type="button" class="strong" onClick={onBegin}>
      {t(isComputed ? "map.again" : "map.compute")}
    </button>
  );
}

// The cells from coarse to fine.
function* jobsOf(plan) {
  const order = [];
  for (let row = 0; row < ROWS; row++) {
    for (let column = 0; column < COLUMNS; column++) order.push({ row, column });
  }
  order.sort((a, b) => fineness(a) - fineness(b));
  for (const cell of order)
    yield { key: cell.row * COLUMNS + cell.column, setup: cellOf(plan, cell) };
}

function wordsOf(plan, { row, column, answer }, units) {
  const gaps = {
    spin: shown(plan.spins[column], "spin", units),
    mu: shown(plan.frictions[row], frictionKind(plan.setup), units),
  };
  if (answer.error || !Number.isFinite(answer.tilt)) {
    const message =
      (answer.error && translated(answer.error.message)) ?? t(`statuses.${answer.status.name}`);
    return t("map.failed", { ...gaps, message });
  }
  const { tilt, highest, fellBack, flights } = answer;
  const end = { ...gaps, tilt: shown(tilt, "angle", units, 3), flights };
  const text = t(flights ? "map.cellJumps" : "map.cell", end);
  if (!fellBack) return text;
  const from = Number.isFinite(highest) ? highest : Math.PI / 2;
  const key = Number.isFinite(highest) ? "map.cellBack" : "map.cellBackOver";
  return `${text}, ${t(key, { highest: shown(from, "angle", units, 3) })}`;
}
