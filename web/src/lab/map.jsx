// The map: where launches end over spin and friction; a square is a launch.

import { useEffect, useRef, useState } from "preact/hooks";

import { Chart } from "./chart.js";
import { frictionKind } from "./dials.js";
import { t } from "./i18n.js";
import { CELLS, cellOf } from "./mapping.js";
import { refusedOther } from "./refusal.js";
import { shown } from "./units.js";

export function MapPanel({ lab }) {
  const host = useRef();
  const [tip, point] = useState("");
  const { units, setup, map } = lab.state;
  const hasFriction = setup.problem.friction.mu !== undefined;
  useEffect(() => {
    const chart = new Chart(host.current, {
      choose: (cell) => lab.go(cellOf(chart.plan, cell)),
      point: (cell) => point(cell ? wordsOf(chart.plan, cell, lab.state.units) : ""),
    });
    lab.chart = chart;
    return () => chart.dispose();
  }, []);
  useEffect(() => {
    if (!map) return undefined;
    lab.chart.load(map);
    const redraw = () => lab.chart.redraw();
    map.addEventListener("cell", redraw);
    return () => map.removeEventListener("cell", redraw);
  }, [map]);
  useEffect(() => lab.chart.paint(lab.state), [units, setup, lab.state.theme]);
  return (
    <div class="map">
      <p>{t("map.intro")}</p>
      {hasFriction ? <Command lab={lab} map={map} /> : <p>{t("map.none")}</p>}
      <p class="hint" role="status">
        {map && !map.isUnderWay && noteOf(map)}
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

const noteOf = ({ count }) =>
  count === CELLS ? t("map.done", { count }) : t("map.stopped", { count, all: CELLS });

// The button that begins to compute a map; while one is computed there is that which stops it.
function Command({ lab, map }) {
  if (map?.isUnderWay) return null;
  return (
    <button type="button" class="strong" onClick={() => lab.draw()}>
      {t(map ? "map.again" : "map.compute")}
    </button>
  );
}

/** How far a map is that is being computed, wherever the visitor is, and what stops it. */
export function MapUnderWay({ lab }) {
  const { map } = lab.state;
  if (!map?.isUnderWay) return null;
  const { count } = map;
  return (
    <div class="busy mapping">
      <label>
        {t("map.under", { count, all: CELLS })} <progress max={CELLS} value={count} />
      </label>
      <button type="button" onClick={() => map.stop()}>
        {t("map.stop")}
      </button>
    </div>
  );
}

function wordsOf(plan, { row, column, answer }, units) {
  const gaps = {
    spin: shown(plan.spins[column], "spin", units),
    mu: shown(plan.frictions[row], frictionKind(plan.setup), units),
  };
  if (answer.error || !Number.isFinite(answer.tilt)) {
    const message =
      (answer.error && refusedOther(answer.error)) ?? t(`statuses.${answer.status.name}`);
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
