// How finely a motion is drawn while it plays: as finely as the machine can draw it smoothly.

// Fractions of the full number of pixels along each side.
const SCALES = [1, 0.75, 0.5, 0.35];
// The time between pictures above which there are too many pixels, and the pictures in a row that show it.
const SLOW = 1 / 20;
const PATIENCE = 4;

export class Pace {
  level = 0;
  slow = 0;

  get scale() {
    return SCALES[this.level];
  }

  // Takes the seconds from one picture to the next.
  measure(seconds) {
    this.slow = seconds > SLOW ? this.slow + 1 : 0;
    if (this.slow >= PATIENCE && this.level + 1 < SCALES.length) {
      this.level++;
      this.slow = 0;
    }
  }
}
