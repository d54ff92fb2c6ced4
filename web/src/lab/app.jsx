// The page: scene and plots beside a panel of things to do.

import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

import { Flick } from "../player/flick.js";
import { createPlayer } from "../player/player.js";
import { Classroom } from "./classroom.jsx";
import { Compare } from "./compare.jsx";
import { Launch } from "./controls.jsx";
import { Copy } from "./copy.jsx";
import { Free } from "./free.jsx";
import { Help } from "./help.jsx";
import { LANGUAGES, part, t } from "./i18n.js";
import { Keep } from "./keep.jsx";
import { MapPanel, MapUnderWay } from "./map.jsx";
import { Own } from "./own.jsx";
import { Plots, USUAL } from "./plots.js";
import { Speaker } from "./speaker.jsx";
import { Story, veilOf } from "./story.jsx";
import { QUANTITIES } from "./units.js";
import { factsAt } from "./words.js";

const PANELS = {
  story: Story,
  launch: Launch,
  own: Own,
  compare: Compare,
  map: MapPanel,
  class: Classroom,
  keep: Keep,
};

export function App({ lab }) {
  const [, redraw] = useState(0);
  const [help, turn] = useState(false);
  useLayoutEffect(() => {
    const call = () => redraw((count) => count + 1);
    lab.addEventListener("state", call);
    return () => lab.removeEventListener("state", call);
  }, []);
  const { tab, trouble, theme } = lab.state;
  const language = document.documentElement.lang;
  useEffect(() => {
    document.title = t("page.title");
    document.documentElement.dataset.theme = isDark(theme) ? "dark" : "light";
  });
  const veil = veilOf(lab.state);
  useEffect(() => lab.player?.lock(veil === "veiled"), [veil, language]);
  const Panel = PANELS[tab];
  return (
    <>
      {/* biome-ignore lint/a11y/useValidAnchor: a link, but one that leaves the address as it is */}
      <a
        class="skip"
        href="#panel"
        onClick={(event) => {
          event.preventDefault();
          document.getElementById("panel").focus();
        }}
      >
        {t("page.skip")}
      </a>
      <Header lab={lab} onHelp={() => turn(true)} />
      <main class={veil}>
        <section class="stage" aria-label={t("page.stage")}>
          <Stage lab={lab} key={language} dark={isDark(theme)} />
          <Speaker lab={lab} />
        </section>
        <section class="panel" aria-label={t("page.panel")} id="panel" tabIndex={-1}>
          <Tabs lab={lab} />
          <div class="panel-body" role="tabpanel" aria-labelledby={`tab-${tab}`} tabIndex={0}>
            <Busy lab={lab} />
            <MapUnderWay lab={lab} />
            {trouble && (!trouble.field || tab !== "launch") && (
              <p class="refused" role="alert">
                {trouble.sentence}
              </p>
            )}
            {tab !== "story" && <h2 class="hidden">{t(`page.${tab}`)}</h2>}
            <Panel lab={lab} key={tab} />
          </div>
        </section>
        <PlotSection lab={lab} dark={isDark(theme)} />
      </main>
      {help && <Help lab={lab} onClose={() => turn(false)} />}
    </>
  );
}

export function isDark(theme) {
  return theme === "auto" ? matchMedia("(prefers-color-scheme: dark)").matches : theme === "dark";
}

function Header({ lab, onHelp }) {
  const { theme } = lab.state;
  return (
    <header>
      <h1>{t("page.title")}</h1>
      <span class="space" />
      <button type="button" disabled={!lab.changed} onClick={() => lab.undo()} title="Ctrl+Z">
        {t("page.undo")}
      </button>
      <Copy name={t("page.link")} text={() => lab.link()} done={t("page.linked")} />
      <button type="button" onClick={onHelp} aria-haspopup="dialog">
        {t("page.help")}
      </button>
      <button
        type="button"
        class="square"
        aria-label={t("page.theme")}
        title={t("page.theme")}
        onClick={() => lab.set({ theme: isDark(theme) ? "light" : "dark" })}
      >
        ◐
      </button>
      <select
        aria-label={t("page.language")}
        value={document.documentElement.lang}
        onChange={(event) => lab.set({ lang: event.target.value })}
      >
        {Object.entries(LANGUAGES).map(([key, { name }]) => (
          <option value={key} lang={key}>
            {name}
          </option>
        ))}
      </select>
    </header>
  );
}

