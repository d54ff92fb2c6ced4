// Pinned runs beside the one that is shown: what was changed, and what that changed.

import { ALL, kindOf, scaleOf } from "./dials.js";
import { part, t } from "./i18n.js";
import { differences } from "./setup.js";
import { digits, shown, unitOf } from "./units.js";

const METRICS = {
  turns_over: "s",
  arrives: "s",
  final_theta: "angle",
  final_omega3: "spin",
  energy_lost: "mJ",
  flights: "",
  highest_gap: "mm",
  least_normal_force: "N",
};

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
            {nameOf(field)}: {valueOf(field, before, pin, units)} →{" "}
            {valueOf(field, now, setup, units)}
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
  return (
    part(`quantities.${field}`)?.name ?? (field === "friction.kind" ? t("controls.law") : field)
  );
}

function valueOf(field, value, setup, units) {
  const dial = ALL.find((one) => one.field === field);
  if (field === "friction.kind") return t(`laws.${value}`);
  if (typeof value !== "number" || !dial)
    return value === undefined ? "–" : typeof value === "string" ? value : JSON.stringify(value);
  return shown(value / scaleOf(dial, setup), kindOf(dial, setup), units);
}

function Table({ ghost, track, units }) {
  const [was, is] = [ghost.header.metrics, track.header.metrics];
  const told = (value, kind, name) =>
    Number.isFinite(value)
      ? digits(value / unitOf(kind, units).size, 4)
      : name === "turns_over"
        ? t("compare.never")
        : "–";
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
        {Object.entries(METRICS).map(([name, kind]) => {
          const [a, b] = [was[name] ?? NaN, is[name] ?? NaN];
          const unit = unitOf(kind, units).name;
          return (
            <tr data-metric={name}>
              <th scope="row">
                {t(`metrics.${name}`)}
                {unit ? ` (${unit})` : ""}
              </th>
              <td>{told(a, kind, name)}</td>
              <td>{told(b, kind, name)}</td>
              <td>{told(b - a, kind)}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
