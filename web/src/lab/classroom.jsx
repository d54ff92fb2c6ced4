// A class together: a launch per group as a code to scan, and what became of them in one plot.

import { useMemo } from "preact/hooks";
import { encode } from "uqr";

import { Copy } from "./copy.jsx";
import { decimal, t } from "./i18n.js";
import { FIRST_CLASS, launchQuery } from "./link.js";
import { readResults, resultCode, resultLink, spinsOf } from "./results.js";
import { changed } from "./setup.js";
import { digits, roundStep, shown, unitOf } from "./units.js";

const MOST_GROUPS = 30;
// The plot: its size, the room for its numbers, its highest spin if none is higher, rad/s, and its numbers across.
const [WIDTH, HEIGHT] = [340, 220];
const ROOM = { left: 40, right: 10, top: 10, bottom: 36 };
const HIGHEST = 250;
const TICKS = 5;

export function Classroom({ lab }) {
  const state = lab.state.classroom ?? FIRST_CLASS;
  const { units, setup } = lab.state;
  const set = (changes) => lab.set({ classroom: { ...state, ...changes } });
  const isFile = location.protocol === "file:";
  return (
    <div class="classroom">
      <p>{t("class.intro")}</p>
      <Mine lab={lab} />
      <label class="choice">
        <span>{t("class.paste")}</span>
        <textarea
          rows={6}
          placeholder={["155 179.9", "50 86.1"].map(written).join("\n")}
          value={state.results}
          onInput={(event) => set({ results: event.target.value })}
        />
      </label>
      <Results text={state.results} setup={setup} units={units} />
      <div class="row">
        <Count name="groups" value={state.groups} least={2} most={MOST_GROUPS} set={set} />
        <Count name="low" value={state.low} most={HIGHEST} set={set} unit={unitOf("spin", units)} />
        <Count
          name="high"
          value={state.high}
          most={HIGHEST}
          set={set}
          unit={unitOf("spin", units)}
        />
      </div>
      {isFile && (
        <p class="refused" role="note">
          {t("class.file")}
        </p>
      )}
      <Codes lab={lab} state={state} />
    </div>
  );
}

// A result code with the language's decimal sign.
const written = (code) => code.split(" ").map(decimal).join(" ");

function Count({ name, value, least = 0, most, set, unit = { name: "", size: 1 } }) {
  const change = ({ target }) => {
    const entered = Number(target.value) * unit.size || least;
    const inside = Math.min(Math.max(entered, least), most);
    target.value = inUnits(inside);
    set({ [name]: inside });
  };
  const inUnits = (number) => Number((number / unit.size).toPrecision(4));
  return (
    <label class="choice">
      <span>{t(`class.${name}`, { unit: unit.name })}</span>
      <input
        type="number"
        class="dial-number"
        step="any"
        value={inUnits(value)}
        onChange={change}
      />
    </label>
  );
}

// The addresses of the groups' launches: that which is set, each with another spin.
function addressesOf({ setup }, { groups, low, high }) {
  return spinsOf(groups, low, high).map((spin) => {
    const query = launchQuery(changed(setup, { "launch.spin": spin }));
    query.set("launch.spin", spin);
    query.set("tab", "class");
    return { spin, address: `${placeOfPage()}#${query}` };
  });
}