function Stage({ lab, dark }) {
  const host = useRef();
  // The lab has a player at every moment: the one of a new language is there before anything else is done.
  useLayoutEffect(() => {
    const before = lab.player;
    const player = createPlayer(host.current, {
      theme: dark ? "dark" : "light",
      words: part("player"),
      open: innerWidth > 1700,
      facts: (track, time) => factsAt(track, time, lab.state.units),
    });
    lab.player = player;
    if (before) player.adopt(before);
    if (player.scene) new Flick(player.canvas, player.scene, (spin, tilt) => lab.flick(spin, tilt));
    player.addEventListener("time", () => lab.dispatchEvent(new Event("time")));
    player.addEventListener("view", () => lab.share());
    if (before && lab.track) {
      lab.show(lab.track, false, false);
      lab.raise();
    } else {
      lab.request(!lab.state.timed && lab.state.tab !== "story");
      lab.raise();
    }
    if (!lab.track) lab.pending = lab.state;
    const stage = host.current.parentElement;
    const tell = () =>
      document.documentElement.style.setProperty("--stage", `${stage.offsetHeight}px`);
    const resizing = new ResizeObserver(tell);
    resizing.observe(stage);
    return () => {
      resizing.disconnect();
      player.dispose();
    };
  }, []);
  useEffect(() => lab.player?.setTheme(dark ? "dark" : "light"), [dark]);
  return <div class="player" ref={host} />;
}

function Tabs({ lab }) {
  const names = Object.keys(PANELS);
  const go = (name) => lab.set({ tab: name });
  const key = (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = names[(names.indexOf(lab.state.tab) + step + names.length) % names.length];
    go(next);
    document.getElementById(`tab-${next}`).focus();
    event.preventDefault();
  };
  return (
    <div class="tabs" role="tablist" onKeyDown={key}>
      {names.map((name) => (
        <button
          type="button"
          role="tab"
          id={`tab-${name}`}
          aria-selected={lab.state.tab === name}
          tabIndex={lab.state.tab === name ? 0 : -1}
          onClick={() => go(name)}
        >
          {t(`page.${name}`)}
        </button>
      ))}
    </div>
  );
}

function Busy({ lab }) {
  const { busy } = lab.state;
  if (busy === null) return null;
  return (
    <div class="busy">
      <label>
        {t("page.computing")} <progress max="1" value={busy || undefined} />
      </label>
      <button type="button" onClick={() => lab.stop()}>
        {t("page.stop")}
      </button>
    </div>
  );
}

function PlotSection({ lab, dark }) {
  const host = useRef();
  const { units } = lab.state;
  const names = (lab.state.plots ?? USUAL).filter((name) => name in QUANTITIES);
  useEffect(() => {
    lab.plots = new Plots(host.current, {
      seek: (time) => {
        lab.player.toggle(false);
        lab.player.seek(time);
      },
      time: () => lab.player?.time ?? 0,
      playing: () => lab.player?.playing ?? false,
      isTold: () => !veilOf(lab.state),
    });
    lab.addEventListener("time", () => lab.plots.move());
  }, []);
  useEffect(() => {
    lab.drawPlots = (isDarkNow) =>
      lab.track && lab.plots.load(lab.track, lab.pinned(), names, units, isDarkNow);
    const fill = () => lab.drawPlots(dark);
    fill();
    lab.say();
    lab.addEventListener("run", fill);
    return () => lab.removeEventListener("run", fill);
  }, [names.join(), units, dark, document.documentElement.lang, veilOf(lab.state)]);
  return (
    <section class="plots" aria-label={t("plots.title")}>
      <PlotsBar lab={lab} names={names} />
      <p class="veil">{t("plots.veiled")}</p>
      <div class="plots-host" ref={host} />
      <Free lab={lab} />
    </section>
  );
}

// What is above the plots: how long a time they show, and which there are.
function PlotsBar({ lab, names }) {
  const zooms = { in: 0.5, out: 2, all: null };
  const choose = (name, on) => {
    const isShown = (one) => (one === name ? on : names.includes(one));
    lab.set({ plots: Object.keys(QUANTITIES).filter(isShown) });
  };
  return (
    <div class="plots-bar">
      <h2>{t("plots.title")}</h2>
      <span class="hint">
        {t("plots.hint")} {lab.track?.header.flights.length ? t("plots.flights") : ""}
      </span>
      {Object.entries(zooms).map(([name, factor]) => (
        <button type="button" onClick={() => lab.plots.zoom(factor)}>
          {t(`plots.${name}`)}
        </button>
      ))}
      <details class="curves">
        <summary>{t("plots.choose")}</summary>
        <div>
          {Object.keys(QUANTITIES).map((name) => (
            <label>
              <input
                type="checkbox"
                checked={names.includes(name)}
                onChange={(event) => choose(name, event.target.checked)}
              />{" "}
              {t(`quantities.${name}.name`)}
            </label>
          ))}
        </div>
      </details>
    </div>
  );
}
