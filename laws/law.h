#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

// The laws of the visible world: what must hold of what a person sees, whatever computed it. They are judged
// from drawn skin, the ground and the clock alone. This folder includes nothing of the engine.
namespace skitter::laws {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// Every law, once: LAW(name, text, unit, least, most, share, under, over, measured, reason, source). Names,
// bounds, warnings, JSON, the cases of `skitter validate` and the table in docs/laws.md follow from a row.
//   least, most   the values that keep the law
//   share         of an agent's herd's samples that may break it: 0, or 0.01 where the 99th percentile counts
//   under, over   what agents do that break it, after "36 of 36 agents"; empty where nothing is on that side
// clang-format off
#define SKITTER_LAWS(LAW) \
  LAW(grounded, "grounded", "leg lengths", -0.2, 1.2, 0, \
      "sank into the ground", "left the ground", \
      "height of the body's origin over the highest ground below its footprint, or below the lowest", \
      "the origin rests at height 0; no foot of a body that is 1.2 legs up reaches the ground, and one that is 0.2 legs down wades in it", \
      "the bounds of [body](stages/body.md#bounds)") \
  LAW(soleSlide, "sole-slide", "leg lengths a stance", -unbounded, 0.02, 0.01, \
      "", "slide on standing feet", \
      "way of the skin of a sole over the ground, from touchdown to the end of a stance or, if it is longer, to any time between", \
      "2 % of a leg is 1.8 cm of a person; viewers notice slides of about 2 cm", \
      "Prazak, Hoyet and O'Sullivan 2011, Perceptual evaluation of footskate cleanup") \
  LAW(soleDepth, "sole-depth", "leg lengths", -unbounded, 0.02, 0.01, \
      "", "stand with their soles in the ground", \
      "depth of the deepest vertex of a standing foot below the ground, square to it; the median over a stance", \
      "as much as a sole may slide; at both ends of a stance a stiff foot rolls over its edge and is deeper than amid it", \
      "the dead zone of [measure](stages/measure.md#figures) is 0.005") \
  LAW(soleAir, "sole-air", "leg lengths", -unbounded, 0.02, 0.01, \
      "", "stand on air", \
      "gap between the lowest vertex of a standing foot and the ground, square to it; the median over a stance", \
      "as much as a sole may be deep", \
      "the dead zone of [measure](stages/measure.md#figures) is 0.005") \
  LAW(bodyDepth, "body-depth", "leg lengths", -unbounded, 0.02, 0.01, \
      "", "have their bodies in the ground", \
      "depth of the deepest vertex of the body, which no leg moves, below the ground, square to it", \
      "what shows at a sole shows at a belly", \
      "as sole-depth") \
  LAW(knees, "knees", "flips a minute", -unbounded, 0, 0, \
      "", "bend a joint to the wrong side", \
      "how often a joint that is bent by 25 degrees or more at rest comes to bend the other way by more than 10, in the frame of the bone before it", \
      "a joint is built for one side; beyond 5 degrees of overextension a knee counts as ill, and none should reach 10. Who bends less than 25 degrees at rest shows no side: `skitter rig` bends straight legs by 40", \
      "genu recurvatum, Loudon et al. 1998; [rig](rig.md)") \
  LAW(upright, "upright", "degrees", -unbounded, 30, 0.01, \
      "", "do not keep upright", \
      "angle from the body's up axis to the nearest direction between the vertical and the mean normal of the ground below its footprint", \
      "a body that leans so far from what carries it has its centre over the edge of its feet, half of whose track is about 0.6 of the centre's height", \
      "static stability, McGhee and Frank 1968") \
  LAW(stretch, "stretch", "leg lengths", -unbounded, 0.15, 0, \
      "", "have torn skin", \
      "how much longer an edge of the skin is than at rest, where its ends follow different bones", \
      "skin around a joint of radius r that bends by a right angle is longer by 1.4 r, and limbs are a tenth of a leg thick at most", \
      "geometry of linear blend skinning") \
  LAW(facing, "facing", "degrees", -unbounded, 20, 0.01, \
      "", "do not face the way they go", \
      "angle between the way that the body went in half a second, a tenth of a leg or more, and the model's forward", \
      "at 20 degrees a third of the way goes sideways; a model whose forward is 25 degrees askew must be told", \
      "sine of the angle") \
  LAW(progress, "progress", "of the speed asked for", 0.9, 1.1, 0.01, \
      "are slower than asked with nothing in the way", "are faster than asked", \
      "speed over the ground in half a second or more, over the speed asked for; only where that speed and the heading stay, the ground about the feet is less steep than 35 degrees, and nobody and nothing is near", \
      "viewers tell walkers apart whose speeds differ by 0.5 km/h, a tenth of a usual pace", \
      "Jacobs and Shiffrar 2005, Walking perception by walking observers") \
  LAW(jerk, "jerk", "normalised", -unbounded, 6500, 0.01, \
      "", "move by jerks", \
      "T^5 integral(jerk^2) dt / path^2 of the body's origin over windows of 0.4 s and of soles over each swing but the first ones from rest, means over the time of a look weighted by path^2", \
      "the smoothest motion has 720, and more than 6,500 counts as jerky", \
      "Teulings et al. 1997; [measure](stages/measure.md#figures)") \
  LAW(apart, "apart", "leg lengths", -unbounded, 0.05, 0, \
      "", "are in each other", \
      "how far the body of another agent would have to move to leave an agent's own, along the line between them or the normals of 13 pairs of planes about either", \
      "between two of these directions a body is up to a twentieth of a leg narrower than it seems", \
      "discrete oriented polytopes, Klosowski et al. 1998") \
  LAW(crossing, "crossing", "seconds", -unbounded, 0.1, 0, \
      "", "have their own legs through each other", \
      "time for which bones of two legs are nearer than half of the thickness of their skin", \
      "what lasts for less than a tenth of a second is not seen as an event of its own", \
      "this project")
// clang-format on

enum class Law : uint8_t {
#define SKITTER_LAW(name, ...) name,
  SKITTER_LAWS(SKITTER_LAW)
#undef SKITTER_LAW
};

struct Bound {
  double least = -unbounded, most = unbounded;

