// One's own top: its shape with a stem to drag, what it weighs, what it will do.

import { useEffect, useState } from "preact/hooks";

import { t } from "./i18n.js";
import { changed } from "./setup.js";
import { FIRST, MATERIALS, bodyOf, massesOf, possible, sectionOf } from "./turning.js";
import { digits, shown } from "./units.js";

const DIALS = {
  radius: [0.008, 0.04, 0.0005],
  face: [0.2, 0.9, 0.01],
  hollow: [0, 0.95, 0.01],
  stem: [0.02, 0.07, 0.0005],
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
  const { mass, alpha, ratio } = massesOf(top);
  const body = bodyOf(top);
  const ahead = useProspects(lab, body);
  return (
    <div class="own">
      <p>{t("own.intro")}</p>
      <Section top={top} onDrag={(stem) => set({ stem })} />
      {Object.entries(DIALS).map(([name, [low, high, step]]) => (
        <label class="own-dial">
          <span>
            {t(`own.${name}`)}{" "}
            <b>
              {IN_MM.includes(name) ? `${digits(top[name] * 1e3, 3)} mm` : digits(top[name], 2)}
            </b>
          </span>
          <input
            type="range"
            min={low}
            max={high}
            step={step}
            value={top[name]}
            data-own={name}
            onInput={(event) => set({ [name]: Number(event.target.value) })}
          />
        </label>
      ))}
      <label class="choice">
        <span>{t("own.material")}</span>
        <select value={top.material} onChange={(event) => set({ material: event.target.value })}>
          {Object.keys(MATERIALS).map((name) => (
            <option value={name}>{t(`own.${name}`)}</option>
          ))}
        </select>
      </label>
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
      <button
        type="button"
        class="strong"
        disabled={alpha <= 0}
        onClick={() =>
          lab.go(
            changed(lab.state.setup, {
              body,
              rolling_resistance: 0,
              "contact.liftoff": "fly",
              duration: 10,
            }),
          )
        }
      >
        {t("own.spin")}
      </button>
    </div>
  );
}

// What a worker says of a body: nothing yet while it thinks, null of one that does not stand on its ball.
function useProspects(lab, body) {
  const [ahead, say] = useState(undefined);
  const { problem } = lab.state.setup;
  useEffect(() => {
    let wanted = true;
    lab.engine.prospects(body, problem).then(
      (found) => wanted && say(found),
      () => {},
    );
    return () => {
      wanted = false;
    };
  }, [JSON.stringify(body), problem.gravity, problem.launch.tilt]);
  return ahead;
}

function sentence(ahead, units) {
  if (ahead === undefined) return "";
  if (ahead === null) return t("own.high");
  const {
    critical_spins: { upright },
    touch,
    stem,
  } = ahead;
  const told = (spin) => shown(spin, "spin", units, 3);
  if (ahead.group.startsWith("I") && !ahead.group.startsWith("II")) return t("own.never");
  if (!Number.isFinite(touch?.spin)) return t("own.half", { spin: told(upright) });
  if (!Number.isFinite(stem?.launch))
    return t("own.leans", { spin: told(upright), touch: told(touch.spin) });
  return t("own.can", { spin: told(upright), touch: told(touch.spin), stand: told(stem.launch) });
}

function Section({ top, onDrag }) {
  const { outer, hollow } = sectionOf(top);
  const [up, down] = [Math.max(top.stem + top.knob, 2.2 * top.radius) + 0.003, top.radius + 0.003];
  const scale = 1000;
  const both = (points) => [...points, ...[...points].reverse().map(([r, z]) => [-r, z])];
  const path = (points) =>
    points.map(([r, z]) => `${(scale * r).toFixed(2)},${(-scale * z).toFixed(2)}`).join(" ");
  const drag = (event) => {
    if (!event.buttons) return;
    const svg = event.currentTarget.ownerSVGElement;
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(
      svg.getScreenCTM().inverse(),
    );
    onDrag(Math.min(Math.max(-at.y / scale, DIALS.stem[0]), DIALS.stem[1]));
  };
  const key = (event) => {
    const step = { ArrowUp: 0.0005, ArrowDown: -0.0005 }[event.key];
    if (!step) return;
    onDrag(Math.min(Math.max(top.stem + step, DIALS.stem[0]), DIALS.stem[1]));
    event.preventDefault();
  };
  return (
    <svg
      class="section"
      viewBox={`-60 ${-scale * up} 120 ${scale * (up + down)}`}
      role="group"
      aria-label={t("own.drawing")}
    >
      <line x1="-60" x2="60" y1={scale * top.radius} y2={scale * top.radius} class="ink" />
      <polygon points={path(both(outer))} class="wood" />
      <polygon points={path(hollow)} class="empty" />
      <polygon points={path(hollow.map(([r, z]) => [-r, z]))} class="empty" />
      <circle cx="0" cy="0" r="0.8" class="dot" />
      <circle cx="0" cy={scale * massesOf(top).alpha * top.radius} r="1.6" class="mass" />
      <circle
        class="grip"
        cx="0"
        cy={-scale * top.stem}
        r={Math.max(scale * top.knob, 5)}
        tabIndex={0}
        role="slider"
        aria-label={t("own.stem")}
        aria-valuemin={DIALS.stem[0] * 1e3}
        aria-valuemax={DIALS.stem[1] * 1e3}
        aria-valuenow={Math.round(top.stem * 1e3)}
        aria-valuetext={`${digits(top.stem * 1e3, 3)} mm`}
        onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
        onPointerMove={drag}
        onKeyDown={key}
      />
    </svg>
  );
}
