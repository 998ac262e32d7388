#include "validation/checks.h"

#include <algorithm>

namespace skitter::validation {

// Each is in the check_X.cpp of its stage.
using StageCheck = void(const Setting& setting, const Moment& moment, Judge& judge);
StageCheck checkNavigate;
StageCheck checkAvoid;
StageCheck checkAdapt;
StageCheck checkReact;
StageCheck checkBody, checkBlindBody;
StageCheck checkClip;
StageCheck checkGait, checkLoopGait, checkKeyPoseGait;
StageCheck checkFoothold;
StageCheck checkSwing, checkLoopSwing, checkClipSwing, checkPlantedSwing, checkKeyPoseSwing;
StageCheck checkIk, checkPlantedIk;
StageCheck checkPose, checkClipPose, checkPlantedPose;
StageCheck checkMeasure;
StageCheck checkFootfall;

namespace {

using crowd::StageId;
using enum Controller;

const std::vector<Controller> every(allControllers.begin(), allControllers.end());
const std::vector<Controller> blind = {loop, clip, planted, Controller::keyPoses};

const std::vector<Check> checks = {
    {StageId::navigate, every, checkNavigate},
    {StageId::avoid, every, checkAvoid},
    {StageId::adapt, {adaptive}, checkAdapt, {Record::hurt, Record::search}},
    {StageId::react, {adaptive}, checkReact, {Record::reaction}},
    {StageId::body, {adaptive}, checkBody, {Record::body}},
    {StageId::body, blind, checkBlindBody, {Record::body}},
    {StageId::clip, {clip, planted}, checkClip, {Record::play}},
    {StageId::gait, {adaptive}, checkGait, {Record::gait}},
    {StageId::gait, {loop}, checkLoopGait, {Record::gait}},
    {StageId::gait, {Controller::keyPoses}, checkKeyPoseGait, {Record::gait}},
    {StageId::foothold, {adaptive}, checkFoothold, {Record::step, Record::arc}},
    {StageId::swing, {adaptive}, checkSwing, {Record::foot}},
    {StageId::swing, {loop}, checkLoopSwing, {Record::foot}},
    {StageId::swing, {clip}, checkClipSwing, {Record::foot, Record::chain, Record::tip}},
    {StageId::swing, {planted}, checkPlantedSwing, {Record::step, Record::foot, Record::start}},
    {StageId::swing,
     {Controller::keyPoses},
     checkKeyPoseSwing,
     {Record::foot, Record::chain, Record::tip, Record::spring}},
    {StageId::ik, {adaptive, loop}, checkIk, {Record::chain, Record::tip, Record::miss}},
    {StageId::ik, {planted}, checkPlantedIk, {Record::chain, Record::tip, Record::fix}},
    {StageId::pose, {adaptive, loop, Controller::keyPoses}, checkPose, {Record::pose}},
    {StageId::pose, {clip}, checkClipPose, {Record::pose}},
    {StageId::pose, {planted}, checkPlantedPose, {Record::pose}},
    {StageId::measure, every, checkMeasure},
    {StageId::footfall, every, checkFootfall},
};

}  // namespace

std::vector<const Check*> checksOf(Controller controller, std::span<const StageId> only) {
  const auto has = [](const auto& list, const auto& value) {
    return std::ranges::find(list, value) != list.end();
  };
  std::vector<const Check*> found;
  for (const Check& check : checks)
    if (has(check.of, controller) && (only.empty() || has(only, check.stage))) found.push_back(&check);
  return found;
}

bool isLeftOut(StageId stage, const HerdState& before, const HerdState& after) {
  switch (stage) {
    case StageId::avoid:
      return after.avoid.empty();
    case StageId::adapt:
      return before.search.empty() || after.search.empty();
    case StageId::react:
      return after.reaction.empty();
    case StageId::swing:
      return after.foot.empty();
    case StageId::pose:
      return after.pose.empty();
    case StageId::measure:
      return before.metric.empty() || after.metric.empty();
    case StageId::footfall:
      return !after.footfallsKept;
    default:
      return false;
  }
}

}  // namespace skitter::validation
