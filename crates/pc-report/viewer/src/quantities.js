// What arrows stand for: the words of a legend, the sign on a button, and the curve whose colour they have.

export const QUANTITIES = {
  velocity: { words: "velocity", sign: "v", hue: 2, hint: "Velocities of mass centres" },
  turning: { words: "angular velocity", sign: "\u03c9", hue: 4, hint: "Angular velocities" },
  force: { words: "force", sign: "F", hue: 1, hint: "Weights and forces" },
  reaction: { words: "reaction", sign: "R", hue: 3, hint: "Reactions of constraints, contacts and joints" },
};

// The length of the longest vector of each quantity over the motion, for those that are not zero all the time.
export function longest({ arrows, stills, width }) {
  const lengths = new Map();
  for (const { quantity, vector } of arrows) {
    let most = lengths.get(quantity) ?? 0;
    for (let i = vector; i < stills.length; i += width) {
      const length = Math.hypot(stills[i], stills[i + 1], stills[i + 2]);
      most = Number.isFinite(length) ? Math.max(most, length) : most;
    }
    lengths.set(quantity, most);
  }
  return new Map(Object.keys(QUANTITIES).filter((name) => lengths.get(name) > 0).map((name) => [name, lengths.get(name)]));
}
