// The form to push a top or to lift its table while it spins, at the moment that the picture shows, and the pushes that
// a launch has.

import { useEffect, useState } from "preact/hooks";

import { frictionKind, MAIN, placeOf, TABLE, valueAt } from "./dials.js";
import { part, t } from "./i18n.js";
import { DIRECTIONS, MOST_PUSHES, momentOf, sortedPushes, strongest } from "./pushes.js";
import { NamedSlider } from "./slider.jsx";
import { digits, shown } from "./units.js";

const FRICTION = MAIN.find(({ field }) => field === "friction.mu");
const SLOPE = TABLE.find(({ field }) => field === "table.slope");
const MILLI = 1e-3;
// Steps of the slider of the strength, and the one where it is at first.
const STEPS = 50;
const FIRST_STEP = 10;

export function Push({ lab }) {
  const { setup, units } = lab.state;
  const { problem, pushes = [] } = setup;
  const [strength, strengthen] = useState(null);
  const [direction, turn] = useState("down");
  const [friction, slip] = useState(null);
  const [slope, lift] = useState(null);
  const time = useMoment(lab);
  const isFree = (problem.contact?.liftoff ?? "fly") === "fly";
  const most = strongest(problem.body.mass);
  const present = tableAt(setup, time);
  const mu = friction === present.mu ? null : friction;
  const lifted = slope === present.slope ? null : slope;
  // Who changes the table alone does not push the top.
  const step = strength ?? (mu === null && lifted === null ? FIRST_STEP : 0);
  const impulse = isFree ? Number(((step / STEPS) * most).toPrecision(3)) : 0;
  const isEmpty = impulse === 0 && mu === null && lifted === null;
  const why = lab.track && whyNot(time < lab.track.header.asked, pushes.length, isEmpty);
  const push = () => {
    const at = momentOf(lab.player.time);
    const now = { time: at, impulse, direction: DIRECTIONS[direction], mu, slope: lifted };
    lab.push(sortedPushes([...pushes, now]));
    slip(null);
    lift(null);
  };
  return (
    <details class="push" open={pushes.length > 0 || undefined}>
      <summary>{t("push.title")}</summary>
      <p class="hint">{t("push.intro")}</p>
      {isFree ? (
        <>
          <NamedSlider
            name={t("push.strength")}
            text={`${digits(impulse / MILLI, 3)} mN s`}
            range={[0, STEPS, 1]}
            value={step}
            onChange={strengthen}
          />
          <label class="choice">
            <span>{t("push.direction")}</span>
            <select value={direction} onChange={(event) => turn(event.target.value)}>
              {Object.keys(DIRECTIONS).map((name) => (
                <option value={name}>{t(`push.directions.${name}`)}</option>
              ))}
            </select>
          </label>
        </>
      ) : (
        <p class="hint">{t("push.held")}</p>
      )}
      <NamedSlider
        name={t("push.friction")}
        text={frictionText(friction ?? present.mu, problem)}
        range={rangeOf(FRICTION)}
        value={placeOf(FRICTION, friction ?? present.mu)}
        onChange={(place) => slip(valueAt(FRICTION, place))}
      />
      <NamedSlider
        name={t("push.slope")}
        text={shown(slope ?? present.slope, "angle", units)}
        range={rangeOf(SLOPE)}
        value={slope ?? present.slope}
        onChange={lift}
      />
      <div class="row">
        <button type="button" class="strong" disabled={why !== null} onClick={push}>
          {t("push.now", { time: digits(time, 3) })}
        </button>
      </div>
      {why && <p class="hint">{t(`push.why.${why}`, { most: MOST_PUSHES })}</p>}
      <Pushes lab={lab} pushes={pushes} />
    </details>
  );
}

// Why nothing can be done at a moment; null if it can.
function whyNot(isBeforeEnd, count, isEmpty) {
  if (!isBeforeEnd) return "end";
  if (count >= MOST_PUSHES) return "many";
  return isEmpty ? "nothing" : null;
}

const rangeOf = (dial) => [placeOf(dial, dial.low), placeOf(dial, dial.high), dial.step];

// The time that the picture shows, rounded as a push takes it, s.
function useMoment(lab) {
  const [time, tell] = useState(0);
  useEffect(() => {
    const look = () => tell(momentOf(lab.player.time));
    lab.addEventListener("time", look);
    look();
    return () => lab.removeEventListener("time", look);
  }, []);
  return time;
}

function Pushes({ lab, pushes }) {
  const { setup, units } = lab.state;
  const reached = lab.track?.header.reached ?? pushes.length;
  const remove = (push) => lab.push(pushes.filter((one) => one !== push));
  return (
    pushes.length > 0 && (
      <ul class="pushes" aria-label={t("push.list")}>
        {pushes.map((push, k) => (
          <li>
            <span>
              {pushText(push, setup.problem, units)}
              {k >= reached && ` (${t("push.missed")})`}
            </span>
            <button type="button" onClick={() => remove(push)}>
              {t("push.remove")}
            </button>
          </li>
        ))}
      </ul>
    )
  );
}

/** A push in words. */
export function pushText({ time, impulse, direction, mu, slope }, problem, units) {
  const name = Object.keys(DIRECTIONS).find((one) => DIRECTIONS[one] === direction);
  const where = name ? t(`push.directions.${name}`) : `${digits((direction * 180) / Math.PI, 3)}°`;
  const parts = [];
  if (impulse) parts.push(`${digits(impulse / MILLI, 3)} mN s, ${where}`);
  if (mu !== null)
    parts.push(`${part("quantities.friction.mu").symbol} = ${frictionText(mu, problem)}`);
  if (slope !== null)
    parts.push(`${part("quantities.table.slope").symbol} = ${shown(slope, "angle", units)}`);
  return `${digits(time, 4)} s: ${parts.join("; ") || "–"}`;
}

const frictionText = (mu, problem) => `${digits(mu, 3)} ${frictionKind({ problem })}`.trim();

// The friction coefficient and the slope of the table, rad, at a time of a launch.
function tableAt({ problem, pushes = [] }, time) {
  const table = { mu: problem.friction.mu, slope: problem.table?.slope ?? 0 };
  for (const push of pushes.filter((one) => one.time <= time))
    for (const name of Object.keys(table)) table[name] = push[name] ?? table[name];
  return table;
}
