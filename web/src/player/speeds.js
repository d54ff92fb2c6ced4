// Shares of its speed at which a run may be played.

export const SPEEDS = [1, 1 / 2, 1 / 3, 1 / 5, 1 / 10, 1 / 30, 1 / 100, 1 / 300, 1 / 1000];
