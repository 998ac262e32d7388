#pragma once

#include "bench/cpu_crowd/ground.h"
#include "skitter/records.h"

namespace skitter::cpu_crowd {

// 4. Sums over ground points for the plane y = mean + b (x - mean.x) + c (z - mean.z).
template <class F>
class PlaneSums {
 public:
  void add(const Vec3<F>& g) {
    sum_ = sum_ + g;
    xx_ = xx_ + g.x * g.x;
    xz_ = xz_ + g.x * g.z;
    zz_ = zz_ + g.z * g.z;
    xy_ = xy_ + g.x * g.y;
    zy_ = zy_ + g.z * g.y;
  }

  struct Plane {
    F slopeX, slopeZ, height;  // the latter at x = z = 0
    F steepness;               // of the ground points, 1 where the body can tilt as they lie
  };
  Plane fit(const shared::Parameters& q, float count) const {
    const Vec3<F> mean = sum_ * (1 / count);
    const F ridge(q.ridge * count);
    const F xx = xx_ - sum_.x * mean.x + ridge, zz = zz_ - sum_.z * mean.z + ridge,
            xz = xz_ - sum_.x * mean.z;
    const F xy = xy_ - sum_.x * mean.y, zy = zy_ - sum_.z * mean.y;
    const F inverse = reciprocal(xx * zz - xz * xz);
    F b = (xy * zz - zy * xz) * inverse, c = (zy * xx - xy * xz) * inverse;
    const F share = smaller(F(1), rsqrt(larger(b * b + c * c, 1e-20f)) * q.maxSlope);
    b = b * share;
    c = c * share;
    return {b, c, mean.y - b * mean.x - c * mean.z, reciprocal(share)};
  }

