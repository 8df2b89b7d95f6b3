// The pose of each moving part at a moment of play. The same as drawing/poses.py and drawing/moving.py.

const OPENED = 0.6, BULGE = 0.1, SPIN_POSES = 12;

/** Rounded as in Python: a half goes to the even neighbour. */
export function round(number) {
  const low = Math.floor(number), rest = number - low;
  if (rest === 0.5) return low % 2 === 0 ? low : low + 1;
  return rest < 0.5 ? low : low + 1;
}

function clamp(number, least, greatest) {
  return Math.min(Math.max(number, least), greatest);
}

/** The pose of a part; null if nothing of it is drawn. */
export function poseOf(part, world, balls, effects, time) {
  const last = part.poses - 1;
  switch (part.motion) {
    case "turning": {
      const share = (world.angle(part.number) - part.rest) / (part.up - part.rest);
      return clamp(round(share * last), 0, last);
    }
    case "spinning": {
      const turn = round((bladeAngle(part, world, time) / Math.PI) * SPIN_POSES) % SPIN_POSES;
      return (turn + SPIN_POSES) % SPIN_POSES;
    }
    case "pulled":
      return clamp(round((world.launchHeld / part.charge) * last), 0, last);
    case "standing":
      return world.isOff(part.switch) ? null : 0;
    case "hanging":
      if (world.isOff(part.switch)) return last;
      return clamp(round(opening(part, balls, effects.radius) * last), 0, last);
    default: {
      const kick = effects.kick(part.part, time);
      if (kick === null || time - kick.time > BULGE) return null;
      return isOnRight(part, kick.x, kick.z) ? 0 : 1;
    }
  }
}

function bladeAngle(part, world, time) {
  const blade = world.blade(part.number), elapsed = Math.max(time - blade.time, 0), { damping } = part;
  return blade.angle + blade.speed * (damping > 0 ? -Math.expm1(-damping * elapsed) / damping : elapsed);
}

function opening(part, balls, radius) {
  const [[x0, z0], [x1, z1]] = part.points, length = Math.hypot(x1 - x0, z1 - z0);
  const alongX = (x1 - x0) / length, alongZ = (z1 - z0) / length;
  let open = 0;
  for (const ball of balls) {
    const dx = ball.x - x0, dz = ball.z - z0, along = dx * alongX + dz * alongZ;
    if (part.levels.includes(ball.level) && 0 < along && along < length) {
      open = Math.max(open, (radius - Math.abs(dx * alongZ - dz * alongX)) / (OPENED * radius));
    }
  }
  return Math.min(open, 1);
}

function isOnRight(part, x, z) {
  const [[x0, z0], [x1, z1]] = part.points;
  return (x1 - x0) * (z - z0) - (z1 - z0) * (x - x0) > 0;
}
