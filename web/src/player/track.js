// A run in the browser: reads the block of bytes that Python packs (track.py), and says where the top is at any
// time. No physics: between samples the axis is interpolated with its rate, and the turn about it with the spin.

// What a block begins with: "TTRK".
const MAGIC = 0x5454524b;

export class Track {
  // Of a block of bytes as Python packs it, or of a header, times and columns.
  constructor(run) {
    if (run instanceof ArrayBuffer) this.unpack(run);
    else Object.assign(this, { header: run.header, time: run.time, columns: run.columns });
    this.count = this.time.length;
    this.start = this.time[0] ?? 0;
    this.duration = this.header.duration;
    this.pose = {
      position: [0, 0, 0],
      orientation: [1, 0, 0, 0],
      axis: [0, 0, 1],
      momentum: [0, 0, 0],
    };
    // The time that the pose is of: in a picture several ask for the same one.
    this.posedAt = NaN;
  }

  unpack(buffer) {
    const view = new DataView(buffer);
    if (view.getUint32(0) !== MAGIC) throw new Error("this is not a run");
    const length = view.getUint32(4, true);
    this.header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
    const count = this.header.samples;
    let offset = 8 + length;
    this.time = new Float64Array(buffer, offset, count);
    offset += 8 * count;
    this.columns = {};
    for (const [name, width] of this.header.columns) {
      this.columns[name] = new Float32Array(buffer, offset, count * width);
      offset += 4 * count * width;
    }
  }

  // What the contact does at a time, in a word; undefined where that is not known.
  mode(time) {
    const label = this.header.modes?.[this.columns.mode[this.before(time)]];
    if (label === undefined) return undefined;
    const [kind, surfaces = "0", others] = label.split("_on_");
    if (others !== undefined || surfaces.includes("_and_")) return "double";
    if (kind.endsWith("_flat")) return kind;
    if (surfaces !== "0") return this.kindOf(Number(surfaces));
    return kind.replace("_without_rolling", "");
  }

  // What a surface is that touches instead of the first: the stem's end is a smaller sphere above all others.
  kindOf(number) {
    const shapes = [this.header.problem.body.shape].flat();
    const { kind, radius } = shapes[number];
    if (kind === "ring") return "rim";
    const isStem = number === shapes.length - 1 && kind === "sphere" && radius < shapes[0].radius;
    return isStem ? "stem" : "other";
  }

  // The table at a time: pushes may have lifted it.
  table(time) {
    const { problem, pushes = [], reached = 0 } = this.header;
    const isLifted = (push, k) => k < reached && push.time <= time && (push.slope ?? null) !== null;
    const slope = pushes.findLast(isLifted)?.slope ?? problem?.table?.slope ?? 0;
    return { slope, azimuth: problem?.table?.azimuth ?? 0 };
  }

  // How fast it turns at a time about whatever axis, and about its own, rad/s.
  turning(time) {
    const { axis, momentum } = this.at(time);
    const { I1, I3 } = this.header.body;
    const along = dot(momentum, axis);
    const spin = along / I3;
    const across = momentum.map((value, k) => (value - along * axis[k]) / I1);
    return { rate: Math.hypot(spin, ...across), spin };
  }

  // A time, or the end that is nearer: a run that is a part of one begins later than at zero.
  within(time) {
    return Math.min(Math.max(time, this.start), this.duration);
  }

  // The number of the last sample at or before a time.
  before(time) {
    let low = 0;
    let high = this.count - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time[middle] <= time) low = middle;
      else high = middle - 1;
    }
    return Math.min(low, Math.max(this.count - 2, 0));
  }

  // A column at a time, straight between its samples.
  value(name, time, part = 0, width = 1) {
    const { i, j, u } = this.around(time);
    const column = this.columns[name];
    return (1 - u) * column[i * width + part] + u * column[j * width + part];
  }

  flying(time) {
    return this.header.flights.some(([begin, end]) => begin < time && time < end);
  }

  // The samples on either side of a time, how far apart they are, s, and which part of that has passed.
  around(time) {
    const i = this.before(time);
    const j = Math.min(i + 1, this.count - 1);
    const h = this.time[j] - this.time[i];
    const u = h > 0 ? Math.min(Math.max((time - this.time[i]) / h, 0), 1) : 0;
    return { i, j, h, u };
  }

  // Where the top is: the same object every time, to be read at once.
  at(time) {
    if (time === this.posedAt) return this.pose;
    this.posedAt = time;
    const { i, j, h, u } = this.around(time);
    const { orientation, momentum, position, velocity } = this.columns;
    const { I1, I3 } = this.header.body;
    const first = slice(orientation, i, 4);
    const last = slice(orientation, j, 4);
    const L = [slice(momentum, i, 3), slice(momentum, j, 3)];
    const n = [axisOf(first), axisOf(last)];
    const rate = [0, 1].map((k) => cross(L[k], n[k]).map((v) => v / I1));
    const spin = [0, 1].map((k) => dot(L[k], n[k]) / I3);
    // The shortest rotation itself turns about the axis that it carries.
    spin[1] += dot(cross(n[0], n[1]), rate[1]) / Math.max(1 + dot(n[0], n[1]), 1e-9);
    const axis = unit(hermite(u, h, n[0], n[1], rate[0], rate[1]));

    const carried = multiply(shortest(n[0], n[1]), first);
    const left = multiply(conjugate(carried), last);
    let twist = 2 * Math.atan2(left[3], left[0]);
    const expected = 0.5 * h * (spin[0] + spin[1]);
    twist += 2 * Math.PI * Math.round((expected - twist) / (2 * Math.PI));
    const turned = hermite(u, h, [0], [twist], [spin[0]], [spin[1]])[0];
    const about = [Math.cos(turned / 2), 0, 0, Math.sin(turned / 2)];

    const pose = this.pose;
    pose.orientation = multiply(multiply(shortest(n[0], axis), first), about);
    pose.axis = axis;
    pose.momentum = L[0].map((v, k) => (1 - u) * v + u * L[1][k]);
    pose.position = hermite(
      u,
      h,
      slice(position, i, 3),
      slice(position, j, 3),
      slice(velocity, i, 3),
      slice(velocity, j, 3),
    );
    return pose;
  }
}

function slice(column, i, width) {
  return Array.from(column.subarray(i * width, (i + 1) * width));
}

function hermite(u, h, a, b, rateA, rateB) {
  const v = 1 - u;
  return a.map(
    (value, k) =>
      v * v * (1 + 2 * u) * value +
      u * u * (3 - 2 * u) * b[k] +
      u * v * h * (v * rateA[k] - u * rateB[k]),
  );
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit(a) {
  const length = Math.hypot(...a) || 1;
  return a.map((v) => v / length);
}

function multiply(a, b) {
  const c = cross(a.slice(1), b.slice(1));
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + b[0] * a[1] + c[0],
    a[0] * b[2] + b[0] * a[2] + c[1],
    a[0] * b[3] + b[0] * a[3] + c[2],
  ];
}

function conjugate(a) {
  return [a[0], -a[1], -a[2], -a[3]];
}

// The shortest rotation from one unit vector to another.
function shortest(start, end) {
  const q = [1 + dot(start, end), ...cross(start, end)];
  const length = Math.hypot(...q);
  return length < 1e-9 ? [0, 1, 0, 0] : q.map((v) => v / length);
}

// The body's z axis in space.
function axisOf([w, x, y, z]) {
  return [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
}