 private:
  Vec3<F> sum_{F(0), F(0), F(0)};
  F xx_ = F(0), xz_ = F(0), zz_ = F(0), xy_ = F(0), zy_ = F(0);
};

// What the legs tell the body: how far it may follow its desired velocity, and the ground they stand on.
template <class F>
struct Footing {
  F follow = F(1);
  PlaneSums<F> ground;
};

template <class F, int N>
Footing<F> footingOf(const World& world, float tick, const Agent<F>& a, const Leg<F, N>* legs) {
  const shared::Parameters& q = world.q;
  const Mat3<F> r = matrixOf(a.orientation);
  Footing<F> footing;
  for (size_t l = 0; l < world.legs.size(); ++l) {
    const LegModel& model = world.legs[l];
    const Step<F>& step = legs[l].step;
    const F flown = F(tick - 1) - step.firstTick, ticks = absolute(step.ticks);
    const auto planted = ticks <= flown;
    const Vec3<F> landing = relative(step.landing, step, a), liftOff = relative(step.liftOff, step, a);
    const Vec3<F> d = landing - r * broadcast<F>(model.root);
    const auto stretching = d.x * a.velocityX + d.z * a.velocityZ < F(0);
    const float slack = 1 / (q.stretchStop - q.stretchSlow);
    const F room = clamp(F(q.stretchStop * slack) - length(d) * (slack / model.reach), 0, 1);
    const F miss = legs[l].chain.error;
    const F missed = clamp(F(1) - select(F(q.missLeast) < miss, miss, F(0)) * (1 / q.errorStop), 0, 1);
    const F slow = smaller(select(stretching, room, F(1)), missed);
    footing.follow = select(planted, smaller(footing.follow, slow), footing.follow);
    const F u = clamp(flown * reciprocal(ticks), 0, 1);
    footing.ground.add(select(planted, landing, mix(liftOff, landing, u)));
  }
  footing.follow = larger(footing.follow, q.followLeast);
  return footing;
}

// For a body that follows whatever its legs do, the ground below the homes.
template <class F>
Footing<F> blindFootingOf(const World& world, const Agent<F>& a) {
  const Mat3<F> r = matrixOf(a.orientation);
  const F x = a.tileX * shared::TILE_SIZE + a.localX, z = a.tileZ * shared::TILE_SIZE + a.localZ;
  Footing<F> footing;
  for (const LegModel& leg : world.legs) {
    const Vec3<F> home = r * broadcast<F>(leg.home);
    const F height = groundAt(world.terrain, x + home.x, z + home.z).height;
    footing.ground.add({home.x, height - a.y, home.z});
  }
  return footing;
}

template <class F>
Vec3<F> leaningNormal(const shared::Parameters& q, const typename PlaneSums<F>::Plane& plane,
                      const Agent<F>& a) {
  const F lean = clamp(a.speed * a.turnRate * q.leanGain, -q.leanMost, q.leanMost);
  const float level = 1 - q.leanLevel;
  return normalized(
      Vec3<F>{a.heading.z * lean - plane.slopeX * level, F(1), -a.heading.x * lean - plane.slopeZ * level});
}

// From which the body can brake before the terrain's edge.
template <class F>
F speedToEdge(const shared::Parameters& q, const Agent<F>& a) {
  const auto ahead = [](float extent, const F& tile, const F& local, const F& heading) {
    const F tiles = tile * shared::TILE_SIZE;
    const F left = select(heading < F(0), F(extent) + tiles + local, F(extent) - tiles - local);
    return larger(left, F(0)) * reciprocal(larger(absolute(heading), F(1e-6f)));
  };
  const F way = smaller(ahead(q.halfExtentX, a.tileX, a.localX, a.heading.x),
                        ahead(q.halfExtentZ, a.tileZ, a.localZ, a.heading.z));
  const float halfTick = 0.5f * q.dt;
  return way * reciprocal(squareRoot(way * (0.5f / q.braking) + halfTick * halfTick) + halfTick);
}

// The ground below a body that is at (x, z).
template <class F>
struct Underneath {
  F highest;               // below the origin and the ends of the middle line
  F lowest, belly, ahead;  // where the origin may be for what is below it, both ends, and the front end
};

template <class F>
Underneath<F> underneath(const World& world, const F& x, const F& z, const Vec3<F>& normal,
                         const Vec3<F>& forward) {
  const shared::Parameters& q = world.q;
  const Vec3<F> middle = normal * q.bodyHeight, front = forward * q.bodyRadius;
  const F below = groundAt(world.terrain, x, z).height;
  const F behind = groundAt(world.terrain, x + middle.x - front.x, z + middle.z - front.z).height;
  const F ahead = groundAt(world.terrain, x + middle.x + front.x, z + middle.z + front.z).height;
  const F clear = F(q.bellyClearance) - middle.y, forAhead = ahead + clear - front.y;
  return {larger(below, larger(behind, ahead)),
          below + std::max(-q.sinkMost, q.bellyClearance - q.bodyHeight),
          larger(behind + clear + front.y, forAhead), forAhead};
}

// The share of its speed that the ground ahead leaves to a body.
template <class F>
F passable(const shared::Parameters& q, const F& rises) {
  return clamp(
      smaller((F(q.climbMost) - rises) * (2 / q.climbMost), (F(q.gapMost) + rises) * (2 / q.gapMost)), 0, 1);
}

template <class F>
void move(const World& world, const Footing<F>& footing, Agent<F>& a) {
  const shared::Parameters& q = world.q;
  const F follow = footing.follow;
  const auto plane = footing.ground.fit(q, float(world.legs.size()));
  constexpr float steepnessMost = 1.25f;
  const F kept = clamp((F(steepnessMost) - plane.steepness) * (1 / (steepnessMost - 1)), 0, 1);
  const F lost = (F(1) - kept) * (plane.slopeX * a.velocityX + plane.slopeZ * a.velocityZ) *
                 reciprocal(larger(plane.slopeX * plane.slopeX + plane.slopeZ * plane.slopeZ, 1e-20f));
  const F velocityX = a.velocityX - plane.slopeX * lost, velocityZ = a.velocityZ - plane.slopeZ * lost;

  const F commanded = squareRoot(velocityX * velocityX + velocityZ * velocityZ);
  const auto going = F(1e-4f * q.legLength) < commanded;
  const F inverse = reciprocal(larger(commanded, 1e-20f));
  const F wx = select(going, velocityX * inverse, a.heading.x),
          wz = select(going, velocityZ * inverse, a.heading.z);
  const F c = wx * a.heading.z - wz * a.heading.x, d = wx * a.heading.x + wz * a.heading.z;
  const F e = select(F(0) < d, c, select(F(0) <= c, F(1), F(-1)));
  const F rate = clamp(e * q.turnGain, -q.turnRate, q.turnRate) * (follow * 0.75f + 0.25f);
  const float change = q.turnAcceleration * q.dt;
  a.turnRate = a.turnRate + clamp(rate - a.turnRate, -change, change);
  const Vec3<F> turned = Turn<F>(a.turnRate * q.dt)(Vec3<F>{a.heading.x, F(0), a.heading.z});
  const F size = rsqrt(turned.x * turned.x + turned.z * turned.z);
  a.heading.x = turned.x * size;
  a.heading.z = turned.z * size;
  const F speed = follow * commanded * larger(F(0), wx * a.heading.x + wz * a.heading.z);
  a.speed = a.speed + clamp(speed - a.speed, -q.braking * q.dt, q.acceleration * q.dt);
  a.speed = smaller(a.speed, speedToEdge(q, a));

  const F swell = a.phase * (F(1) - a.phase) * 4.0f;
  const F breath = swell * swell * smaller(F(1), a.still * (1 / q.settleTime));
  const Quaternion<F>& o = a.orientation;
  const Vec3<F> up{(o.x * o.y - o.z * o.w) * 2.0f, F(1) - (o.x * o.x + o.z * o.z) * 2.0f,
                   (o.y * o.z + o.x * o.w) * 2.0f};
  const Vec3<F> normal = normalized(mix(up, leaningNormal(q, plane, a), F(q.tiltBlend)));
  const F climb = -(normal.x * a.heading.x + normal.z * a.heading.z) * reciprocal(normal.y);
  const Vec3<F> forward = normalized(Vec3<F>{a.heading.x, climb, a.heading.z});
  const Quaternion<F> orientation = quaternionOf(Mat3<F>{cross(normal, forward), normal, forward});
  const Quaternion<F> opposite{-orientation.x, -orientation.y, -orientation.z, -orientation.w};
  a.orientation = select(dot(orientation, a.orientation) < F(0), opposite, orientation);

  F movedX = a.heading.x * (a.speed * q.dt), movedZ = a.heading.z * (a.speed * q.dt);
  const auto look = [&] {
    return underneath(world, a.tileX * shared::TILE_SIZE + (a.localX + movedX),
                      a.tileZ * shared::TILE_SIZE + (a.localZ + movedZ), normal, forward);
  };
  Underneath<F> ground = look();
  F rise = plane.slopeX * movedX + plane.slopeZ * movedZ;
  const F passes = passable(q, ground.ahead - (a.y + plane.height + rise));
  if (any(passes < F(1))) {
    const F share =
        select(passes < F(1),
               clamp(passes * commanded * reciprocal(larger(a.speed, 1e-6f * q.legLength)), 0, 1), F(1));
    a.speed = a.speed * share;
    movedX = movedX * share;
    movedZ = movedZ * share;
    ground = look();
    rise = plane.slopeX * movedX + plane.slopeZ * movedZ;
  }
  const F planeHeight = a.y + plane.height + rise;
  const F belly = smaller(ground.belly, planeHeight + q.climbMost);
  const F height = larger(planeHeight + breath * q.breathHeight, larger(ground.lowest, belly));
  a.y = smaller(larger(mix(a.y + rise, height, F(q.heightBlend)), ground.lowest - 0.5f * q.sinkMost),
                ground.highest + q.riseMost);

  const auto advance = [](F& local, F& tile, const F& by) {
    const F to = local + by, crossed = roundDown(to * (1 / shared::TILE_SIZE));
    tile = tile + crossed;
    local = to - crossed * shared::TILE_SIZE;
  };
  advance(a.localX, a.tileX, movedX);
  advance(a.localZ, a.tileZ, movedZ);

  a.surfaceSpeed = a.speed * rsqrt(larger(forward.x * forward.x + forward.z * forward.z, 1e-20f));
  const F slow(1e-2f * q.legLength);
  const auto still = (commanded < slow) & (a.speed < slow) & (absolute(a.turnRate) < F(1e-2f));
  a.still = select(still, a.still + q.dt, F(0));
  a.follow = follow * passes;
}

template <class F, int N>
[[gnu::flatten]] void body(const World& world, float tick, Agent<F>& a, const Leg<F, N>* legs) {
  move(world, footingOf(world, tick, a, legs), a);
}

template <class F>
[[gnu::flatten]] void blindBody(const World& world, Agent<F>& a) {
  move(world, blindFootingOf(world, a), a);
}

}  // namespace skitter::cpu_crowd
