// Pinned runs beside the one that is shown: what was changed, and what that changed.

import { ALL, kindOf, scaleOf } from "./dials.js";
import { part, t } from "./i18n.js";
import { pushText } from "./push.jsx";
import { differences } from "./setup.js";
import { cleared, digits, shown, unitOf } from "./units.js";

const METRICS = {
  turnover_time: "s",
  arrival_time: "s",
  final_tilt: "angle",
  final_spin: "spin",
  energy_lost: "mJ",
  jumps: "",
  max_jump_gap: "mm",
  min_normal_force: "N",
};

const MOST_DIGITS = 4;

export function Compare({ lab }) {
  const { pins } = lab.state;
  return (
    <div class="compare">
      <p>{t("compare.intro")}</p>
      <p>
        <button type="button" class="strong" onClick={() => lab.pin()}>
          {t("compare.pin")}
        </button>
      </p>
      {pins.length === 0 && <p class="hint">{t("compare.empty")}</p>}
      {pins.map((pin) => (
        <Pinned key={JSON.stringify(pin)} lab={lab} pin={pin} />
      ))}
    </div>
  );
}

function Pinned({ lab, pin }) {
  const { setup, units } = lab.state;
  const ghost = lab.ghostOf(pin);
  const changes = differences(pin, setup);
  return (
    <section class="pinned">
      <h3>{t("compare.changed")}</h3>
      {changes.length === 0 && <p>{t("compare.same")}</p>}
      <ul>
        {changes.map(([field, before, now]) => (
          <li>
            {nameOf(field)}: {valueText(field, before, pin, units)} →{" "}
            {valueText(field, now, setup, units)}
          </li>
        ))}
      </ul>
      {ghost && lab.track && <Table ghost={ghost} track={lab.track} units={units} />}
      <div class="row">
        <button type="button" onClick={() => lab.go(pin)}>
          {t("compare.show")}
        </button>
        <button type="button" onClick={() => lab.unpin(pin)}>
          {t("compare.unpin")}
        </button>
      </div>
    </section>
  );
}

function nameOf(field) {
  if (field === "friction.kind") return t("controls.law");
  if (field === "pushes") return t("push.list");
  return part(`quantities.${field}`)?.name ?? field;
}

function valueText(field, value, setup, units) {
  if (field === "friction.kind") return t(`laws.${value}`);
  if (value === undefined) return "–";
  if (field === "pushes")
    return value.map((push) => pushText(push, setup.problem, units)).join(" · ");
  if (typeof value === "string") return value;
  const dial = ALL.find((one) => one.field === field);
  if (typeof value !== "number" || !dial) return JSON.stringify(value);
  return shown(value / scaleOf(dial, setup), kindOf(dial, setup), units);
}

function Table({ ghost, track, units }) {
  return (
    <table>
      <thead>
        <tr>
          {["quantity", "pinned", "now", "difference"].map((key) => (
            <th scope="col">{t(`compare.${key}`)}</th>
          ))}
        </tr>
      </thead>
      <tbody>
        {Object.keys(METRICS).map((name) => (
          <Row
            name={name}
            before={ghost.header.metrics[name] ?? NaN}
            now={track.header.metrics[name] ?? NaN}
            known={[ghost, track].map(({ digits: known }) => known?.[name] ?? MOST_DIGITS)}
            units={units}
          />
        ))}
      </tbody>
    </table>
  );
}

function Row({ name, before, now, known, units }) {
  const { name: unit, size } = unitOf(METRICS[name], units);
  const missing = name === "turnover_time" ? t("compare.never") : "–";
  const text = (value, otherwise, count = MOST_DIGITS) => {
    if (!Number.isFinite(value)) return otherwise;
    return count ? digits(cleared(value) / size, count) : t("compare.chance");
  };
  const difference = cleared(now - before, Math.max(Math.abs(now), Math.abs(before)));
  return (
    <tr data-metric={name}>
      <th scope="row">
        {t(`metrics.${name}`)}
        {unit ? ` (${unit})` : ""}
      </th>
      <td>{text(before, missing, known[0])}</td>
      <td>{text(now, missing, known[1])}</td>
      <td>{known.every(Boolean) ? text(difference, "–", Math.min(...known)) : "–"}</td>
    </tr>
  );
}
