// What is what: the model, every symbol, the keys.

import { useLayoutEffect, useRef } from "preact/hooks";

import { part, t } from "./i18n.js";
import { QUANTITIES } from "./units.js";

const FIELDS = [
  "launch.spin",
  "launch.tilt",
  "friction.mu",
  "friction.patch_radius",
  "body.shape.eccentricity",
  "body.I1",
  "body.I3",
];

export function Help({ onClose }) {
  const dialog = useRef();
  useLayoutEffect(() => {
    const last = document.activeElement;
    dialog.current.showModal();
    return () => last?.focus();
  }, []);
  const symbols = [
    ...new Map(
      [...FIELDS, ...Object.keys(QUANTITIES)].map((key) => [part(`quantities.${key}`).symbol, key]),
    ).values(),
  ];
  return (
    <dialog class="help" ref={dialog} onClose={onClose} aria-labelledby="help-title">
      <div class="row">
        <h2 id="help-title">{t("help.title")}</h2>
        <span class="space" />
        <button type="button" onClick={() => dialog.current.close()}>
          {t("page.close")}
        </button>
      </div>
      <Model />
      <p>{t("help.model")}</p>
      <h3>{t("help.symbols")}</h3>
      <dl>
        {[...symbols.map((key) => part(`quantities.${key}`)), ...part("help.letters")].map(
          ({ symbol, name, help }) => (
            <>
              <dt>{symbol}</dt>
              <dd>
                <b>{name}.</b> {help}
              </dd>
            </>
          ),
        )}
      </dl>
      <p>{t("help.keys")}</p>
      <p>{t("help.link")}</p>
      <p>
        {t("help.more")}{" "}
        <a href="https://tippetop.github.io/tippetop" rel="noreferrer">
          {t("help.docs")}
        </a>
      </p>
    </dialog>
  );
}

function Model() {
  return (
    <svg class="model" viewBox="0 -12 320 218" role="img" aria-label={t("help.drawing")}>
      <line x1="20" y1="180" x2="300" y2="180" class="ink" />
      <circle cx="150" cy="105" r="75" class="ball" />
      <line x1="150" y1="195" x2="150" y2="8" class="faint" />
      <line x1="115" y1="178" x2="202" y2="-4" class="axis" />
      <circle cx="150" cy="105" r="2.5" class="dot" />
      <circle cx="139" cy="128" r="5" class="mass" />
      <text x="120" y="133">
        C
      </text>
      <text x="160" y="25">
        θ
      </text>
      <text x="206" y="22">
        ω₃
      </text>
      <path d="M150 30 A75 75 0 0 1 182 38" class="axis" />
      <path d="M178 12 a14 6 25 1 0 22 8" class="axis" />
      <line x1="150" y1="180" x2="150" y2="142" class="force" />
      <text x="156" y="158">
        N
      </text>
      <line x1="150" y1="180" x2="102" y2="180" class="force" />
      <text x="92" y="172">
        F
      </text>
    </svg>
  );
}
