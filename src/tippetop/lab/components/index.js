// What the page's components share: the player that is shown, what it shows, what it is doing now, and the map.

export const lab = new EventTarget();
lab.player = null;
lab.map = null;

// Whether the page is dark, and a call whenever that changes.
export function followTheme(call) {
  let known;
  const look = () => {
    const dark = document.body.classList.contains("body--dark");
    if (dark !== known) call((known = dark));
  };
  const observer = new MutationObserver(look);
  observer.observe(document.body, { attributes: true, attributeFilter: ["class"] });
  look();
  return observer;
}

// Let sliders that go by powers of ten be read out as what they mean, with its unit.
export function readPowers() {
  const read = (slider) => {
    const { unit } = slider.closest("[data-powers]")?.dataset ?? {};
    if (unit === undefined) return;
    const value = Number((10 ** Number(slider.getAttribute("aria-valuenow"))).toPrecision(3));
    slider.setAttribute("aria-valuetext", `${value} ${unit}`.trim());
  };
  const observer = new MutationObserver((changes) => changes.forEach(({ target }) => read(target)));
  observer.observe(document.body, { attributes: true, attributeFilter: ["aria-valuenow"], subtree: true });
  // They are put onto the page after the player.
  setTimeout(() => document.querySelectorAll("[data-powers]").forEach(read));
  return observer;
}
