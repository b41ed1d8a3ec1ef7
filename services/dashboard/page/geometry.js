// Where things are: the load from positions and swing (docs/equations.md, (2.11)), and the path of a move.

/** Load in the frame that turns with the jib: along the jib, ahead of it, up from the trolley. */
export function loadInJibFrame({ x, cable, radial, tangential }) {
  return {
    along: x - cable * Math.cos(tangential) * Math.sin(radial),
    ahead: cable * Math.sin(tangential),
    up: -cable * Math.cos(tangential) * Math.cos(radial),
  };
}

/** From above, seen with the jib at slew 0 pointing to +east and +slew turning counter-clockwise. */
export function onGround(pose) {
  const { along, ahead } = loadInJibFrame(pose);
  return { east: along * Math.cos(pose.slew) - ahead * Math.sin(pose.slew), north: along * Math.sin(pose.slew) + ahead * Math.cos(pose.slew) };
}

/** Distance travelled after t of a move over `distance` with bounded speed and acceleration (bang-coast-bang). */
function travelled(t, distance, speed, acceleration) {
  const full = Math.abs(distance), peak = Math.min(speed, Math.sqrt(full * acceleration));
  if (full === 0 || !(peak > 0)) return { done: distance, duration: 0 };
  const ramp = peak / acceleration, coast = (full - peak * ramp) / peak, duration = 2 * ramp + coast;
  let s = full;
  if (t < ramp) s = 0.5 * acceleration * t * t;
  else if (t < ramp + coast) s = 0.5 * peak * ramp + peak * (t - ramp);
  else if (t < duration) s = full - 0.5 * acceleration * (duration - t) ** 2;
  return { done: Math.sign(distance) * s, duration };
}

/** Poses of the hanging load on the way to the target. Without a rig file the axes are drawn as if they arrived together. */
export function plannedPath(from, to, rig, points = 48) {
  const keys = ["x", "slew", "cable"];
  const limits = keys.map((key, i) => rig ? [rig.axes[i].reference_speed, rig.axes[i].reference_acceleration] : [Math.abs(to[key] - from[key]), 1e9]);
  const longest = Math.max(...keys.map((key, i) => travelled(0, to[key] - from[key], ...limits[i]).duration));
  const path = [];
  for (let n = 0; n <= points; ++n) {
    const pose = { radial: 0, tangential: 0 };
    keys.forEach((key, i) => { pose[key] = from[key] + travelled(longest * n / points, to[key] - from[key], ...limits[i]).done; });
    path.push(pose);
  }
  return path;
}
