// What can be taken along: numbers, launch, film, picture, print, command line.

import { useState } from "preact/hooks";

import { commandLine, film, glb, picture, save, toml } from "./files.js";
import { t } from "./i18n.js";
import { stl } from "./solid.js";

export function Keep({ lab }) {
  const [recording, record] = useState(false);
  const { track, player } = lab;
  const video = async () => {
    record(true);
    const content = await film(player).catch(() => null);
    record(false);
    if (content) save("tippetop.webm", content);
  };
  const files = {
    csv: async () =>
      save(
        "tippetop.csv",
        await lab.engine.csv({ problem: track.header.problem, duration: track.header.asked }),
      ),
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
          <button type="button" data-kind={kind} disabled={!track} onClick={call}>
            {t(`keep.${kind}`)}
          </button>
        ))}
        <button
          type="button"
          data-kind="video"
          disabled={!track || recording || !globalThis.MediaRecorder}
          onClick={video}
        >
          {t(recording ? "keep.recording" : "keep.video")}
        </button>
        <button type="button" data-kind="print" onClick={() => print()}>
          {t("keep.print")}
        </button>
      </div>
      <h3>{t("keep.command")}</h3>
      <pre tabIndex={0} role="region" aria-label={t("keep.command")}>
        {command}
      </pre>
      <button type="button" onClick={() => navigator.clipboard?.writeText(command)}>
        {t("keep.copy")}
      </button>
    </div>
  );
}
