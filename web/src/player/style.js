// How the player looks; `tt-dark` on its host makes it dark.

export const STYLE = `
.tt-player { --tt-ink: #1e252d; --tt-muted: #56616c; --tt-paper: #ffffff; --tt-line: #cfd6dd; --tt-accent: #0b5fa5;
  display: flex; flex-direction: column; color: var(--tt-ink); background: var(--tt-paper);
  font: 14px/1.4 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; container-type: inline-size; }
.tt-player.tt-dark { --tt-ink: #e6ebf0; --tt-muted: #a5b0bb; --tt-paper: #1c2128; --tt-line: #3a434d;
  --tt-accent: #66c5f0; color-scheme: dark; }
.tt-player * { box-sizing: border-box; }
.tt-stage { position: relative; flex: 1 1 auto; min-height: 200px; }
.tt-canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; touch-action: pan-y;
  outline-offset: -3px; }
.tt-player :focus-visible { outline: 2px solid var(--tt-accent); }
.tt-words { flex: 0 0 auto; padding: 8px 12px; max-height: 34%; overflow-y: auto; }
.tt-words:empty { display: none; }
.tt-words strong { display: block; font-size: 1.25rem; line-height: 1.25; font-weight: 650; }
.tt-words strong::first-letter { text-transform: uppercase; }
.tt-words span { color: var(--tt-muted); }
.tt-scale { position: absolute; right: 12px; bottom: 8px; font-size: 12px; color: var(--tt-muted);
  pointer-events: none; background: color-mix(in srgb, var(--tt-paper) 65%, transparent); padding: 1px 7px;
  border-radius: 5px; }
.tt-facts { position: absolute; left: 12px; bottom: 34px; font-size: 12px; pointer-events: none;
  font-variant-numeric: tabular-nums; background: color-mix(in srgb, var(--tt-paper) 65%, transparent);
  padding: 1px 7px; border-radius: 5px; }
.tt-pace { position: absolute; right: 12px; top: 8px; font-size: 12px; font-weight: 600; pointer-events: none;
  background: color-mix(in srgb, var(--tt-paper) 65%, transparent); padding: 1px 7px; border-radius: 5px; }
:is(.tt-scale, .tt-facts, .tt-pace):empty { display: none; }
.tt-mode { position: absolute; left: 12px; bottom: 8px; font-size: 12px; font-weight: 600; padding: 2px 9px;
  border-radius: 9px; color: #fff; background: #b34700; pointer-events: none; }
.tt-mode[hidden] { display: none; }
.tt-mode[data-mode=sticking] { background: #2b7a3a; }
.tt-mode[data-mode=flight] { background: #0b5fa5; }
.tt-mode[data-mode=stem], .tt-mode[data-mode=other], .tt-mode[data-mode=double] { background: #6a3fc0; }
.tt-trouble { position: absolute; inset: auto 12px 12px; margin: 0; padding: 8px 12px; border-radius: 6px;
  background: var(--tt-paper); border: 1px solid var(--tt-line); }
.tt-trouble[hidden] { display: none; }
.tt-bar { display: flex; align-items: center; gap: 6px; padding: 6px 10px; flex: 0 0 auto;
  border-top: 1px solid var(--tt-line); }
.tt-more { border-top: 1px solid var(--tt-line); font-size: 13px; flex: 0 0 auto; }
.tt-more summary { padding: 6px 12px; cursor: pointer; color: var(--tt-muted); }
.tt-options { display: flex; flex-wrap: wrap; align-items: center; gap: 4px 14px; padding: 0 12px 8px; }
.tt-bar button { display: inline-grid; place-items: center; min-width: 36px; height: 36px; padding: 0 8px; border: 1px solid var(--tt-line); border-radius: 8px;
  background: transparent; color: inherit; font: inherit; font-size: 15px; cursor: pointer; }
.tt-bar button:disabled { opacity: 0.35; cursor: default; }
.tt-bar button:not(:disabled):hover { border-color: var(--tt-accent); }
.tt-bar .tt-play { background: var(--tt-accent); border-color: var(--tt-accent); color: var(--tt-paper);
  min-width: 46px; }
.tt-more label { display: inline-flex; align-items: center; gap: 5px; min-height: 30px; white-space: nowrap; }
.tt-more select { font: inherit; color: inherit; background: var(--tt-paper); border: 1px solid var(--tt-line);
  border-radius: 6px; padding: 3px 6px; }
.tt-more input[type=checkbox] { accent-color: var(--tt-accent); width: 16px; height: 16px; margin: 0; }
.tt-arrows { display: inline-flex; flex-wrap: wrap; gap: 4px 12px; }
.tt-arrows i { width: 14px; height: 4px; border-radius: 2px; }
.tt-scrub { position: relative; flex: 1 1 auto; height: 36px; border: 1px solid var(--tt-line); border-radius: 8px;
  overflow: hidden; }
.tt-scrub:focus-within { outline: 2px solid var(--tt-accent); outline-offset: 1px; }
.tt-strip { position: absolute; inset: 0; width: 100%; height: 100%; }
.tt-scrub input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; background: transparent;
  appearance: none; -webkit-appearance: none; cursor: ew-resize; }
.tt-scrub input::-webkit-slider-runnable-track { background: transparent; height: 100%; }
.tt-scrub input::-webkit-slider-thumb { -webkit-appearance: none; width: 3px; height: 36px; background: #d6336c; }
.tt-scrub input::-moz-range-track { background: transparent; height: 100%; }
.tt-scrub input::-moz-range-thumb { width: 3px; height: 36px; border: 0; border-radius: 0; background: #d6336c; }
.tt-time { min-width: 72px; text-align: right; font-variant-numeric: tabular-nums; }
@media (pointer: coarse) {
  .tt-bar button { min-width: 44px; height: 44px; }
  .tt-scrub { height: 44px; }
  .tt-more summary, .tt-more label { min-height: 44px; box-sizing: border-box; align-content: center; }
  .tt-more select { min-height: 40px; }
}
@container (max-width: 520px) {
  .tt-words strong { font-size: 1.05rem; }
  .tt-words span { font-size: 12px; display: block; }
  .tt-time { min-width: 60px; font-size: 12px; }
}
`;
