// One's own top: its shape with a stem to drag, what it weighs, what it will do.

import { useEffect, useState } from "preact/hooks";

import { Bring, Brought, dropping } from "./brought.jsx";
import { t } from "./i18n.js";
import { changed, withPushes } from "./setup.js";
import { NamedSlider } from "./slider.jsx";
import { bodyOf, FIRST, MATERIALS, massesOf, possible, SIZES, sectionOf } from "./turning.js";
import { digits, shown } from "./units.js";

// How long after a change advice is asked for, ms; the least spins that a hand reaches, rad/s, and how far beyond its own
// a top is spun: ball and stem lose as much while both touch.
const QUIET = 400;
const REACH = 200;
const BEYOND = 1.25;
const IN_MM = ["radius", "stem", "knob"];
// Millimetres to the metre, and the room around the drawing, m.
const MM = 1e3;
const EDGE = 0.003;

export function Own({ lab }) {
  const { brought, units } = lab.state;
  return (
    <div class="own" {...dropping(lab)}>
      {brought?.content ? (
        <Brought lab={lab}>{(body) => <Verdict lab={lab} body={body} units={units} />}</Brought>
      ) : (
        <Shaped lab={lab} />
      )}
      <Bring lab={lab} />
    </div>
  );
}

// What a body will do, before it is spun.
function Verdict({ lab, body, units }) {
  const ahead = useProspects(lab, body);
  return (
    <>
      <h3>{t("own.before")}</h3>
      <p class="own-verdict" role="status">
        {ahead === null ? t("controls.unknown") : sentence(ahead, units)}
      </p>
    </>
  );
}

// A top that is shaped by its sliders.
function Shaped({ lab }) {
  const { units, own } = lab.state;
  const top = own ?? FIRST;
  const set = (changes) => lab.set({ own: possible({ ...top, ...changes }) });
  const { mass, alpha, ratio } = massesOf(top);
  const body = bodyOf(top);
  const ahead = useProspects(lab, body);
  const least = ahead?.table === "creeps" ? ahead.stem?.launch : undefined;
  const spin = () => {
    const launch = { body, rolling_resistance: 0, "contact.liftoff": "fly", duration: 15 };
    if (least <= REACH) launch["launch.spin"] = Math.round(BEYOND * least);
    lab.go(changed(withPushes(lab.state.setup, []), launch));
  };
  return (
    <>
      <p>{t("own.intro")}</p>
      <Section top={top} onDrag={(stem) => set({ stem })} />
      {Object.keys(SIZES).map((name) => (
        <NamedSlider
          name={t(`own.${name}`)}
          text={sizeText(name, top[name])}
          range={SIZES[name]}
          value={top[name]}
          mark={name}
          onChange={(value) => set({ [name]: value })}
        />
      ))}
      <Material value={top.material} onChange={(material) => set({ material })} />
      <dl class="facts">
        <dt>{t("own.mass")}</dt>
        <dd>{digits(mass * 1e3, 3)} g</dd>
        <dt>{t("own.alpha")}</dt>
        <dd>{digits(alpha, 3)}</dd>
        <dt>{t("own.inertia")}</dt>
        <dd>{digits(ratio, 3)}</dd>
      </dl>
      <h3>{t("own.before")}</h3>
      <p class="own-verdict" role="status">
        {sentence(ahead, units)}
      </p>
      {ahead !== undefined && !(ahead?.stem?.launch <= REACH) && (
        <Advice lab={lab} top={top} units={units} set={set} />
      )}
      <button type="button" class="strong" disabled={alpha <= 0} onClick={spin}>
        {t("own.spin")}
      </button>
    </>
  );
}

const sizeText = (name, value) =>
  IN_MM.includes(name) ? `${digits(value * MM, 3)} mm` : digits(value, 2);

// What to change in a top that does not stand at any spin within reach: each a button that does it.
function Advice({ lab, top, units, set }) {
  const [found, say] = useState(null);
  const { problem } = lab.state.setup;
  useEffect(() => {
    say(null);
    let isWanted = true;
    const ask = () =>
      lab.engine.advice(top, REACH, problem).then(
        (answer) => isWanted && say(answer),
        () => {},
      );
    const waiting = setTimeout(ask, QUIET);
    return () => {
      isWanted = false;
      clearTimeout(waiting);
    };
  }, [JSON.stringify(top), problem.gravity, problem.launch.tilt]);
  if (!found) return null;
  if (!found.length) return <p class="hint">{t("own.noAdvice")}</p>;
  return (
    <div class="advice" role="group" aria-label={t("own.advice")}>
      <p>{t("own.advice")}</p>
      {found.map(({ name, value, spin }) => (
        <button type="button" data-advice={name} onClick={() => set({ [name]: value })}>
          {t("own.advise", {
            name: t(`own.${name}`),
            value: sizeText(name, value),
            spin: shown(spin, "spin", units, 3),
          })}
        </button>
      ))}
    </div>
  );
}

