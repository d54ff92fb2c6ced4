// A class together: a launch per group as a code to scan, and what became of them in one plot.

import { useMemo } from "preact/hooks";
import { encode } from "uqr";

import { t } from "./i18n.js";
import { launchQuery } from "./link.js";
import { readResults, resultCode, resultLink, spinsOf } from "./results.js";
import { changed } from "./setup.js";
import { digits, shown } from "./units.js";

const MOST_GROUPS = 30;
const FIRST = { groups: 8, low: 10, high: 150, results: "" };
// The plot: its size, the room for its numbers, and its highest spin, rad/s.
const [WIDTH, HEIGHT] = [340, 220];
const ROOM = { left: 40, right: 10, top: 10, bottom: 36 };
const HIGHEST = 250;

export function Classroom({ lab }) {
  const state = lab.state.classroom ?? FIRST;
  const set = (changes) => lab.set({ classroom: { ...state, ...changes } });
  const isFile = location.protocol === "file:";
  return (
    <div class="classroom">
      <p>{t("class.intro")}</p>
      <div class="row">
        <Count name="groups" value={state.groups} least={2} most={MOST_GROUPS} set={set} />
        <Count name="low" value={state.low} least={0} most={HIGHEST} set={set} />
        <Count name="high" value={state.high} least={0} most={HIGHEST} set={set} />
      </div>
      {isFile && (
        <p class="refused" role="note">
          {t("class.file")}
        </p>
      )}
      <Codes lab={lab} state={state} />
      <Mine lab={lab} />
      <label class="choice">
        <span>{t("class.paste")}</span>
        <textarea
          rows={6}
          placeholder={"155 179.9\n50 86.1"}
          value={state.results}
          onInput={(event) => set({ results: event.target.value })}
        />
      </label>
      <Results text={state.results} />
    </div>
  );
}

function Count({ name, value, least, most, set }) {
  return (
    <label class="choice">
      <span>{t(`class.${name}`)}</span>
      <input
        type="number"
        class="dial-number"
        min={least}
        max={most}
        value={value}
        onChange={({ target }) =>
          set({ [name]: Math.min(Math.max(Number(target.value) || least, least), most) })
        }
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
  const code = resultCode(header);
  const copy = (text) => navigator.clipboard?.writeText(text);
  const link = () => resultLink(placeOfPage(), launchQuery(lab.state.setup), header);
  return (
    <p class="row" role="status">
      <span>
        {t("class.mine")} <b class="mine">{code}</b>
      </span>
      <button type="button" onClick={() => copy(code)}>
        {t("class.copyCode")}
      </button>
      <button type="button" onClick={() => copy(link())}>
        {t("class.copyLink")}
      </button>
    </p>
  );
}

function Results({ text }) {
  const { points, wrong } = readResults(text);
  return (
    <>
      {wrong.length > 0 && (
        <p class="refused" role="alert">
          {t("class.wrong", { lines: wrong.join(", ") })}
        </p>
      )}
      <Scatter points={points} />
    </>
  );
}

function Scatter({ points }) {
  const width = WIDTH - ROOM.left - ROOM.right;
  const height = HEIGHT - ROOM.top - ROOM.bottom;
  const most = Math.max(HIGHEST, ...points.map(([spin]) => spin));
  const x = (spin) => ROOM.left + (width * spin) / most;
  const y = (tilt) => ROOM.top + height * (1 - tilt / 180);
  const words = points.map(([spin, tilt]) => `${digits(spin)}: ${digits(tilt)}°`).join("; ");
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
      {[0, 50, 100, 150, 200, 250].map((spin) => (
        <text x={x(spin)} y={HEIGHT - 20} text-anchor="middle">
          {spin}
        </text>
      ))}
      <text x={ROOM.left + width / 2} y={HEIGHT - 4} text-anchor="middle">
        {t("class.across")}
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
