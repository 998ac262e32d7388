#include "bench/cpu_baseline/verify.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace skitter::baseline {
namespace {

using DVec = Vec3<double>;

double norm(const DVec& v) { return std::sqrt(dot(v, v)); }

// A difference that is not a number is as wrong as can be.
void worsen(double& worst, double value) {
  worst = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(worst, value);
}

DVec vectorAt(const Rows& rows, int first, size_t chain) {
  return {rows.at(first, chain), rows.at(first + 1, chain), rows.at(first + 2, chain)};
}

Pose poseOf(const Batch& batch, size_t chain) {
  Pose pose;
  for (int i = 0; 3 * i < batch.pose.rows(); ++i) {
    pose.x[i] = batch.pose.at(3 * i, chain);
    pose.y[i] = batch.pose.at(3 * i + 1, chain);
    pose.twist[i] = batch.pose.at(3 * i + 2, chain);
  }
  return pose;
}

double beyondRange(double angle, double low, double high) {
  return std::max({0.0, low - angle, angle - high});
}

double beyondLimit(const Limit& limit, double x, double y, double tanHalfTwist) {
  if (limit.kind == LimitKind::hinge) {
    return std::max(std::abs(x), beyondRange(-2 * std::atan(y), limit.low, limit.high));
  }
  const double s = std::hypot(x, y), hx = s > 0 ? x / s : 1, hy = s > 0 ? y / s : 0;
  double most = 3.1;
  if (limit.kind == LimitKind::cone) most = std::min<double>(limit.cone, most);
  if (limit.kind == LimitKind::ellipse) {
    most = 1 / std::hypot(hx / (hx >= 0 ? limit.positiveX : limit.negativeX),
                          hy / (hy >= 0 ? limit.positiveY : limit.negativeY));
  }
  return std::max(beyondRange(2 * std::atan(s), 0, most),
                  beyondRange(2 * std::atan(tanHalfTwist), limit.twistLow, limit.twistHigh));
}

bool stopFits(Stop stop, double error, const Options& options) {
  return (stop == Stop::tolerance) == (error <= options.tolerance);
}

}  // namespace

std::string describe(const Findings& findings) {
  char text[256];
  std::snprintf(text, sizeof text, "error %.2g, length %.2g, joints %.2g, limit %.2g rad, wrong stops %zu",
                findings.error, findings.length, findings.joints, findings.limit, findings.wrongStops);
  return text;
}

Findings verify(const Chain& chain, const Options& options, const Batch& batch) {
  Findings findings;
  const int bones = int(chain.bones.size());
  double total = 0;
  for (const Bone& bone : chain.bones) total += bone.length;
  for (size_t i = 0; i < batch.chains; ++i) {
    if (batch.stop(i) == Stop::skipped) {
      ++findings.skipped;
      continue;
    }
    DVec last{0, 0, 0};
    for (int b = 0; b < bones; ++b) {
      const DVec joint = vectorAt(batch.joints, 3 * b, i);
      worsen(findings.length, std::abs(norm(joint - last) - chain.bones[b].length / total));
      last = joint;
    }
    worsen(findings.error, std::abs(norm(vectorAt(batch.target, 0, i) - last) - batch.error(i)));
    if (!stopFits(batch.stop(i), batch.error(i), options)) ++findings.wrongStops;
    if (batch.stop(i) == Stop::tolerance) ++findings.reached;
    findings.iterations += batch.iterations(i);
    if (batch.pose.rows() == 0) continue;
    const Pose pose = poseOf(batch, i);
    const std::vector<DVec> joints = jointsOf(chain, pose);
    for (int b = 0; b < bones; ++b) {
      worsen(findings.joints, norm(joints[b] - vectorAt(batch.joints, 3 * b, i)));
      worsen(findings.limit, beyondLimit(chain.bones[b].limit, pose.x[b], pose.y[b], pose.twist[b]));
    }
  }
  findings.iterations /= std::max<double>(1, batch.chains - findings.skipped);
  return findings;
}

}  // namespace skitter::baseline
