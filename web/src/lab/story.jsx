// The guided story: each step sets a launch, asks for a prediction, shows what happens and says why.

import { useEffect, useRef } from "preact/hooks";

import { SPAN } from "../player/climax.js";
import { stillness } from "../player/player.js";
import { ARROWS, SHOWN } from "../player/scene.js";
import { part, t } from "./i18n.js";
import { showStage, showUnderStage } from "./lab.js";
import { PRESETS, preset } from "./presets.js";
import { STEPS } from "./steps.js";
import { TorquePicture } from "./torque.jsx";

// How long nothing in particular is watched before the answer is told, and the most of anything, s.
const WATCHED = 4;
const LONGEST_WATCHED = 8;

// When what a step asks for is to be seen in a run, s; NaN where it does not happen.
const MOMENTS = {
  flip: ({ turnover_time }) => (turnover_time ?? NaN) + SPAN,
  arrival: ({ metrics: { arrival_time } }) => arrival_time ?? NaN,
};

export function Story({ lab }) {
  const { step, guess } = lab.state;
  const number = Math.min(step, STEPS.length - 1);
  const words = part("story.steps")[number];
  const isGuessed = guess?.step === number;
  const isSeen = isGuessed && guess.seen;
  const tellNow = () => lab.set({ guess: { ...lab.state.guess, seen: true } });
  useEffect(() => {
    if (!isGuessed || isSeen) return undefined;
    const look = () => {
      const { player, track } = lab;
      if (lab.isAwaited || !(player.time >= momentIn(number, track))) return;
      tellNow();
    };
    lab.addEventListener("time", look);
    return () => lab.removeEventListener("time", look);
  }, [isGuessed, isSeen, number]);
  const top = useRef();
  const last = useRef(number);
  useEffect(() => {
    if (last.current !== number) showUnderStage(top.current);
    last.current = number;
  }, [number]);
  const go = (next) => {
    setStep(lab, next, { step: next, guess: null });
  };
  return (
    <article class="story">
      <div class="step" ref={top}>
        <p>{t("story.step", { step: number + 1, all: STEPS.length })}</p>
        <progress
          max={STEPS.length}
          value={number + 1}
          aria-label={t("story.step", { step: number + 1, all: STEPS.length })}
        />
      </div>
      <h2>{words.title}</h2>
      <p>{words.text}</p>
      <Question
        key={number}
        words={words}
        guess={isGuessed ? guess : null}
        onGuess={(answer) => spin(lab, number, answer)}
      />
      {isGuessed && !isSeen && <Watching onTell={tellNow} />}
      {isSeen && <Why lab={lab} number={number} words={words} guess={guess} />}
      <nav class="story-nav" aria-label={t("page.story")}>
        <button type="button" disabled={number === 0} onClick={() => go(number - 1)}>
          {t("story.before")}
        </button>
        <button
          type="button"
          class="strong"
          disabled={number === STEPS.length - 1}
          onClick={() => go(number + 1)}
        >
          {t("story.next")}
        </button>
      </nav>
    </article>
  );
}

// When the answer of a step is told, s.
function momentIn(number, track) {
  const { watch } = STEPS[number];
  const moment = MOMENTS[watch]?.(track.header) ?? watch;
  const time = Number.isFinite(moment) ? Math.min(moment, LONGEST_WATCHED) : WATCHED;
  return stillness() ? 0 : Math.min(time, track.duration);
}

// An element that takes the focus when it appears.
function useFocus() {
  const element = useRef();
  useEffect(() => element.current.focus(), []);
  return element;
}

// What is there while the visitor watches, and no answer has been told.
function Watching({ onTell }) {
  const element = useFocus();
  return (
    <div
      class="watching row"
      ref={element}
      tabIndex={-1}
      role="group"
      aria-label={t("story.watch")}
    >
      <p>{t("story.watch")}</p>
      <button type="button" onClick={onTell}>
        {t("story.tell")}
      </button>
    </div>
  );
}

