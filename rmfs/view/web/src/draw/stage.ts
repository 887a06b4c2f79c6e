/** The canvas, the cameras and the light: a plan seen from above, or a view in space. */

import {
  type Camera,
  Color,
  Group,
  LinearSRGBColorSpace,
  MOUSE,
  type Object3D,
  OrthographicCamera,
  PerspectiveCamera,
  Raycaster,
  Scene,
  TOUCH,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Background } from "./background";
import { inSoftware } from "./graphics";
import { GROUND, type Theme } from "./palette";
import type { Placement } from "./placement";

const FAR_M = 2000;
const SHARPEST = 2;
/** How far back, and how far up, the camera in space stands at first. */
const SLOPE = [1, 0.85];
/** Room around what is overlooked. */
const MARGIN = 1.12;

/** Position, target and zoom of a camera, as numbers for a link. */
export type CameraState = number[];

export class Stage {
  /** What moves. */
  readonly scene = new Scene();
  readonly renderer: WebGLRenderer;
  private readonly background: Background;
  private readonly ground = new Group();
  private readonly plan = new OrthographicCamera(-1, 1, 1, -1, 0.1, FAR_M);
  private readonly space = new PerspectiveCamera(45, 1, 0.5, FAR_M);
  private readonly planControls: OrbitControls;
  private readonly spaceControls: OrbitControls;
  private placement: Placement | undefined;
  private width = 1;
  private height = 1;

  /** `changed` is called when the user moves the camera. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    changed: () => void,
  ) {
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: !inSoftware(),
      powerPreference: "high-performance",
    });
    this.renderer.setPixelRatio(inSoftware() ? 1 : Math.min(window.devicePixelRatio, SHARPEST));
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.background = new Background(this.renderer, !inSoftware());
    this.space.up.set(0, 0, 1);
    this.planControls = new OrbitControls(this.plan, canvas);
    this.planControls.enableRotate = false;
    this.planControls.mouseButtons = { LEFT: MOUSE.PAN, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.planControls.touches = { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_PAN };
    this.spaceControls = new OrbitControls(this.space, canvas);
    this.spaceControls.maxPolarAngle = 0.49 * Math.PI;
    for (const controls of [this.planControls, this.spaceControls]) {
      controls.enableDamping = false;
      controls.zoomToCursor = true;
      controls.addEventListener("change", changed);
    }
  }

  private get flat(): boolean {
    return this.placement?.mode !== "3d";
  }

  private get camera(): Camera {
    return this.flat ? this.plan : this.space;
  }

  private get controls(): OrbitControls {
    return this.flat ? this.planControls : this.spaceControls;
  }

  setTheme(theme: Theme): void {
    this.renderer.setClearColor(new Color(GROUND[theme].back));
    this.background.forget();
  }

  /** Shows the tiers as placed, from a point that overlooks all of them. */
  overlook(placement: Placement): void {
    this.placement = placement;
    this.planControls.enabled = this.flat;
    this.spaceControls.enabled = !this.flat;
    const { x, y, z, width, depth } = placement.box;
    if (this.flat) {
      this.plan.zoom = 1;
      this.plan.position.set(x, y, FAR_M / 2);
      this.planControls.target.set(x, y, 0);
    } else {
      this.space.position.set(x, y - SLOPE[0], SLOPE[1]);
      this.space.lookAt(x, y, 0);
      this.space.updateMatrixWorld();
    }
    this.resize(this.width, this.height);
    if (!this.flat) this.retreat({ x, y, z, width, depth });
    this.controls.update();
  }

  /** Moves the camera in space back, without turning it, until it just sees a whole box. */
  private retreat({ x, y, z, width, depth }: Placement["box"]): void {
    const { space } = this;
    const [right, up, back] = [new Vector3(), new Vector3(), new Vector3()];
    space.matrixWorld.extractBasis(right, up, back);
    const corners = [-1, 1].flatMap((i) =>
      [-1, 1].flatMap((j) =>
        [0, 2].map((k) => new Vector3(x + (i * width) / 2, y + (j * depth) / 2, k * z)),
      ),
    );
    const steepness = Math.tan((space.fov * Math.PI) / 360) / MARGIN;
    const across = bounds(corners, right, back, steepness * space.aspect);
    const along = bounds(corners, up, back, steepness);
    space.position
      .set(0, 0, 0)
      .addScaledVector(right, across.middle)
      .addScaledVector(up, along.middle)
      .addScaledVector(back, Math.max(across.away, along.away));
    // what it turns about is on the floor
    this.spaceControls.target.copy(space.position);
    this.spaceControls.target.addScaledVector(back, -space.position.z / back.z);
  }

