// The strip to scrub on: the tilt over the whole run, flights shaded.

export function drawStrip(canvas, track, dark, ghosts = []) {
  const ratio = globalThis.devicePixelRatio || 1;
  const width = (canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio)));
  const height = (canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio)));
  const pen = canvas.getContext("2d");
  const { start } = track;
  const duration = track.duration - start || 1;
  const across = (time) => ((time - start) / duration) * width;
  pen.clearRect(0, 0, width, height);
  pen.fillStyle = dark ? "rgba(102,197,240,.25)" : "rgba(11,95,165,.16)";
  // Of flights that lie in one pixel that is shaded once.
  pen.beginPath();
  for (const [begin, end] of track.header.flights) {
    pen.rect(across(begin), 0, Math.max(1, across(end) - across(begin)), height);
  }
  pen.fill();
  for (const ghost of ghosts)
    line(pen, ghost, across, width, height, ratio, dark ? "#8b96a1" : "#9aa5b0");
  line(pen, track, across, width, height, ratio, dark ? "#66c5f0" : "#0b5fa5");
}

function line(pen, { count, time, columns: { theta } }, across, width, height, ratio, colour) {
  const stride = Math.max(1, Math.floor(count / (2 * width)));
  pen.beginPath();
  for (let i = 0; i < count; i += stride) {
    const x = across(time[i]);
    const y = height * (0.94 - 0.88 * (theta[i] / Math.PI));
    if (i) pen.lineTo(x, y);
    else pen.moveTo(x, y);
  }
  pen.lineWidth = 1.5 * ratio;
  pen.lineJoin = "round";
  pen.strokeStyle = colour;
  pen.stroke();
}
