#pragma once

#include "assets/rigs/body_plan.h"
#include "skitter/rig_setup.h"

namespace skitter {

// Joints with skin that are no joints of a leg and below none, but rest on a leg: heels, rolls, twists. Each
// follows the bone that it rests on.
std::vector<RigSetup::Follower> findFollowers(const BodyPlan& plan);

}  // namespace skitter
