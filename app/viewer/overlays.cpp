#include "app/viewer/overlays.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cpu_reference/stages/measure.h"

namespace skitter::app {
namespace {

// One meaning, one colour: yellow where a foot will land, green what may be chosen, red what may not or is at
// its limit, blue the way through the air, violet balance.
constexpr ImU32 landingColour = IM_COL32(255, 214, 64, 255);
constexpr ImU32 fitColour = IM_COL32(120, 226, 110, 255);
constexpr ImU32 unfitColour = IM_COL32(240, 86, 70, 255);
constexpr ImU32 rungColour = IM_COL32(255, 255, 255, 90);
constexpr ImU32 boneColour = IM_COL32(250, 250, 245, 235);
constexpr ImU32 swingingColour = IM_COL32(250, 250, 245, 150);
constexpr ImU32 wayColour = IM_COL32(90, 200, 255, 255);
constexpr ImU32 flownColour = IM_COL32(90, 200, 255, 110);
constexpr ImU32 supportColour = IM_COL32(190, 130, 255, 255);
constexpr ImU32 supportFill = IM_COL32(190, 130, 255, 60);
constexpr ImU32 darkColour = IM_COL32(20, 20, 24, 200);

// Draws in the world, as large as the agent is in the picture.
class Pen {
 public:
  Pen(ImDrawList& list, const Lens& lens, const Followed& agent)
      : list_(list),
        lens_(lens),
        scale_(std::clamp(
            agent.legLength() * lens.pixelsAMetre(std::max(lens.depth(agent.middle()), 0.1f)) / 160, 0.3f,
            2.0f)) {}

  float width(float pixels) const { return pixels * scale_; }

  void line(const glm::vec3& a, const glm::vec3& b, ImU32 colour, float pixels) {
    const std::optional<glm::vec2> from = lens_.pixel(a), to = lens_.pixel(b);
    if (from && to) list_.AddLine({from->x, from->y}, {to->x, to->y}, colour, std::max(1.0f, width(pixels)));
  }
  void path(const std::vector<glm::vec3>& points, ImU32 colour, float pixels, bool closed = false) {
    const std::vector<ImVec2> on = pixelsOf(points);
    list_.AddPolyline(on.data(), static_cast<int>(on.size()), colour, closed ? ImDrawFlags_Closed : 0,
                      std::max(1.0f, width(pixels)));
  }
  void fill(const std::vector<glm::vec3>& convex, ImU32 colour) {
    const std::vector<ImVec2> on = pixelsOf(convex);
    list_.AddConvexPolyFilled(on.data(), static_cast<int>(on.size()), colour);
  }
  void dot(const glm::vec3& point, ImU32 colour, float radius) {
    if (const std::optional<glm::vec2> at = lens_.pixel(point))
      list_.AddCircleFilled({at->x, at->y}, std::max(1.2f, width(radius)), colour);
  }
  void ring(const glm::vec3& point, ImU32 colour, float radius, float pixels) {
    if (const std::optional<glm::vec2> at = lens_.pixel(point))
      list_.AddCircle({at->x, at->y}, std::max(2.0f, width(radius)), colour, 0,
                      std::max(1.0f, width(pixels)));
  }

 private:
  // None if one of them is behind the eye.
  std::vector<ImVec2> pixelsOf(const std::vector<glm::vec3>& points) const {
    std::vector<ImVec2> on;
    for (const glm::vec3& point : points) {
      const std::optional<glm::vec2> at = lens_.pixel(point);
      if (!at) return {};
      on.push_back({at->x, at->y});
    }
    return on;
  }

