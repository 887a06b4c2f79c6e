/** One run on its canvas: brings the drawn bodies to the state and time that are asked for. */

import { Mesh, MeshBasicMaterial, RingGeometry } from "three";
import { newPose, type Pose } from "../data/motion";
import type { Run } from "../data/run";
import { Floor } from "../draw/floor";
import { HeatSquares, type Range } from "../draw/heat";
import { Paths } from "../draw/paths";
import { Placement } from "../draw/placement";
import { PodBodies } from "../draw/pods";
import { RobotBodies } from "../draw/robots";
import { Stage } from "../draw/stage";
import { h } from "./dom";
import type { Chosen, Selection, Store, ViewState } from "./state";

/** Robots change colour seldom: it is looked up anew after so much wall time, or a jump. */
const REPAINT_MS = 200;
const HIT_M = 1.5;
/** A click that moved further was a drag of the camera. */
const DRAGGED_PX = 4;

export class Pane {
  readonly root: HTMLElement;
  readonly stage: Stage;
  readonly poses: Pose[];
  placement: Placement;
  /** What the heat map shows, if it does. */
  counts: Float64Array | undefined;
  private floor: Floor;
  private readonly robots: RobotBodies;
  private readonly pods: PodBodies;
  private readonly heat: HeatSquares;
  private readonly paths: Paths;
  private readonly ring: Mesh;
  private pressed = [0, 0];
  private painted_ms = Number.NEGATIVE_INFINITY;

  constructor(
    readonly run: Run,
    private readonly number: number,
    private readonly store: Store,
    caption: string,
    private readonly changed: () => void,
  ) {
    const canvas = h("canvas", { tabIndex: 0, ariaLabel: `warehouse of ${caption}` });
    this.root = h(
      "div",
      { className: "pane" },
      canvas,
      h("div", { className: "caption" }, caption),
    );
    this.stage = new Stage(canvas, changed);
    this.poses = Array.from({ length: run.motion.robots }, newPose);
    this.robots = new RobotBodies(run);
    this.pods = new PodBodies(run);
    this.heat = new HeatSquares(run);
    this.paths = new Paths(run, "#D55E00");
    this.ring = new Mesh(
      new RingGeometry(0.62, 0.8, 40),
      new MeshBasicMaterial({ color: "#E6007E", depthTest: false, transparent: true }),
    );
    this.ring.renderOrder = 9;
    const { mode, tier, theme } = store.state;
    this.placement = new Placement(run.layout, mode, tier);
    this.floor = new Floor(run.layout, theme);
    this.stage.scene.add(this.robots.group, this.pods.bodies.mesh, this.paths.lines, this.ring);
    this.dress();
    this.arrange();
    store.listen((names) => this.react(names));
    canvas.addEventListener("pointerdown", ({ clientX, clientY }) => {
      this.pressed = [clientX, clientY];
    });
    canvas.addEventListener("click", (event) => this.click(event));
    new ResizeObserver(() => {
      this.stage.resize(this.root.clientWidth, this.root.clientHeight);
      changed();
    }).observe(this.root);
  }

  /** Draws the heat map of counts on a scale that runs side by side share. */
  showHeat(range: Range): void {
    const { heat, theme } = this.store.state;
    this.heat.squares.mesh.visible = heat !== "off";
    if (this.counts !== undefined) this.heat.draw(this.counts, range, this.placement, theme);
    this.stage.relay();
  }

  /** Looks colours up anew in the next frame. */
  repaint(): void {
    this.painted_ms = Number.NEGATIVE_INFINITY;
  }

  frame(now_ms: number): void {
    const { state } = this.store;
    const time_us = state.time_s * 1e6;
    const paint = now_ms - this.painted_ms > REPAINT_MS;
    this.poses.forEach((pose, robot) => {
      this.run.motion.pose(robot, time_us, pose);
    });
    this.robots.place(this.poses, this.placement);
    this.pods.place(time_us, this.poses, this.placement);
    const all = this.painted_ms === Number.NEGATIVE_INFINITY;
    this.pods.paint(time_us, state.pods, state.theme, all);
    if (paint) {
      this.poses.forEach((pose, robot) => {
        this.robots.paint(robot, pose, time_us, state.robots, state.theme);
      });
      this.painted_ms = now_ms;
    }
    this.drawPaths(state, time_us);
    this.floor.scaleLabels(this.stage.pixel_m);
    this.mark(state.selection, time_us);
    this.stage.render();
  }

