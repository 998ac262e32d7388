#pragma once

#include "bench/cpu_crowd/layout.h"
#include "bench/cpu_crowd/rig.h"
#include "skitter/records.h"

namespace skitter::cpu_crowd {

template <class F>
void navigate(const World& world, Agent<F>& a) {
  const shared::Parameters& q = world.q;
  const F x = a.tileX * shared::TILE_SIZE + a.localX, z = a.tileZ * shared::TILE_SIZE + a.localZ;
  const auto isKind = [&](float kind) { return absolute(a.kind - kind) < F(0.5f); };
  const auto given = isKind(shared::GOAL_VELOCITY);
  F dx = a.targetX - select(given, F(0), x), dz = a.targetZ - select(given, F(0), z);
  const auto arrived = isKind(shared::GOAL_CROSS) & (dx * dx + dz * dz < a.arrival * a.arrival);
  if (any(arrived)) {
    const F targetX = a.targetX, targetZ = a.targetZ;
    a.targetX = select(arrived, a.otherX, targetX);
    a.targetZ = select(arrived, a.otherZ, targetZ);
    a.otherX = select(arrived, targetX, a.otherX);
    a.otherZ = select(arrived, targetZ, a.otherZ);
    dx = a.targetX - x;
    dz = a.targetZ - z;
  }
  const F distance = squareRoot(dx * dx + dz * dz);
  const F slowing = select(distance < a.arrival, F(0), smaller(F(1), distance * (1 / q.slowRadius)));
  F speed = a.wantedSpeed * reciprocal(larger(distance, 1e-6f));
  speed = select(isKind(shared::GOAL_POINT), speed * slowing, speed);
  speed = select(given & (distance < a.wantedSpeed), F(1), speed);
  speed = select(isKind(shared::GOAL_NONE), F(0), speed);
  const auto turnedBack = [](const F& v, const F& at, float edge) {
    return select((F(edge) < absolute(at)) & (F(0) < v * at), -v, v);
  };
  a.velocityX = turnedBack(dx * speed, x, q.halfExtentX - q.edgeMargin);
  a.velocityZ = turnedBack(dz * speed, z, q.halfExtentZ - q.edgeMargin);
}

}  // namespace skitter::cpu_crowd
