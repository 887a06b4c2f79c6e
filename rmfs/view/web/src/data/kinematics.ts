/**
 * Motion from rest to rest: accelerate, cruise, brake.
 *
 * Over the length L the greatest speed reached is v = min(top speed, sqrt(2 L a d / (a + d))).
 */

export interface RobotKind {
  radius_m: number;
  acceleration_m_s2: number;
  deceleration_m_s2: number;
  top_speed_m_s: number;
  full_turn_s: number;
  pod_transfer_s: number;
}

/** Returns how far a robot has come (m) at `time_s` after the start of a run of `length_m`. */
export function wayAt(
  kind: RobotKind,
  top_speed_m_s: number,
  length_m: number,
  time_s: number,
): number {
  const a = kind.acceleration_m_s2;
  const d = kind.deceleration_m_s2;
  const speed = Math.min(top_speed_m_s, Math.sqrt((2 * length_m * a * d) / (a + d)));
  if (!(speed > 0)) return 0;
  const speeding_s = speed / a;
  if (time_s < speeding_s) return (a / 2) * time_s * time_s;
  const speeding_m = (speed * speed) / (2 * a);
  const braking_m = (speed * speed) / (2 * d);
  const cruising_s = Math.max(length_m - speeding_m - braking_m, 0) / speed;
  if (time_s < speeding_s + cruising_s) return speeding_m + speed * (time_s - speeding_s);
  const left_s = speeding_s + cruising_s + speed / d - time_s;
  return left_s <= 0 ? length_m : length_m - (d / 2) * left_s * left_s;
}

/** Returns the shorter way from one heading to another, in (-pi, pi]. */
export function turn(from_rad: number, to_rad: number): number {
  const full = 2 * Math.PI;
  const difference = (((to_rad - from_rad) % full) + full) % full;
  return difference > Math.PI + 1e-6 ? difference - full : difference;
}
