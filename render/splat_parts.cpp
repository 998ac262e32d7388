#include "render/splat_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/ribbons.h"

namespace skitter::render {
namespace {

constexpr size_t kBalls = 12;  // of a body
constexpr int kRounds = 8;     // of Lloyd's

// A triangle of the body, as a point that weighs its area.
struct Piece {
  glm::vec3 middle, colour;
  float area;
};

struct Ball {
  glm::vec3 middle{0}, colour{0};
  float area = 0, radius = 0;
};

std::vector<Piece> piecesOf(const Rig& rig, const std::vector<uint32_t>& triangles) {
  std::vector<Piece> pieces;
  for (size_t i = 0; i < triangles.size(); i += 3) {
    const SkinVertex &a = rig.vertices[triangles[i]], &b = rig.vertices[triangles[i + 1]],
                     &c = rig.vertices[triangles[i + 2]];
    pieces.push_back({(a.position + b.position + c.position) / 3.0f, (a.colour + b.colour + c.colour) / 3.0f,
                      0.5f * glm::length(glm::cross(b.position - a.position, c.position - a.position))});
  }
  return pieces;
}

size_t nearestTo(const std::vector<Ball>& balls, const glm::vec3& point) {
  return size_t(std::ranges::min_element(
                    balls, {}, [&](const Ball& ball) { return glm::distance(ball.middle, point); }) -
                balls.begin());
}

// Each the furthest piece from those before it.
std::vector<Ball> seeds(const std::vector<Piece>& pieces) {
  std::vector<Ball> balls;
  while (balls.size() < std::min(kBalls, pieces.size())) {
    const auto furthest = std::ranges::max_element(pieces, {}, [&](const Piece& piece) {
      return balls.empty() ? piece.area
                           : glm::distance(balls[nearestTo(balls, piece.middle)].middle, piece.middle);
    });
    balls.push_back({.middle = furthest->middle});
  }
  return balls;
}

// k-means of the surface (Lloyd 1982). A ball has the area of its share: balls along a limb are as wide as
// the limb.
std::vector<Ball> ballsOf(const std::vector<Piece>& pieces) {
  std::vector<Ball> balls = seeds(pieces);
  for (int round = 0; round < kRounds && !balls.empty(); ++round) {
    std::vector<Ball> sums(balls.size());
    for (const Piece& piece : pieces) {
      Ball& sum = sums[nearestTo(balls, piece.middle)];
      sum.middle += piece.area * piece.middle;
      sum.colour += piece.area * piece.colour;
      sum.area += piece.area;
    }
    std::erase_if(sums, [](const Ball& ball) { return ball.area <= 0; });
    for (Ball& ball : sums) ball.middle /= ball.area, ball.colour /= ball.area;
    balls = std::move(sums);
  }
  for (Ball& ball : balls) ball.radius = std::sqrt(ball.area / (4 * std::numbers::pi_v<float>));
  return balls;
}

glm::vec4 endOf(const Ribbon::End& end) { return {end.along * end.direction, end.radius}; }
glm::vec4 colourOf(const Ribbon::End& end) { return {end.colour, float(end.bone)}; }

}  // namespace

std::vector<shared::SplatPart> splatPartsOf(const Rig& rig, float bend) {
  std::vector<shared::SplatPart> parts;
  if (rig.indices.empty()) return parts;
  const Ribbons legs = ribbonsOf(rig, std::numeric_limits<float>::max(), bend, false);
  for (const Ribbon& leg : legs.ribbons)
    parts.push_back({endOf(leg.from), endOf(leg.to), colourOf(leg.from), colourOf(leg.to)});
  // The body is the palette's first entry.
  const glm::vec3 start = rig.restStarts().front();
  for (const Ball& ball : ballsOf(piecesOf(rig, legs.others))) {
    const glm::vec4 end(ball.middle - start, ball.radius), colour(ball.colour, 0);
    parts.push_back({end, end, colour, colour});
  }
  return parts;
}

}  // namespace skitter::render
