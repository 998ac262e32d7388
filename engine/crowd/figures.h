#pragma once

#include "skitter/crowd.h"

namespace skitter::crowd {

// visit(name, value) for each figure, by its name in files of figures.
template <typename Visit>
void eachFigure(const Fidelity& f, Visit&& visit) {
  visit("agentTicks", f.agentTicks);
  visit("stances", f.stances);
  visit("slip", f.slip);
  visit("skating", f.skating);
  visit("penetration", f.penetration);
  visit("penetrationBeyond", f.penetrationBeyond);
  visit("float", f.floating);
  visit("floatBeyond", f.floatingBeyond);
  visit("segmentPenetration", f.segmentPenetration);
  visit("segmentPenetrationMost", f.segmentPenetrationMost);
  visit("crossing", f.crossing);
  visit("reachErrorP99", f.reachErrorP99);
  visit("reachErrorMost", f.reachErrorMost);
  visit("limitViolation", f.limitViolation);
  visit("limitViolations", f.limitViolations);
  visit("footJerk", f.footJerk);
  visit("bodyJerk", f.bodyJerk);
  visit("margin", f.margin);
  visit("marginLeast", f.marginLeast);
  visit("unstable", f.unstable);
  visit("lastResorts", f.lastResorts);
  visit("notFinite", f.notFinite);
}

}  // namespace skitter::crowd
