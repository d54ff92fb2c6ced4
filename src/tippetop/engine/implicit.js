export class Collocation {
  constructor(tolerance) { this.tolerance = tolerance; this.name = "radau"; }
  *integrate() { throw new Error("not yet"); }
}
