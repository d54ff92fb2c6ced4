// What the page's components share: the player that is shown, what it shows, and what it is doing now.

export const lab = new EventTarget();
lab.player = null;

// Whether the page is dark, and a call whenever that changes.
export function watchTheme(call) {
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
