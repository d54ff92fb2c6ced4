// The strip to scrub on: the tilt over the whole run, flights shaded.

export function drawStrip(canvas, track, dark) {
  const ratio = globalThis.devicePixelRatio || 1;
  const width = (canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio)));
  const height = (canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio)));
  const pen = canvas.getContext("2d");
  const { count, time } = track;
  const duration = track.duration || 1;
  pen.clearRect(0, 0, width, height);
  pen.fillStyle = dark ? "rgba(102,197,240,.25)" : "rgba(11,95,165,.16)";
  for (const [begin, end] of track.header.flights) {
    pen.fillRect((begin / duration) * width, 0, Math.max(1, ((end - begin) / duration) * width), height);
  }
  const theta = track.columns.theta;
  const stride = Math.max(1, Math.floor(count / (2 * width)));
  pen.beginPath();
  for (let i = 0; i < count; i += stride) {
    const x = (time[i] / duration) * width;
    const y = height * (0.94 - 0.88 * (theta[i] / Math.PI));
    if (i) pen.lineTo(x, y);
    else pen.moveTo(x, y);
  }
  pen.lineWidth = 1.5 * ratio;
  pen.lineJoin = "round";
  pen.strokeStyle = dark ? "#66c5f0" : "#0b5fa5";
  pen.stroke();
}
