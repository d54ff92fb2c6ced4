// A graph with free axes: any quantity of a run against any, with the values under the pointer.

import { useEffect, useState } from "preact/hooks";

import { part, t } from "./i18n.js";
import { AXES, digits, QUANTITIES, roundStep, unitOf } from "./units.js";

// The drawing's size, the room for its numbers, and most points of its curve.
const [WIDTH, HEIGHT] = [520, 300];
const ROOM = { left: 58, right: 12, top: 10, bottom: 40 };
const MOST = 2000;
const TICKS = 4;
const FIRST = ["tilt", "spin"];

export function Free({ lab }) {
  const axes = lab.state.free ?? FIRST;
  const [, redraw] = useState(0);
  useEffect(() => {
    const call = () => redraw((count) => count + 1);
    lab.addEventListener("run", call);
    return () => lab.removeEventListener("run", call);
  }, []);
  const choose = (place, name) =>
    lab.set({ free: axes.map((one, k) => (k === place ? name : one)) });
  return (
    <details
      class="free"
      open={Boolean(lab.state.free)}
      onToggle={({ target }) => lab.set({ free: target.open ? axes : null })}
    >
      <summary>{t("plots.free")}</summary>
      {lab.state.free && (
        <>
          <div class="row">
            <Axis name="across" value={axes[0]} onChange={(name) => choose(0, name)} />
            <Axis name="up" value={axes[1]} onChange={(name) => choose(1, name)} />
          </div>
          {lab.track && <Graph lab={lab} axes={axes} />}
        </>
      )}
    </details>
  );
}

function Axis({ name, value, onChange }) {
  return (
    <label class="choice">
      <span>{t(`plots.${name}`)}</span>
      <select value={value} onChange={(event) => onChange(event.target.value)}>
        {AXES.map((choice) => (
          <option value={choice}>{labelOf(choice)}</option>
        ))}
      </select>
    </label>
  );
}

const labelOf = (name) => (name === "time" ? t("plots.time") : part(`quantities.${name}`).name);

// Values of a quantity in the visitor's units, with the name of its unit.
function valuesOf(track, name, units) {
  if (name === "time") return { values: track.time, size: 1, unit: "s" };
  const { name: unit, size } = unitOf(QUANTITIES[name], units);
  return { values: track.columns[name], size, unit };
}

function Graph({ lab, axes }) {
  const [place, point] = useState(null);
  const { track } = lab;
  const { units } = lab.state;
  const both = axes.map((name) => valuesOf(track, name, units));
  const stride = Math.max(1, Math.ceil(track.count / MOST));
  const places = Array.from({ length: Math.ceil(track.count / stride) }, (_, k) => k * stride);
  const at = (axis, k) => both[axis].values[k] / both[axis].size;
  const known = places.filter((k) => Number.isFinite(at(0, k)) && Number.isFinite(at(1, k)));
  const [x, y] = [0, 1].map((axis) => scaleOf(known.map((k) => at(axis, k))));
  const across = (k) => ROOM.left + (WIDTH - ROOM.left - ROOM.right) * x.share(at(0, k));
  const up = (k) => HEIGHT - ROOM.bottom - (HEIGHT - ROOM.top - ROOM.bottom) * y.share(at(1, k));
  const find = ({ currentTarget, clientX, clientY }) => {
    const screen = currentTarget.getScreenCTM().inverse();
    const mouse = new DOMPoint(clientX, clientY).matrixTransform(screen);
    const away = (k) => Math.hypot(across(k) - mouse.x, up(k) - mouse.y);
    return known.reduce((best, k) => (away(k) < away(best) ? k : best), known[0]);
  };
  const text = (k) =>
    axes
      .map((name, axis) => `${symbolOf(name)} = ${digits(at(axis, k), 4)} ${both[axis].unit}`)
      .concat(`t = ${digits(track.time[k], 4)} s`)
      .join(", ");
  const name = `${labelOf(axes[1])} / ${labelOf(axes[0])}`;
  return (
    <>
      {/* biome-ignore lint/a11y/useKeyWithClickEvents: the slider of the time does the same */}
      <svg
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        role="img"
        aria-label={`${name}. ${t("plots.ends", { start: text(known[0]), end: text(known.at(-1)) })}`}
        onPointerMove={(event) => point(find(event))}
        onPointerLeave={() => point(null)}
        onClick={(event) => {
          lab.player.toggle(false);
          lab.player.seek(track.time[find(event)]);
        }}
      >
        {x.ticks.map((tick) => (
          <text
            x={ROOM.left + (WIDTH - ROOM.left - ROOM.right) * x.share(tick)}
            y={HEIGHT - 22}
            text-anchor="middle"
          >
            {digits(tick, 3)}
          </text>
        ))}
        {y.ticks.map((tick) => {
          const height = HEIGHT - ROOM.bottom - (HEIGHT - ROOM.top - ROOM.bottom) * y.share(tick);
          return (
            <>
              <line x1={ROOM.left} x2={WIDTH - ROOM.right} y1={height} y2={height} class="grid" />
              <text x={ROOM.left - 6} y={height + 4} text-anchor="end">
                {digits(tick, 3)}
              </text>
            </>
          );
        })}
        <text x={(ROOM.left + WIDTH) / 2} y={HEIGHT - 5} text-anchor="middle">
          {symbolOf(axes[0])} ({both[0].unit || "1"})
        </text>
        <text transform={`translate(12 ${HEIGHT / 2 - 12}) rotate(-90)`} text-anchor="middle">
          {symbolOf(axes[1])} ({both[1].unit || "1"})
        </text>
        <polyline
          points={known.map((k) => `${across(k).toFixed(1)},${up(k).toFixed(1)}`).join(" ")}
          class="curve"
        />
        {place !== null && <circle cx={across(place)} cy={up(place)} r="5" class="dot" />}
      </svg>
      <p class="hint">{place === null ? t("plots.pointer") : text(place)}</p>
    </>
  );
}

const symbolOf = (name) => (name === "time" ? "t" : part(`quantities.${name}`).symbol);

// How values lie between 0 and 1 along an axis, and the numbers beside it.
function scaleOf(values) {
  const low = values.reduce((a, b) => Math.min(a, b), Infinity);
  const high = values.reduce((a, b) => Math.max(a, b), -Infinity);
  const range = Math.max(high - low, 0.02 * Math.max(Math.abs(low), Math.abs(high)), 1e-9);
  const from = (low + high - 1.08 * range) / 2;
  const step = roundStep(range / TICKS);
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.floor(high / step + 1e-9) - first + 1;
  const ticks = Array.from({ length: Math.max(count, 0) }, (_, k) => (first + k) * step);
  return { share: (value) => (value - from) / (1.08 * range), ticks };
}
