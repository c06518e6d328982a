// Undo and redo: robots, descriptions and states.

const MOST = 200;

export class History {
  constructor(undo, redo, { now, restore }) {
    Object.assign(this, { past: [], future: [], undoButton: undo, redoButton: redo, now, restore });
    undo.addEventListener("click", () => this.undo());
    redo.addEventListener("click", () => this.redo());
    this.show();
  }

  // Call before a change.
  remember() {
    const now = this.now();
    const last = this.past.at(-1);
    if (last && same(last, now)) return;
    this.past.push(now);
    if (this.past.length > MOST) this.past.shift();
    this.future = [];
    this.show();
  }

  undo() {
    this.step(this.past, this.future);
  }

  redo() {
    this.step(this.future, this.past);
  }

  async step(from, to) {
    if (from.length === 0) return;
    to.push(this.now());
    const state = from.pop();
    this.show();
    await this.restore(state);
  }

  show() {
    this.undoButton.disabled = this.past.length === 0;
    this.redoButton.disabled = this.future.length === 0;
  }
}

const same = (a, b) => a.entry === b.entry && a.description === b.description && String(a.theta) === String(b.theta) && String(a.dtheta) === String(b.dtheta);