  bool isKept(double value) const { return value >= least && value <= most; }
};

struct LawInfo {
  Law law;
  const char *name, *unit;
  Bound bound;
  double share;
  const char *under, *over, *measured, *reason, *source;
};

inline constexpr std::array lawTable = {
#define SKITTER_LAW(name, text, unit, least, most, ...) \
  LawInfo{Law::name, text, unit, {least, most}, __VA_ARGS__},
    SKITTER_LAWS(SKITTER_LAW)
#undef SKITTER_LAW
};
inline constexpr size_t lawCount = lawTable.size();

constexpr const LawInfo& infoOf(Law law) { return lawTable[static_cast<size_t>(law)]; }
constexpr const char* nameOf(Law law) { return infoOf(law).name; }

// What a controller cannot keep, and the bound that it can.
struct Exception {
  std::string_view controller;  // as users name it
  Law law;
  Bound bound;
  const char* reason;
};
inline constexpr const char* blindFeet =
    "its feet follow the plane of the ground below the homes, and no bump of it";
// Bounds are a quarter over what spiders have on everest (docs/laws.md).
inline constexpr std::array exceptions = {
    Exception{"clip", Law::soleSlide, {-unbounded, 0.12}, "its feet go as they do in the clip"},
    Exception{"clip", Law::soleDepth, {-unbounded, 0.13}, blindFeet},
    Exception{"clip", Law::soleAir, {-unbounded, 0.13}, blindFeet},
    Exception{"planted", Law::crossing, {-unbounded, 0.2}, "its legs cross as they do in the clip"},
    Exception{"loop",
              Law::soleSlide,
              {-unbounded, 0.16},
              "a foot on a fixed loop goes back at one speed, whatever the body does"},
    Exception{"loop", Law::soleDepth, {-unbounded, 0.13}, blindFeet},
    Exception{"loop", Law::soleAir, {-unbounded, 0.13}, blindFeet},
    Exception{
        "key-poses", Law::soleSlide, {-unbounded, 0.16}, "its feet go from pose to pose, and lag behind"},
    Exception{"key-poses", Law::soleDepth, {-unbounded, 0.13}, blindFeet},
    Exception{"key-poses", Law::soleAir, {-unbounded, 0.13}, blindFeet},
};

// The bound of a law for a herd with that controller.
constexpr Bound boundOf(Law law, std::string_view controller) {
  for (const Exception& each : exceptions)
    if (each.law == law && each.controller == controller) return each.bound;
  return infoOf(law).bound;
}

}  // namespace skitter::laws
