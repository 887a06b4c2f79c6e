/** Robots: a disc with a nose, coloured by what is asked. */

import {
  BoxGeometry,
  Color,
  CylinderGeometry,
  Group,
  MeshBasicMaterial,
  MeshLambertMaterial,
} from "three";
import type { Pose } from "../data/motion";
import type { Run } from "../data/run";
import { Instances } from "./instances";
import { amount, LOAD_COLOURS, STATE_COLOURS, TASK_COLOURS, type Theme } from "./palette";
import type { Placement } from "./placement";

export type RobotMode = "task" | "state" | "load" | "delay";

/** A delay of so many seconds, or more, has the strongest colour. */
export const LONGEST_DELAY_S = 120;

const HEIGHT_M = 0.3;
const ABOVE_PODS_M = 0.4;

export class RobotBodies {
  readonly group = new Group();
  readonly bodies: Instances;
  private readonly noses: Instances;
  private readonly radius: Float64Array;
  private readonly colour = new Color();
  private readonly kinds: Record<"task" | "state" | "load", Color[]>;

  constructor(private readonly run: Run) {
    const { robotKind, header } = run.layout;
    this.radius = Float64Array.from(robotKind, (kind) => header.robot_kinds[kind].radius_m);
    const disc = new CylinderGeometry(1, 1, 1, 20).rotateX(Math.PI / 2);
    this.bodies = new Instances(disc, new MeshLambertMaterial(), robotKind.length);
    const nose = new BoxGeometry(1, 0.3, 1).translate(0.5, 0, 0);
    this.noses = new Instances(nose, new MeshBasicMaterial({ color: "#111111" }), robotKind.length);
    this.group.add(this.bodies.mesh, this.noses.mesh);
    const colours = (all: string[]) => all.map((hex) => new Color(hex));
    this.kinds = {
      task: colours(TASK_COLOURS),
      state: colours(STATE_COLOURS),
      load: colours(LOAD_COLOURS),
    };
  }

  /** Puts a robot where it is; in the plan above its pod, in space beneath. */
  place(robot: number, pose: Pose, placement: Placement): void {
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
    if (mode === "task") return this.kinds.task[robots.tasks[robot].at(time_us).kind];
    if (mode === "state") return this.kinds.state[robots.state(robot, time_us, pose)];
    if (mode === "load") return this.kinds.load[pose.pod >= 0 ? 1 : 0];
    return amount(robots.delay_s(robot, time_us) / LONGEST_DELAY_S, theme, this.colour);
  }
}
