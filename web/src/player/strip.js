// The strip to scrub on: the tilt over the whole run, flights shaded.

export function drawStrip(canvas, track, dark, ghosts = []) {
  const ratio = globalThis.devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
  const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  canvas.width = width;
  canvas.height = height;
  const pen = canvas.getContext("2d");
  const { start } = track;
  const duration = track.duration - start || 1;
  const across = (time) => ((time - start) / duration) * width;
  pen.clearRect(0, 0, width, height);
  pen.fillStyle = dark ? "rgba(102,197,240,.25)" : "rgba(11,95,165,.16)";
  // Flights that lie in one pixel are shaded once.
  pen.beginPath();
  for (const [begin, end] of track.header.flights) {
    pen.rect(across(begin), 0, Math.max(1, across(end) - across(begin)), height);
  }
  pen.fill();
  pen.lineWidth = 1.5 * ratio;
  pen.lineJoin = "round";
  pen.strokeStyle = dark ? "#8b96a1" : "#9aa5b0";
  for (const ghost of ghosts) drawTilt(pen, ghost, across, width, height);
  pen.strokeStyle = dark ? "#66c5f0" : "#0b5fa5";
  drawTilt(pen, track, across, width, height);
}

function drawTilt(pen, { count, time, columns: { tilt } }, across, width, height) {
  const stride = Math.max(1, Math.floor(count / (2 * width)));
  pen.beginPath();
  for (let i = 0; i < count; i += stride) {
    const x = across(time[i]);
    const y = height * (0.94 - 0.88 * (tilt[i] / Math.PI));
    if (i) pen.lineTo(x, y);
    else pen.moveTo(x, y);
  }
  pen.stroke();
}
