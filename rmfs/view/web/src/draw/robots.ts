/** Robots: a disc with a nose, in space also a mast above the pods, coloured by what is asked. */

import {
  BoxGeometry,
  CircleGeometry,
  Color,
  CylinderGeometry,
  Group,
  MeshBasicMaterial,
  PlaneGeometry,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { Piece, type Pose } from "../data/motion";
import type { Run } from "../data/run";
import { type Bodies, bodies } from "./bodies";
import { amount, between, type Kinds, robotColours, type Theme } from "./palette";
import type { Placement } from "./placement";
import { shaded, shadedMaterial } from "./shapes";

export type RobotMode = Kinds | "delay" | "charge";

/** A delay of so many seconds, or more, has the strongest colour. */
export const LONGEST_DELAY_S = 120;

const HEIGHT_M = 0.3;
const ABOVE_PODS_M = 0.4;
/** Where the top of the mast is, in heights of a robot above its middle: higher than any pod. */
const MAST = 6.8;
const STANDING = new Set<number>([Piece.HOLD, Piece.LIFT, Piece.SET_DOWN]);

export class RobotBodies {
  readonly group = new Group();
  readonly bodies: Bodies;
  private readonly noses: Bodies;
  private readonly radius: Float64Array;
  private readonly shapes = {
    "2d": {
      body: shaded(new CircleGeometry(1, 20)),
      nose: new PlaneGeometry(1, 0.3).translate(0.5, 0, 0.5),
    },
    "3d": {
      body: shaded(masted()),
      nose: new BoxGeometry(1, 0.3, 1).translate(0.5, 0, 0),
    },
  };
  /** The row of the trace with which each robot was drawn last, if it stood; -1 if it did not. */
  private readonly stood: Int32Array;
  private placement: Placement | undefined;
  private readonly colour = new Color();
  private readonly colours: Record<Theme, Record<Kinds | "delay", Color[]>>;

  constructor(private readonly run: Run) {
    const { robotKind, header } = run.layout;
    this.radius = Float64Array.from(robotKind, (kind) => header.robot_kinds[kind].radius_m);
    const { body, nose } = this.shapes["2d"];
    this.bodies = bodies(body, shadedMaterial(), robotKind.length);
    this.noses = bodies(nose, new MeshBasicMaterial({ color: "#111111" }), robotKind.length);
    this.stood = new Int32Array(robotKind.length).fill(-1);
    this.group.add(this.bodies.mesh, this.noses.mesh);
    const colours = (theme: Theme) => {
      const made = (hexes: string[]) => hexes.map((hex) => new Color(hex));
      const of = (kinds: Kinds) => made(robotColours(header, kinds, theme));
      const { delay } = header.themes[theme];
      return { task: of("task"), state: of("state"), load: of("load"), delay: made(delay) };
    };
    this.colours = { light: colours("light"), dark: colours("dark") };
  }

  /** Puts all robots where they are; those that stand where they stood are not touched. */
  place(poses: Pose[], placement: Placement): void {
    if (this.placement !== placement) {
      this.placement = placement;
      this.stood.fill(-1);
      this.bodies.reshape(this.shapes[placement.mode].body);
      this.noses.reshape(this.shapes[placement.mode].nose);
    }
    poses.forEach((pose, robot) => {
      const stands = STANDING.has(pose.kind);
      if (stands && this.stood[robot] === pose.row) return;
      this.stood[robot] = stands ? pose.row : -1;
      this.put(robot, pose, placement);
    });
  }

  /** Puts a robot where it is; in the plan above its pod, in space beneath. */
  private put(robot: number, pose: Pose, placement: Placement): void {
    const { x, y, z, shown } = placement.of(pose);
    if (!shown) {
      this.bodies.hide(robot);
      this.noses.hide(robot);
      return;
    }
    const r = this.radius[robot];
    const base = z + (placement.mode === "2d" ? ABOVE_PODS_M : 0);
    const middle = { x, y, z: base + HEIGHT_M / 2 };
    this.bodies.place(robot, middle, { x: r, y: r, z: HEIGHT_M }, pose.heading);
    const size = { x: r, y: r, z: HEIGHT_M + 0.04 };
    this.noses.place(robot, middle, size, pose.heading);
  }

  paint(robot: number, pose: Pose, time_us: number, mode: RobotMode, theme: Theme): void {
    this.bodies.paint(robot, this.colourOf(robot, pose, time_us, mode, theme));
  }

  private colourOf(robot: number, pose: Pose, time_us: number, mode: RobotMode, theme: Theme) {
    const { robots } = this.run;
    const colours = this.colours[theme];
    if (mode === "task") return colours.task[robots.tasks[robot].at(time_us).kind];
    if (mode === "state") return colours.state[robots.state(robot, time_us, pose)];
    if (mode === "load") return colours.load[pose.pod >= 0 ? 1 : 0];
    if (mode === "charge") return amount(robots.levels[robot].at(time_us), theme, this.colour);
    return between(colours.delay, robots.delay_s(robot, time_us) / LONGEST_DELAY_S, this.colour);
  }
}

/** Returns a disc with a mast on which one sees the robot's colour when it is under a pod. */
function masted() {
  const disc = new CylinderGeometry(1, 1, 1, 20);
  const mast = new CylinderGeometry(0.07, 0.07, MAST, 5, 1, true).translate(0, MAST / 2, 0);
  const top = new CylinderGeometry(0.5, 0.5, 0.4, 12).translate(0, MAST, 0);
  return mergeGeometries([disc, mast, top]).rotateX(Math.PI / 2);
}
