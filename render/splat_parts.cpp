#include "render/splat_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
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
  uint16_t entry;  // of the palette
};

struct Ball {
  glm::vec3 middle{0}, colour{0};
  float area = 0, radius = 0;
  std::map<uint16_t, float> areas = {};  // by entry of the palette
};

// A triangle goes with its first vertex that hangs on the body.
std::vector<Piece> piecesOf(const Limbs& limbs, const std::vector<uint32_t>& triangles) {
  const std::vector<SkinVertex>& vertices = limbs.rig.vertices;
  std::vector<Piece> pieces;
  for (auto corner = triangles.begin(); corner != triangles.end(); corner += 3) {
    const SkinVertex &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
    const uint32_t first =
        *std::find_if(corner, corner + 2, [&](uint32_t v) { return heaviestBone(vertices[v]) == 0; });
    pieces.push_back({(a.position + b.position + c.position) / 3.0f, (a.colour + b.colour + c.colour) / 3.0f,
                      0.5f * glm::length(glm::cross(b.position - a.position, c.position - a.position)),
                      limbs.entries[first]});
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
      sum.areas[piece.entry] += piece.area;
    }
    std::erase_if(sums, [](const Ball& ball) { return ball.area <= 0; });
    for (Ball& ball : sums) ball.middle /= ball.area, ball.colour /= ball.area;
    balls = std::move(sums);
  }
  for (Ball& ball : balls) ball.radius = std::sqrt(ball.area / (4 * std::numbers::pi_v<float>));
  return balls;
}

// The entry that carries most of a ball.
uint16_t entryOf(const Ball& ball) {
  return std::ranges::max_element(ball.areas, {}, [](const auto& entry) { return entry.second; })->first;
}

}  // namespace

std::vector<shared::SplatPart> splatPartsOf(const Limbs& limbs, float bend) {
  std::vector<shared::SplatPart> parts;
  if (limbs.rig.indices.empty()) return parts;
  const Ribbons legs = ribbonsOf(limbs.rig, std::numeric_limits<float>::max(), bend, false);
  const auto place = [&](const Ribbon::End& end) { return glm::vec4(limbs.placeOf(end), end.radius); };
  const auto colour = [&](const Ribbon::End& end) {
    return glm::vec4(end.colour, float(limbs.carriers[end.bone].entry));
  };
  for (const Ribbon& leg : legs.ribbons)
    parts.push_back({place(leg.from), place(leg.to), colour(leg.from), colour(leg.to)});
  // A rig's body starts at the origin, as all entries of matrices do.
  for (const Ball& ball : ballsOf(piecesOf(limbs, legs.others))) {
    const glm::vec4 middle(ball.middle, ball.radius), own(ball.colour, float(entryOf(ball)));
    parts.push_back({middle, middle, own, own});
  }
  return parts;
}

}  // namespace skitter::render