  private react(names: ReadonlySet<keyof ViewState>): void {
    if (names.has("theme")) this.dress();
    if (names.has("mode") || names.has("tier")) this.arrange();
    if (names.has("heat")) this.shapePods();
    if (names.has("zones")) {
      this.floor.showZones(this.store.state.zones);
      this.stage.relay();
    }
    if (["theme", "pods", "robots", "playing"].some((name) => names.has(name as keyof ViewState)))
      this.repaint();
    this.changed();
  }

  private dress(): void {
    const { theme, zones } = this.store.state;
    this.floor = new Floor(this.run.layout, theme);
    this.floor.arrange(this.placement);
    this.floor.showZones(zones);
    this.stage.lay(this.floor.group, this.heat.squares.mesh);
    this.stage.setTheme(theme);
  }

  private arrange(): void {
    const { mode, tier } = this.store.state;
    this.placement = new Placement(this.run.layout, mode, tier);
    this.floor.arrange(this.placement);
    this.stage.relay();
    this.shapePods();
    this.stage.overlook(this.placement);
  }

  private shapePods(): void {
    const { mode, heat } = this.store.state;
    this.pods.shape(mode, heat !== "off");
  }

  private drawPaths(state: ViewState, time_us: number): void {
    this.paths.clear();
    const { selection } = state;
    const chosen = this.isHere(selection) && selection?.what === "robot" ? selection.index : -1;
    this.poses.forEach((pose, robot) => {
      if (state.paths || robot === chosen) this.paths.add(robot, pose, time_us, this.placement);
    });
    this.paths.finish();
  }

  private mark(selection: Selection | null, time_us: number): void {
    this.ring.visible = selection !== null && this.isHere(selection);
    if (selection === null || !this.ring.visible) return;
    const { x, y, z, shown } = this.whereIs(selection, time_us);
    this.ring.visible = shown;
    this.ring.position.set(x, y, z + (this.placement.mode === "2d" ? 1 : 0.05));
    if (this.store.state.follow && selection.what !== "station") this.stage.follow(x, y, z);
  }

  private isHere(selection: Selection | null): boolean {
    return selection?.run === this.number;
  }

  private whereIs(selection: Selection, time_us: number) {
    const { layout, places } = this.run;
    if (selection.what === "robot") return this.placement.of(this.poses[selection.index]);
    let waypoint: number;
    if (selection.what === "pod") {
      const where = places.of[selection.index].at(time_us);
      if (where < 0) return this.placement.of(this.poses[-1 - where]);
      waypoint = where;
    } else waypoint = layout.header.stations[selection.index].waypoint;
    const tier = layout.tier[waypoint];
    return {
      x: layout.x[waypoint] + this.placement.x[tier],
      y: layout.y[waypoint],
      z: this.placement.z[tier],
      shown: this.placement.shown[tier],
    };
  }

  private click(event: MouseEvent): void {
    const [x, y] = this.pressed;
    if (Math.hypot(event.clientX - x, event.clientY - y) > DRAGGED_PX) return;
    const hit = this.pick(event.clientX, event.clientY);
    this.store.set({ selection: hit });
  }

  /** Returns what is at a point of the page: a robot before a station before a pod. */
  private pick(clientX: number, clientY: number): Selection | null {
    const caster = this.stage.ray(clientX, clientY);
    const hits: { what: Chosen; index: number; away: number; rank: number }[] = [];
    const bodies = [
      { what: "robot", drawn: this.robots.bodies },
      { what: "pod", drawn: this.pods.bodies },
    ] as const;
    for (const { what, drawn } of bodies) {
      const struck = drawn.struck(caster);
      if (struck !== undefined) hits.push({ what, ...struck, rank: what === "robot" ? 0 : 2 });
    }
    const [station] = caster.intersectObjects(this.floor.stations, false);
    if (station !== undefined) {
      const index = this.floor.stations.indexOf(station.object as Mesh);
      hits.push({ what: "station", index, away: station.distance, rank: 1 });
    }
    const nearest = Math.min(...hits.map(({ away }) => away));
    const near = hits.filter(({ away }) => away < nearest + HIT_M);
    near.sort((a, b) => a.rank - b.rank);
    return near.length === 0
      ? null
      : { run: this.number, what: near[0].what, index: near[0].index };
  }
}