  /** Returns how much the plan shows per pixel, in metres; in space, in the middle of the picture. */
  get pixel_m(): number {
    const { plan, space, height } = this;
    if (this.flat) return (plan.top - plan.bottom) / plan.zoom / height;
    const away = space.position.distanceTo(this.spaceControls.target);
    return (2 * away * Math.tan((space.fov * Math.PI) / 360)) / height;
  }

  resize(width: number, height: number): void {
    if (width < 2 || height < 2) return;
    this.width = width;
    this.height = height;
    this.renderer.setSize(width, height, false);
    this.space.aspect = width / height;
    this.space.updateProjectionMatrix();
    const box = this.placement?.box ?? { width: 1, depth: 1 };
    const half = 0.54 * Math.max(box.depth, (box.width * height) / width) + 1;
    Object.assign(this.plan, {
      top: half,
      bottom: -half,
      left: (-half * width) / height,
      right: (half * width) / height,
    });
    this.plan.updateProjectionMatrix();
  }

  /** Moves the camera so that it looks at a point as it looked at its target before. */
  follow(x: number, y: number, z: number): void {
    const shift = new Vector3(x, y, z).sub(this.controls.target);
    if (this.flat) shift.z = 0;
    this.controls.target.add(shift);
    this.camera.position.add(shift);
    this.camera.updateMatrixWorld();
  }

  get cameraState(): CameraState {
    const { target } = this.controls;
    const state = [...this.camera.position.toArray(), ...target.toArray()];
    return this.flat ? [...state, this.plan.zoom] : state;
  }

  set cameraState(state: CameraState) {
    const [px, py, pz, tx, ty, tz, zoom] = state;
    this.camera.position.set(px, py, pz);
    this.controls.target.set(tx, ty, tz);
    if (this.flat && zoom > 0) {
      this.plan.zoom = zoom;
      this.plan.updateProjectionMatrix();
    }
    this.controls.update();
  }

  /** Returns a ray through a point of the page. */
  ray(clientX: number, clientY: number): Raycaster {
    const frame = this.canvas.getBoundingClientRect();
    const point = new Vector2(
      (2 * (clientX - frame.left)) / frame.width - 1,
      1 - (2 * (clientY - frame.top)) / frame.height,
    );
    const caster = new Raycaster();
    this.camera.updateMatrixWorld();
    caster.setFromCamera(point, this.camera);
    return caster;
  }

  /** Puts what stands still on the stage in the place of what stood there. */
  lay(...bodies: Object3D[]): void {
    this.ground.clear();
    this.ground.add(...bodies);
    this.background.forget();
  }

  /** Takes note that what stands still looks different now. */
  relay(): void {
    this.background.forget();
  }

  render(): void {
    this.renderer.info.autoReset = false;
    this.renderer.info.reset();
    // an upper floor covers what is below it, so it must be drawn after that
    const beneath = this.placement?.hasUpperFloors !== true;
    (beneath ? this.background.scene : this.scene).add(this.ground);
    this.renderer.clear(!beneath);
    if (beneath) this.background.draw(this.camera);
    this.renderer.render(this.scene, this.camera);
  }
}

/**
 * Returns how far back a camera must be to see some points between two planes through it, and where
 * across its view its middle then is; the planes rise by `steepness` from the line of sight.
 */
function bounds(points: Vector3[], across: Vector3, back: Vector3, steepness: number) {
  const least = Math.min(...points.map((p) => p.dot(across) - steepness * p.dot(back)));
  const most = Math.max(...points.map((p) => p.dot(across) + steepness * p.dot(back)));
  return { away: (most - least) / (2 * steepness), middle: (most + least) / 2 };
}