function Material({ value, onChange }) {
  return (
    <label class="choice">
      <span>{t("own.material")}</span>
      <select value={value} onChange={(event) => onChange(event.target.value)}>
        {Object.keys(MATERIALS).map((name) => (
          <option value={name}>{t(`own.${name}`)}</option>
        ))}
      </select>
    </label>
  );
}

// What a worker says of a body: nothing yet while it thinks, null of one that does not stand on its ball.
function useProspects(lab, body) {
  const [ahead, say] = useState(undefined);
  const { problem } = lab.state.setup;
  useEffect(() => {
    let isWanted = true;
    const answer = (prospects) => {
      if (isWanted) say(prospects);
    };
    // A body that the engine refuses has no prospects.
    lab.engine.prospects(body, problem).then(answer, () => {});
    return () => {
      isWanted = false;
    };
  }, [JSON.stringify([body, problem.friction]), problem.gravity, problem.launch.tilt]);
  return ahead;
}

function sentence(ahead, units) {
  if (ahead === undefined) return "";
  if (ahead === null) return t("own.high");
  if (ahead.table === "none" || ahead.table === "sticks") return t(`own.table.${ahead.table}`);
  const words = spinsInWords(ahead, units);
  return ahead.table === "drills" ? `${t("own.table.drills")} ${words}` : words;
}

// What a body does at which spins where friction creeps and takes no spin.
function spinsInWords({ group, critical_spins: { upright }, touch, stem }, units) {
  const text = (spin) => shown(spin, "spin", units, 3);
  if (group.startsWith("I") && !group.startsWith("II")) return t("own.never");
  if (!Number.isFinite(touch?.spin)) return t("own.half", { spin: text(upright) });
  if (!Number.isFinite(stem?.launch))
    return t("own.leans", { spin: text(upright), touch: text(touch.spin) });
  return t("own.can", { spin: text(upright), touch: text(touch.spin), stand: text(stem.launch) });
}

function Section({ top, onDrag }) {
  const { outer, hollow } = sectionOf(top);
  const up = Math.max(top.stem + top.knob, 2.2 * top.radius) + EDGE;
  const down = top.radius + EDGE;
  const mirrored = (points) => points.map(([r, z]) => [-r, z]);
  return (
    <svg
      class="section"
      viewBox={`-60 ${-MM * up} 120 ${MM * (up + down)}`}
      role="group"
      aria-label={t("own.drawing")}
    >
      <line x1="-60" x2="60" y1={MM * top.radius} y2={MM * top.radius} class="ink" />
      <polygon points={pathOf([...outer, ...mirrored(outer).reverse()])} class="wood" />
      <polygon points={pathOf(hollow)} class="empty" />
      <polygon points={pathOf(mirrored(hollow))} class="empty" />
      <circle cx="0" cy="0" r="0.8" class="dot" />
      <circle cx="0" cy={MM * massesOf(top).alpha * top.radius} r="1.6" class="mass" />
      <Grip top={top} onDrag={onDrag} />
    </svg>
  );
}

// Points as an SVG's, in mm, with z up.
function pathOf(points) {
  return points.map(([r, z]) => `${(MM * r).toFixed(2)},${(-MM * z).toFixed(2)}`).join(" ");
}

// The end of the stem, to be dragged or moved by keys.
function Grip({ top, onDrag }) {
  const [shortest, longest, step] = SIZES.stem;
  const setStem = (stem) => onDrag(Math.min(Math.max(stem, shortest), longest));
  const drag = (event) => {
    if (!event.buttons) return;
    const screen = event.currentTarget.ownerSVGElement.getScreenCTM();
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(screen.inverse());
    setStem(-point.y / MM);
  };
  const key = (event) => {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!direction) return;
    setStem(top.stem + direction * step);
    event.preventDefault();
  };
  return (
    <circle
      class="grip"
      cx="0"
      cy={-MM * top.stem}
      r={Math.max(MM * top.knob, 5)}
      tabindex="0"
      role="slider"
      aria-label={t("own.stem")}
      aria-valuemin={shortest * MM}
      aria-valuemax={longest * MM}
      aria-valuenow={Math.round(top.stem * MM)}
      aria-valuetext={`${digits(top.stem * MM, 3)} mm`}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={drag}
      onKeyDown={key}
    />
  );
}
