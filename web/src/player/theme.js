// A page in a frame takes over the theme that a reader has chosen by hand on the page around it.

/** Call `set` with "light" or "dark" whenever the page around this one says which it is. */
export function followTheme(set) {
  addEventListener("message", ({ source, data }) => {
    const theme = data?.tippetopTheme;
    if (source === parent && source !== window && ["light", "dark"].includes(theme)) set(theme);
  });
}
