// Materials of solid shapes.

import { Color, MeshPhongMaterial } from "three";

// A surface whose colour `pick` takes from the theme.
export function surface(pick, options = {}) {
  const material = new MeshPhongMaterial({ specular: 0x444444, shininess: 45, ...options });
  material.userData.pick = pick;
  return material;
}

export const ofCurve = (hue) => (theme) => theme.curves[hue];
export const ofRods = (theme) => theme.rod;

export function colour(root, theme) {
  root.traverse(({ material }) => {
    if (material?.userData.pick) {
      material.color.copy(material.userData.pick(theme));
    }
    // So that colours of curves are not lost in the shade.
    if (material?.emissive) {
      material.emissive = new Color(material.color).multiplyScalar(theme.isDark ? 0.08 : 0.12);
    }
  });
}