const placeOfPage = () => location.href.replace(/[#?].*$/, "");

// A code to scan for each group, and the same as links to send.
function Codes({ lab, state }) {
  const { units } = lab.state;
  const groups = addressesOf(lab.state, state);
  return (
    <>
      <ol class="codes">
        {groups.map(({ spin, address }) => (
          <li>
            <a href={address}>
              <Code text={address} />
              <span>{shown(spin, "spin", units)}</span>
            </a>
          </li>
        ))}
      </ol>
      <details>
        <summary>{t("class.links")}</summary>
        <textarea
          class="links"
          rows={6}
          readOnly
          aria-label={t("class.links")}
          value={groups.map(({ address }) => address).join("\n")}
          onFocus={({ target }) => target.select()}
        />
      </details>
    </>
  );
}

function Code({ text }) {
  const { size, data } = useMemo(() => encode(text, { ecc: "L", border: 2 }), [text]);
  const squares = data.flatMap((row, y) => row.flatMap((isDark, x) => (isDark ? [[x, y]] : [])));
  return (
    <svg viewBox={`0 0 ${size} ${size}`} role="img" aria-label={t("class.code")} class="code">
      <rect width={size} height={size} fill="#fff" />
      <path d={squares.map(([x, y]) => `M${x} ${y}h1v1h-1z`).join("")} fill="#000" />
    </svg>
  );
}

// What a group takes to the teacher: spin and final tilt of the run that is shown, as a code or in a link to it.
function Mine({ lab }) {
  if (!lab.track || lab.isAwaited) return null;
  const { header } = lab.track;
  const code = written(resultCode(header));
  const link = () => resultLink(placeOfPage(), launchQuery(lab.state.setup), header);
  return (
    <div class="row">
      <span role="status">
        {t("class.mine")} <b class="mine">{code}</b>
      </span>
      <Copy name={t("class.copyCode")} text={() => code} />
      <Copy name={t("class.copyLink")} text={link} />
    </div>
  );
}

function Results({ text, setup, units }) {
  const { points, wrong, others } = readResults(text, setup);
  const read = points.length;
  const all = read + wrong.length + others.length;
  return (
    <>
      {all > 0 && (
        <p class="hint" role="status">
          {t("class.read", { read, all })}
        </p>
      )}
      {wrong.length > 0 && (
        <p class="refused" role="alert">
          {t("class.wrong", { lines: wrong.join(", ") })}
        </p>
      )}
      {others.length > 0 && (
        <p class="refused" role="alert">
          {t("class.others", { lines: others.join(", ") })}
        </p>
      )}
      <Scatter points={points} units={units} />
    </>
  );
}

function Scatter({ points, units }) {
  const width = WIDTH - ROOM.left - ROOM.right;
  const height = HEIGHT - ROOM.top - ROOM.bottom;
  const unit = unitOf("spin", units);
  const most = Math.max(HIGHEST, ...points.map(([spin]) => spin));
  const least = Math.min(0, ...points.map(([spin]) => spin));
  const step = roundStep((most - least) / TICKS / unit.size);
  const x = (spin) => ROOM.left + (width * (spin - least)) / (most - least);
  const first = Math.ceil(least / unit.size / step);
  const count = Math.floor(most / unit.size / step) - first + 1;
  const ticks = Array.from({ length: count }, (_, k) => (first + k) * step);
  const y = (tilt) => ROOM.top + height * (1 - tilt / 180);
  const words = points
    .map(([spin, tilt]) => `${shown(spin, "spin", units)}: ${digits(tilt)}°`)
    .join("; ");
  return (
    <svg
      class="scatter"
      viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
      role="img"
      aria-label={`${t("class.plot")} ${words}`}
    >
      {[0, 45, 90, 135, 180].map((tilt) => (
        <>
          <line x1={ROOM.left} x2={WIDTH - ROOM.right} y1={y(tilt)} y2={y(tilt)} class="grid" />
          <text x={ROOM.left - 5} y={y(tilt) + 4} text-anchor="end">
            {tilt}
          </text>
        </>
      ))}
      {ticks.map((tick) => (
        <text x={x(tick * unit.size)} y={HEIGHT - 20} text-anchor="middle">
          {digits(tick)}
        </text>
      ))}
      <text x={ROOM.left + width / 2} y={HEIGHT - 4} text-anchor="middle">
        {t("class.across", { unit: unit.name })}
      </text>
      <text transform={`translate(11 ${ROOM.top + height / 2}) rotate(-90)`} text-anchor="middle">
        {t("class.up")}
      </text>
      {points.map(([spin, tilt]) => (
        <circle cx={x(spin)} cy={y(tilt)} r="4.5" class="dot" />
      ))}
    </svg>
  );
}