// The question and one's own guess again: on a small screen the form is out of sight by now.
function Asked({ words, guess }) {
  return (
    <p class="asked">
      {words.question}{" "}
      {guess.answer !== null && t("story.guessed", { answer: words.answers[guess.answer] })}
    </p>
  );
}

function Question({ words, guess, onGuess }) {
  const answer = (event) => {
    event.preventDefault();
    const chosen = new FormData(event.target).get("guess");
    if (chosen !== null) onGuess(Number(chosen));
  };
  return (
    <form class="question" onSubmit={answer}>
      <fieldset disabled={Boolean(guess)}>
        <legend>{words.question}</legend>
        {words.answers.map((text, k) => (
          <label
            class={[guess?.seen && k === words.right && "right", guess?.answer === k && "chosen"]
              .filter(Boolean)
              .join(" ")}
          >
            <input
              type="radio"
              name="guess"
              value={k}
              required
              checked={guess?.answer === k || undefined}
            />{" "}
            {text}
            {guess?.answer === k && <span class="yours">{t("story.yours")}</span>}
          </label>
        ))}
      </fieldset>
      {!guess && (
        <div class="row">
          <button type="submit" class="strong">
            {t("story.go")}
          </button>
          <button type="button" onClick={() => onGuess(null)}>
            {t("story.skip")}
          </button>
        </div>
      )}
    </form>
  );
}

function Why({ lab, number, words, guess }) {
  const { extra, from, picture, arrows } = STEPS[number];
  const { figure } = PRESETS.find(({ key }) => key === from) ?? {};
  const element = useFocus();
  return (
    <div class="answer" ref={element} tabIndex={-1} role="status">
      <Asked words={words} guess={guess} />
      {guess.answer !== null && (
        <p class={`verdict ${guess.answer === words.right ? "right" : ""}`}>
          {t(guess.answer === words.right ? "story.right" : "story.wrong")}
        </p>
      )}
      <p>{words.why}</p>
      {arrows && <Arrows lab={lab} names={arrows} />}
      {picture && <TorquePicture />}
      <details>
        <summary>{t("story.deeper")}</summary>
        <p class="deeper">{words.deeper}</p>
      </details>
      {figure && (
        <p>
          <a href={figure} rel="noreferrer">
            {t("presets.figure")}
          </a>
        </p>
      )}
      {extra && (
        <button type="button" onClick={() => showExtra(lab, extra)}>
          {t(`story.extra.${extra}`)}
        </button>
      )}
    </div>
  );
}

// What an answer speaks of, as arrows on the turning top, in their colours.
function Arrows({ lab, names }) {
  const watch = () => {
    for (const name of names) lab.player.show({ [name]: true });
    lab.player.flip();
    showStage();
  };
  return (
    <p class="row">
      <button type="button" onClick={watch}>
        {t("story.arrows")}
      </button>
      {names.map((name) => (
        <span class="arrow">
          <i style={`background:${ARROWS[name]}`} /> {part(`player.${name}`)}
        </span>
      ))}
    </p>
  );
}

function showExtra(lab, extra) {
  if (extra === "own") lab.set({ tab: "own" });
  else lab.go(preset(extra));
}

// Put a step's launch on the table, seen as it is best seen.
function setStep(lab, number, others, play = false) {
  const { setup, show, plots, distance } = STEPS[number];
  const { player } = lab;
  for (const name of SHOWN) player.show({ [name]: show.includes(name) });
  player.look("orbit");
  if (distance) player.scene?.eye.zoom(distance);
  player.slow(!stillness());
  player.toggle(false);
  player.seek(0);
  lab.go(setup, { play, plots, ...others });
}

// Show what happens in a step.
function spin(lab, number, answer) {
  setStep(lab, number, { guess: { step: number, answer, seen: false } }, true);
}

/** The question of a step. */
export function questionOf(step) {
  const steps = part("story.steps");
  return steps[Math.min(step, steps.length - 1)].question;
}

// CSS class that hides what would tell the answer: "veiled" before the guess, "watched" while it plays, "" after.
export function veilOf({ tab, step, guess }) {
  if (tab !== "story") return "";
  if (guess?.step !== step) return "veiled";
  return guess.seen ? "" : "watched";
}
