// Names of the fixed axes, and the curves whose colours they have: reddish, greenish, bluish.
export const AXES = [{ name: "x", hue: 1 }, { name: "y", hue: 2 }, { name: "z", hue: 0 }];
