// The renderer, the lights, and the model's space, whose unit is the size of the model.

import {
  DirectionalLight, Group, HemisphereLight, Matrix4, Scene, Vector3, WebGLRenderer,
} from "three";

const FINEST = 2;
const SHADOW = 2048;
// From where the main light comes, relative to what is looked at: from the left, above and before.
const SUN = new Vector3(-2, 4.5, 3.2);
// In front of a wall, rather from before, so that shadows on it are not long.
const SUN_AT_WALL = new Vector3(-1.2, 2.6, 5);
// The half width of what may cast a shadow, in units of the size of the model.
export const SHADED = 1.6;

export class Stage {
  constructor(canvas, context, extent) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, context });
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.shadowMap.enabled = true;
    this.scene = new Scene();
    this.world = new Group();
    this.world.matrixAutoUpdate = false;
    this.measure(extent);
    this.scene.add(this.world);
    this.addLights();
  }

  // Takes the size and the directions of a motion.
  measure(extent) {
    this.world.matrix.copy(placed(extent));
    this.world.matrixWorldNeedsUpdate = true;
    this.towardsSun = extent.isUpright ? SUN_AT_WALL : SUN;
  }

  addLights() {
    this.sky = new HemisphereLight(0xffffff, 0xffffff, 1);
    this.sun = new DirectionalLight(0xffffff, 1);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(SHADOW, SHADOW);
    this.sun.shadow.radius = 4;
    this.sun.shadow.normalBias = 0.004;
    this.sun.shadow.bias = -0.0004;
    const { camera } = this.sun.shadow;
    Object.assign(camera, { left: -SHADED, right: SHADED, top: SHADED, bottom: -SHADED, near: 0.1, far: 14 });
    // Brightens what the sun leaves dark, from the other side.
    this.fill = new DirectionalLight(0xffffff, 1);
    this.scene.add(this.sky, this.sun, this.sun.target, this.fill, this.fill.target);
  }

  colour(theme) {
    this.sky.intensity = theme.isDark ? 1.3 : 1.7;
    this.sky.groundColor.copy(theme.isDark ? theme.line : theme.soft);
    this.sun.intensity = theme.isDark ? 2.2 : 2.1;
    this.fill.intensity = 0.5;
  }

  // The lights, and the shadows that they cast, stay with what is looked at.
  lightAt(target) {
    this.sun.target.position.copy(target);
    this.sun.position.copy(target).add(this.towardsSun);
    this.fill.target.position.copy(target);
    this.fill.position.copy(target).sub(this.towardsSun).setY(target.y + this.towardsSun.y / 4);
  }

  // `scale` is the part of the pixels of the screen that are drawn along each side.
  resize(width, height, scale) {
    const ratio = scale * Math.min(window.devicePixelRatio || 1, FINEST);
    const [wide, high] = [width, height].map((length) => Math.max(1, Math.floor(length * ratio)));
    if (wide !== this.canvas.width || high !== this.canvas.height) {
      this.renderer.setDrawingBufferSize(width, height, ratio);
    }
  }

  render(camera) {
    this.renderer.render(this.scene, camera);
  }
}

// Gives back what the graphics card holds for shapes that are no longer drawn.
export function dispose(group) {
  group.removeFromParent();
  group.traverse((object) => {
    object.geometry?.dispose();
    object.material?.dispose();
    object.dispose?.();
  });
}

// The model's space, turned so that up is the second axis of the view, around the middle of the motion.
function placed({ right, up, middle, size }) {
  const [x, y] = [new Vector3(...right), new Vector3(...up)];
  const turned = new Matrix4().makeBasis(x, y, x.clone().cross(y)).transpose();
  const centred = new Matrix4().makeTranslation(...middle.map((m) => -m));
  const scaled = new Matrix4().makeScale(1 / size, 1 / size, 1 / size);
  return scaled.multiply(turned).multiply(centred);
}
