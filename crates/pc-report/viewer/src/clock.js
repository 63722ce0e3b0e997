// The time of the motion: which still is shown, and how it goes on.

import { clamp, roundNumbers } from "./numbers.js";

// The seconds that a motion should last at the speed at first.
const [SHORTEST, LONGEST, BEST] = [5, 20, 10];

// The round number by which a motion of this duration is played; in real time if that lasts neither too short
// nor too long.
export function defaultSpeed(duration) {
  if (!(duration > 0) || (duration >= SHORTEST && duration <= LONGEST)) {
    return 1;
  }
  const strangeness = (speed) => Math.abs(Math.log(duration / speed / BEST));
  const speeds = roundNumbers(duration / LONGEST, duration / SHORTEST);
  return speeds.reduce((best, speed) => (strangeness(speed) < strangeness(best) ? speed : best));
}

export class Clock {
  constructor(times) {
    this.take(times);
    this.speed = defaultSpeed(this.duration);
    this.isPlaying = false;
    this.loops = true;
    this.show(0);
  }

  take(times) {
    this.times = times;
    this.last = times.length - 1;
    this.duration = Math.abs(times[this.last] - times[0]);
    this.direction = times[this.last] < times[0] ? -1 : 1;
  }

  // Goes on with another motion at the same time, and at the same speed if that was chosen.
  replace(times) {
    const { now } = this;
    const isChosen = this.speed !== defaultSpeed(this.duration);
    this.take(times);
    this.speed = isChosen ? this.speed : defaultSpeed(this.duration);
    this.isPlaying &&= this.duration > 0;
    this.seek(now);
  }

  // Goes to a still.
  show(n) {
    this.still = clamp(Math.round(n) || 0, 0, this.last);
    this.now = this.times[this.still];
  }

  // Goes to a time, or to the end that is nearest.
  seek(time) {
    const isBefore = (n) => (this.times[n] - time) * this.direction <= 0;
    this.show(0);
    while (this.still < this.last && isBefore(this.still + 1)) {
      this.still++;
    }
    this.now = this.still === this.last || !isBefore(0) ? this.times[this.still] : time;
  }

  // The number of stills before now, with a fraction.
  position() {
    const { times, still, last } = this;
    if (still === last) {
      return last;
    }
    const step = times[still + 1] - times[still];
    return step === 0 ? still : still + clamp((this.now - times[still]) / step, 0, 1);
  }

  isAtEnd() {
    return this.still === this.last;
  }

  start() {
    this.isPlaying = this.duration > 0;
    if (this.isAtEnd()) {
      this.show(0);
    }
  }

  // Goes on by seconds of the wall.
  advance(seconds) {
    this.now += this.direction * this.speed * seconds;
    const isPast = (n) => (this.times[n] - this.now) * this.direction <= 0;
    if (isPast(this.last)) {
      this.isPlaying = this.loops;
      this.show(this.loops ? 0 : this.last);
      return;
    }
    while (this.still < this.last && isPast(this.still + 1)) {
      this.still++;
    }
  }

  // The time in words, with as many digits as the stills need.
  text(time = this.now) {
    const step = this.duration / Math.max(this.last, 1);
    const digits = step > 0 ? clamp(Math.ceil(-Math.log10(step)), 0, 6) : 2;
    const size = Math.max(Math.abs(this.times[0]), Math.abs(this.times[this.last]));
    return size >= 1e6 || (size > 0 && size < 1e-3) ? time.toExponential(4) : time.toFixed(digits);
  }
}
