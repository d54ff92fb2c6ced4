// One's own top: its shape with a stem to drag, what it weighs, what it will do.

import { useState } from "preact/hooks";

import { foresee } from "../run/foresee.js";
import { t } from "./i18n.js";
import { changed } from "./setup.js";
import { FIRST, MATERIALS, bodyOf, possible, sectionOf, verdictOf } from "./turning.js";
import { digits, shown } from "./units.js";

const DIALS = {
  radius: [0.008, 0.04, 0.0005], face: [0.2, 0.9, 0.01], hollow: [0, 0.95, 0.01], stem: [0.02, 0.07, 0.0005],
  knob: [0.0015, 0.012, 0.0005],
};
const IN_MM = ["radius", "stem", "knob"];

export function Own({ lab }) {
  const [top, make] = useState(lab.own ?? FIRST);
  const { units } = lab.state;
  const set = (changes) => {
    const next = possible({ ...top, ...changes });
    lab.own = next;
    make(next);
  };
  const verdict = verdictOf(top);
  const [ball] = bodyOf(top).shape;
  const shape = { kind: "eccentric_sphere", radius: ball.radius, eccentricity: ball.center / ball.radius };
  const sphere = changed(lab.state.setup, { body: { ...bodyOf(top), shape }, friction: { kind: "viscous", mu: 0.3 }, rolling_resistance: 0 });
  const spins = foresee(sphere.problem)?.critical;
  return (
    <div class="own">
      <p>{t("own.intro")}</p>
      <Section top={top} onDrag={(stem) => set({ stem })} />
      {Object.entries(DIALS).map(([name, [low, high, step]]) => (
        <label class="own-dial"><span>{t(`own.${name}`)} <b>{IN_MM.includes(name) ? `${digits(top[name] * 1e3, 3)} mm` : digits(top[name], 2)}</b></span>
          <input type="range" min={low} max={high} step={step} value={top[name]} data-own={name}
            onInput={(event) => set({ [name]: Number(event.target.value) })} /></label>
      ))}
      <label class="choice"><span>{t("own.material")}</span>
        <select value={top.material} onChange={(event) => set({ material: event.target.value })}>
          {Object.keys(MATERIALS).map((name) => <option value={name}>{t(`own.${name}`)}</option>)}
        </select></label>
      <dl class="facts">
        <dt>{t("own.mass")}</dt><dd>{digits(verdict.mass * 1e3, 3)} g</dd>
        <dt>{t("own.alpha")}</dt><dd>{digits(verdict.alpha, 3)}</dd>
        <dt>{t("own.inertia")}</dt><dd>{digits(verdict.ratio, 3)}</dd>
      </dl>
      <h3>{t("own.before")}</h3>
      <p class="own-verdict" role="status">{sentence(verdict.word, spins, units)}</p>
      <button type="button" class="strong" disabled={verdict.word === "high"}
        onClick={() => lab.go(changed(lab.state.setup, { body: bodyOf(top), rolling_resistance: 0, "contact.liftoff": "fly", duration: 10 }))}>{t("own.spin")}</button>
    </div>
  );
}

function sentence(word, spins, units) {
  if (word === "high") return t("own.high");
  if (word === "never") return t("own.never");
  if (word === "half") return t("own.half");
  if (!Number.isFinite(spins?.upright) || !Number.isFinite(spins?.inverted)) return t("own.canSomehow");
  return t("own.can", { spin: shown(spins.upright, "spin", units, 3), full: shown(spins.inverted, "spin", units, 3) });
}

function Section({ top, onDrag }) {
  const { outer, hollow } = sectionOf(top);
  const [up, down] = [Math.max(top.stem + top.knob, 2.2 * top.radius) + 0.003, top.radius + 0.003];
  const scale = 1000;
  const both = (points) => [...points, ...[...points].reverse().map(([r, z]) => [-r, z])];
  const path = (points) => points.map(([r, z]) => `${(scale * r).toFixed(2)},${(-scale * z).toFixed(2)}`).join(" ");
  const drag = (event) => {
    if (!event.buttons) return;
    const svg = event.currentTarget.ownerSVGElement;
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    onDrag(Math.min(Math.max(-at.y / scale, DIALS.stem[0]), DIALS.stem[1]));
  };
  const key = (event) => {
    const step = { ArrowUp: 0.0005, ArrowDown: -0.0005 }[event.key];
    if (!step) return;
    onDrag(Math.min(Math.max(top.stem + step, DIALS.stem[0]), DIALS.stem[1]));
    event.preventDefault();
  };
  return (
    <svg class="section" viewBox={`-60 ${-scale * up} 120 ${scale * (up + down)}`} role="group" aria-label={t("own.drawing")}>
      <line x1="-60" x2="60" y1={scale * top.radius} y2={scale * top.radius} class="ink" />
      <polygon points={path(both(outer))} class="wood" />
      <polygon points={path(hollow)} class="empty" /><polygon points={path(hollow.map(([r, z]) => [-r, z]))} class="empty" />
      <circle cx="0" cy="0" r="0.8" class="dot" />
      <circle cx="0" cy={scale * verdictOf(top).alpha * top.radius} r="1.6" class="mass" />
      <circle class="grip" cx="0" cy={-scale * top.stem} r={Math.max(scale * top.knob, 5)} tabIndex={0} role="slider"
        aria-label={t("own.stem")} aria-valuemin={DIALS.stem[0] * 1e3} aria-valuemax={DIALS.stem[1] * 1e3} aria-valuenow={Math.round(top.stem * 1e3)}
        aria-valuetext={`${digits(top.stem * 1e3, 3)} mm`}
        onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)} onPointerMove={drag} onKeyDown={key} />
    </svg>
  );
}
