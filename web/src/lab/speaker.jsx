// What happens on the stage, told to those who do not see it as it happens.

import { useEffect, useState } from "preact/hooks";

import { t } from "./i18n.js";

// How far from the vertical the top still stands, rad, and by how much more it must lean to be told anew.
const STANDS = 0.15;
const SLACK = 0.06;
const QUARTER = Math.PI / 4;
// Contacts that are told.
const TOLD = ["stem", "double", "flight", "sticking"];

export function Speaker({ lab }) {
  const [text, say] = useState("");
  useEffect(() => {
    let last = {};
    const look = () => {
      const { player, track } = lab;
      const now = {
        place: placeOf(track.value("tilt", player.time), last.place),
        mode: track.mode(player.time),
      };
      if (player.playing) {
        const words = newsOf(last, now);
        if (words) say(words);
      }
      last = now;
    };
    const forget = () => {
      last = {};
    };
    lab.addEventListener("time", look);
    lab.addEventListener("run", forget);
    return () => {
      lab.removeEventListener("time", look);
      lab.removeEventListener("run", forget);
    };
  }, []);
  return (
    <p class="hidden" role="status">
      {text}
    </p>
  );
}

// How the axis stands: "upright", "inverted", or by how many eighths of a turn it leans.
function placeOf(tilt, before) {
  if (tilt < STANDS) return "upright";
  if (tilt > Math.PI - STANDS) return "inverted";
  const lean = Math.round(tilt / QUARTER);
  const isNear = typeof before === "number" && Math.abs(tilt / QUARTER - before) < 0.5 + SLACK;
  return isNear ? before : lean;
}

function newsOf(before, now) {
  const news = [];
  if (now.mode !== before.mode && TOLD.includes(now.mode) && before.mode !== undefined)
    news.push(t(`spoken.${now.mode}`));
  if (now.place !== before.place && now.place !== 0 && now.place !== 4) {
    const isLean = typeof now.place === "number";
    news.push(isLean ? t("spoken.leans", { angle: 45 * now.place }) : t(`spoken.${now.place}`));
  }
  return news.join(" ");
}