  ImDrawList& list_;
  const Lens& lens_;
  float scale_;
};

// Seen from above, counter-clockwise (Andrew 1979).
std::vector<glm::vec3> hullOf(std::vector<glm::vec3> points) {
  std::sort(points.begin(), points.end(),
            [](const glm::vec3& a, const glm::vec3& b) { return a.x != b.x ? a.x < b.x : a.z < b.z; });
  std::vector<glm::vec3> hull;
  const auto half = [&](auto from, auto to) {
    const size_t least = hull.size() + 1;
    for (auto p = from; p != to; ++p) {
      while (hull.size() > least) {
        const glm::vec3 a = hull[hull.size() - 1] - hull[hull.size() - 2], b = *p - hull[hull.size() - 2];
        if (a.x * b.z - a.z * b.x > 0) break;
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  if (points.size() < 3) return points;
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  return hull;
}

// Green as long as there is room, then to red.
ImU32 colourOf(float used) {
  const float t = std::clamp((used - 0.5f) / 0.5f, 0.0f, 1.0f);
  const auto mixed = [&](int shift) {
    const auto a = static_cast<float>(fitColour >> shift & 255u);
    const auto b = static_cast<float>(unfitColour >> shift & 255u);
    return static_cast<ImU32>(a + t * (b - a)) << shift;
  };
  const auto alpha = static_cast<ImU32>(150 + 100 * t);
  return mixed(IM_COL32_R_SHIFT) | mixed(IM_COL32_G_SHIFT) | mixed(IM_COL32_B_SHIFT) |
         alpha << IM_COL32_A_SHIFT;
}

void drawCone(Pen& pen, const Cone& cone, float slant) {
  const glm::vec3 helper = std::abs(cone.axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 x = glm::normalize(glm::cross(cone.axis, helper)), y = glm::cross(cone.axis, x);
  constexpr int parts = 32;
  std::vector<glm::vec3> rim;
  for (int i = 0; i < parts; ++i) {
    const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / parts;
    rim.push_back(cone.apex + slant * (std::cos(cone.halfAngle) * cone.axis +
                                       std::sin(cone.halfAngle) * (std::cos(turn) * x + std::sin(turn) * y)));
  }
  const ImU32 colour = colourOf(cone.used);
  pen.path(rim, colour, 1.2f, true);
  for (int i = 0; i < parts; i += parts / 4) pen.line(cone.apex, rim[static_cast<size_t>(i)], colour, 0.7f);
}

void drawChain(Pen& pen, const LegView& leg, float legLength) {
  for (const Cone& cone : leg.cones) drawCone(pen, cone, std::min(0.13f * legLength, 0.6f * cone.length));
  pen.path(leg.joints, darkColour, 4.5f);
  pen.path(leg.joints, leg.planted ? boneColour : swingingColour, 2.5f);
  for (const glm::vec3& joint : leg.joints) pen.dot(joint, leg.planted ? boneColour : swingingColour, 3);
}

void drawLadder(Pen& pen, const Ladder& ladder) {
  size_t first = 0;
  for (size_t rung = 1; first < ladder.candidates.size(); ++rung) {
    const size_t count = 2 * rung + 1;
    std::vector<glm::vec3> places;
    for (size_t i = first; i < std::min(first + count, ladder.candidates.size()); ++i)
      places.push_back(ladder.candidates[i].at);
    pen.path(places, rungColour, 1);
    first += count;
  }
  for (const Ladder::Candidate& candidate : ladder.candidates)
    pen.dot(candidate.at, candidate.fits ? fitColour : unfitColour, 2.6f);
}

void drawSpline(Pen& pen, const LegView& leg) {
  if (leg.spline.empty()) return;
  const auto now = static_cast<size_t>(leg.flown * static_cast<float>(leg.spline.size() - 1));
  const auto middle = leg.spline.begin() + static_cast<std::ptrdiff_t>(now);
  pen.path({leg.spline.begin(), middle + 1}, flownColour, 2);
  pen.path({middle, leg.spline.end()}, wayColour, 2.5f);
}

void drawSupport(Pen& pen, const Followed& agent, const Heightfield& ground) {
  std::vector<glm::vec3> planted;
  std::vector<glm::dvec2> seen;
  for (const LegView& leg : agent.legs()) {
    if (!leg.planted) continue;
    planted.push_back(leg.joints.back());
    seen.emplace_back(leg.joints.back().x, leg.joints.back().z);
  }
  if (planted.empty()) return;
  const glm::vec3 middle = agent.middle();
  const bool stable = reference::stabilityMargin(seen, {middle.x, middle.z}) >= 0;
  const ImU32 colour = stable ? supportColour : unfitColour;
  const std::vector<glm::vec3> hull = hullOf(planted);
  pen.fill(hull, supportFill);
  pen.path(hull, colour, 2.5f, true);
  for (const glm::vec3& foot : planted) pen.dot(foot, colour, 4);
  const glm::vec3 below(middle.x, ground.at(middle.x, middle.z), middle.z);
  pen.line(middle, below, colour, 1.5f);
  pen.dot(below, colour, 5);
  pen.dot(below, boneColour, 2.5f);
}

}  // namespace

void Overlays::draw(ImDrawList& list, const Lens& lens, const Followed& agent,
                    const Heightfield& ground) const {
  if (lens.depth(agent.middle()) < 0.1f) return;
  Pen pen(list, lens, agent);
  if (support) drawSupport(pen, agent, ground);
  for (const LegView& leg : agent.legs()) {
    if (chains) drawChain(pen, leg, agent.legLength());
    // The ladder of a finished step would be clutter.
    if (footholds && leg.ladder && !leg.planted) drawLadder(pen, *leg.ladder);
    if (splines) drawSpline(pen, leg);
    if (footholds && leg.landing) {
      pen.ring(*leg.landing, darkColour, 6, 3.5f);
      pen.ring(*leg.landing, landingColour, 6, 2);
    }
    if (splines && !leg.spline.empty()) pen.dot(leg.joints.back(), wayColour, 4.5f);
  }
}

}  // namespace skitter::app
