// The time: play, pause, scrub, speed.

export const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];

export class Player {
  constructor(t, onTime) {
    [this.start, this.end] = [t[0], t[t.length - 1]];
    this.time = this.start;
    this.speed = 1;
    this.isPlaying = false;
    this.isLooping = false;
    this.onTime = onTime;
  }

  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.onTime(this.time);
  }

  play() {
    if (this.isPlaying || this.end === this.start) return;
    if (this.time >= this.end) this.time = this.start;
    this.isPlaying = true;
    let last = performance.now();
    const tick = (now) => {
      if (!this.isPlaying) return;
      this.time += (Math.max(now - last, 0) / 1000) * this.speed;
      last = now;
      if (this.time >= this.end && this.isLooping) {
        this.time = this.start;
        requestAnimationFrame(tick);
      } else if (this.time >= this.end) {
        this.time = this.end;
        this.isPlaying = false;
      } else {
        requestAnimationFrame(tick);
      }
      this.onTime(this.time);
    };
    requestAnimationFrame(tick);
    this.onTime(this.time);
  }

  pause() {
    this.isPlaying = false;
    this.onTime(this.time);
  }

  toggle() {
    if (this.isPlaying) this.pause();
    else this.play();
  }
}
