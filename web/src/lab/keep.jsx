// What can be taken along: numbers, launch, film, picture, print, command line.

import { useEffect, useRef, useState } from "preact/hooks";

import { Copy } from "./copy.jsx";
import { commandLine, Film, glb, picture, save } from "./files.js";
import { decimal, part, t } from "./i18n.js";
import { setupOf } from "./setup.js";
import { stl } from "./solid.js";
import { toml } from "./toml.js";
import { digits } from "./units.js";

export function Keep({ lab }) {
  const [recording, record] = useState(false);
  const film = useRef(null);
  // Whoever leaves ends the film, and has what there is of it.
  useEffect(() => () => film.current?.end(), []);
  const { track, player } = lab;
  const density = useSolid(lab, track?.header.problem.body);
  const video = async () => {
    if (film.current) return film.current.end();
    const caption = (time, share) =>
      `${decimal(time.toFixed(2))} s · ${player.paceText(share) || t("player.realTime")}`;
    film.current = new Film(player, caption);
    record(true);
    const content = await film.current.content;
    film.current = null;
    record(false);
    save("tippetop.webm", content);
  };
  const files = {
    csv: async () =>
      save("tippetop.csv", await lab.engine.csv(setupOf(track), part("player.point"))),
    toml: () => save("tippetop.toml", toml(track.header.problem)),
    glb: async () => save("tippetop.glb", await glb(track)),
    picture: async () => save("tippetop.png", await picture(player)),
    stl: () => save("tippetop.stl", stl(track.header.body)),
  };
  const command = track ? commandLine(track) : "";
  return (
    <div class="keep">
      <p>{t("keep.intro")}</p>
      <div class="files">
        {Object.entries(files).map(([kind, call]) => (
          <button
            type="button"
            data-kind={kind}
            disabled={!track || (kind === "stl" && !density)}
            onClick={call}
          >
            {t(`keep.${kind}`)}
          </button>
        ))}
        <button
          type="button"
          data-kind="video"
          disabled={!track || !globalThis.MediaRecorder}
          onClick={video}
        >
          {t(recording ? "keep.recording" : "keep.video")}
        </button>
        <button type="button" data-kind="print" onClick={() => print()}>
          {t("keep.print")}
        </button>
      </div>
      <p class="hint" role="status">
        {solidWords(density, track)}
      </p>
      <h3>{t("keep.command")}</h3>
      {track?.header.pushes && <p class="hint">{t("keep.pushed")}</p>}
      <pre tabIndex={0} role="region" aria-label={t("keep.command")}>
        {command}
      </pre>
      <div class="row">
        <Copy name={t("keep.copy")} text={() => command} />
      </div>
    </div>
  );
}

// The density of the solid that would be the top on the table; null if none of one material is, undefined until known.
function useSolid(lab, body) {
  const [density, say] = useState(undefined);
  useEffect(() => {
    let isWanted = true;
    const answer = (found) => {
      if (isWanted) say(found);
    };
    if (body) lab.engine.solid(body).then(answer, () => answer(null));
    return () => {
      isWanted = false;
    };
  }, [JSON.stringify(body)]);
  return density;
}

function solidWords(density, track) {
  if (!track || density === undefined) return "";
  if (density === null) return t("keep.noSolid");
  const { mass } = track.header.problem.body;
  return t("keep.filling", { density: digits(density / 1000, 3), mass: digits(1e3 * mass, 3) });
}
