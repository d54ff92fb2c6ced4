// What the player's hosts import: the laboratory's page, the file that plays offline, the notebook.

export { Player, SPEEDS, createPlayer, stillness } from "./player.js";
export { Track } from "./track.js";
