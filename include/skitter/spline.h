#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skitter/device.h"
#include "skitter/enum_names.h"
#include "skitter/export.h"

// Cubic Hermite splines: chains of points that something travels along. docs/spline.md states the equations
// and their sources. Lengths are in the caller's units; knots and clocks in seconds, or any unit of time.
namespace skitter {

enum class SplineRule : uint32_t {
  given,
  catmullRom,        // the parabola through each three points, uneven knots heeded
  finiteDifference,  // mean of the slopes on both sides
  cardinal,          // (1 - tension) times the chord between the neighbours
  kochanekBartels,   // tension, continuity, bias
  monotone,          // Fritsch-Carlson: no coordinate overshoots
  zero,              // rests at every point
};
inline constexpr std::array allSplineRules = {
    SplineRule::given,    SplineRule::catmullRom,      SplineRule::finiteDifference,
    SplineRule::cardinal, SplineRule::kochanekBartels, SplineRule::monotone,
    SplineRule::zero};
constexpr const char* nameOf(SplineRule rule) {
  constexpr std::array names = {"given",    "catmullRom", "finiteDifference", "cardinal", "kochanekBartels",
                                "monotone", "zero"};
  static_assert(names.size() == allSplineRules.size());
  return names[static_cast<size_t>(rule)];
}
constexpr std::optional<SplineRule> splineRuleNamed(std::string_view name) {
  return enumNamed(allSplineRules, name);
}
struct SplineTangents {
  SplineRule rule = SplineRule::catmullRom;
  float tension = 0;               // cardinal: 0 to 1; kochanekBartels: -1 to 1
  float continuity = 0, bias = 0;  // kochanekBartels: -1 to 1
};

// Coordinates and knots within +-1e6.
struct SplineChain {
  std::vector<glm::vec3> points = {};  // 2 to 1024
  // When the points are met, each at least 1e-6 after the one before; as many as points, and if closed one
  // more: when it is back at the first. Empty: 0, 1, 2, ..
  std::vector<float> knots = {};
  bool closed = false;
  SplineTangents tangents = {};
  // For SplineRule::given: velocities dP/dt, one a point, within +-1e12. Empty `leaving`: leaves as it
  // arrives.
  std::vector<glm::vec3> arriving = {}, leaving = {};
};

// Knots from 0 on for points that have none, apart by the distance of the points to a power: 0 uniform, 1/2
// centripetal, 1 chordal (Lee 1989).
SKITTER_API std::vector<float> splineKnots(std::span<const glm::vec3> points, bool closed, float power);

enum class SplineState : uint32_t {
  idle,  // not active, or not yet begun: at the start
  moving,
  finished,  // at the end; a closed spline never is
  refused,   // device only: its records there hold what may not be
};
inline constexpr std::array allSplineStates = {SplineState::idle, SplineState::moving, SplineState::finished,
                                               SplineState::refused};
constexpr const char* nameOf(SplineState state) {
  constexpr std::array names = {"idle", "moving", "finished", "refused"};
  static_assert(names.size() == allSplineStates.size());
  return names[static_cast<size_t>(state)];
}

// When one travels along a spline. A value: batches take arrays of them.
struct SKITTER_API SplineClock {
  double start = 0;
  double duration = 1;  // of the way, or of a round; > 0
  bool active = false;

  void activate(double at);
  void reset();  // back to the start; the duration stays
  // A new duration from `now` on, that keeps the position on the spline: > 0, or Error(input).
  void rescale(double duration, double now);
  SplineState state(double now, bool closed) const;
  // Share of the way, 0 to 1; of a closed spline of the present round.
  double progress(double now, bool closed) const;
  // Whole rounds done; 0 unless closed.
  double rounds(double now, bool closed) const;
};

struct SplineMotion {
  glm::vec3 position{0}, velocity{0};  // velocity per second of the clock
  float travelled = 0;                 // arc length since the start; of a closed spline all rounds
  SplineState state = SplineState::idle;
};

// One spline on the host, computed in double. Immutable but for its clock. Throws Error(input) for a chain
// that cannot be, naming the fault.
class SKITTER_API Spline {
 public:
  explicit Spline(const SplineChain&);

  // At knot time `time`, clamped to [begin, end], or wrapped if closed.
  double begin() const { return knots_.front(); }
  double end() const { return knots_.back(); }
  glm::vec3 position(double time) const;
  glm::vec3 velocity(double time) const;
  glm::vec3 acceleration(double time) const;

  double length() const { return lengths_.back(); }
  double lengthAt(double time) const;        // from the first point
  double timeAtLength(double length) const;  // clamped to [0, length()], or wrapped if closed

  // Travelling. The duration is end - begin at first, the clock not active.
  SplineClock clock;
  bool closed() const { return closed_; }
  double progress(double now) const { return clock.progress(now, closed_); }
  bool finished(double now) const { return clock.state(now, closed_) == SplineState::finished; }
  // At constant speed it is the share of the arc length that is proportional to time.
  SplineMotion at(double now, bool constantSpeed = false) const;

 private:
  struct SKITTER_LOCAL Segment {
    glm::dvec3 p, a, c, e;  // P = p + s (a + s (c + s e))
    glm::dvec3 first(double s) const { return a + s * (2.0 * c + 3.0 * s * e); }
    double length(double s) const;
  };
  struct Place {
    size_t segment;
    double s;
  };
  Place placeAt(double time) const;
  Place placeAtLength(double length) const;
  double step(size_t segment) const { return knots_[segment + 1] - knots_[segment]; }

  bool closed_;
  std::vector<double> knots_, lengths_;  // of the points; lengths from the first
  std::vector<Segment> segments_;
};

// N splines of equal point count on the device. Not thread-safe. Throws Error(input) for options that cannot
// be and for a page that it does not have, Error(device) when memory does not suffice. Splines are split over
// pages, so that any count fits the device's bindings.
class SKITTER_API SplineBatch {
 public:
  // Device memory, in the caller's hands or the batch's: arrays of vec4 with usage STORAGE_BUFFER and
  // UNIFORM_TEXEL_BUFFER.
  struct Span {
    VkBuffer buffer = VK_NULL_HANDLE;
    uint64_t bytes = 0;
  };
  // Another shader for an entry point: SPIR-V of shaders/spline/<entry>.comp changed, in both load paths.
  struct Shader {
    std::string entry;  // "tangents", "lengths", "travel"
    std::span<const uint8_t> texel, storage;
  };
  struct Options {
    uint32_t points = 2;  // a spline, 2 to 1024
    bool closed = false;
    SplineTangents tangents = {};
    bool arcLength = true;             // the length travelled is written, else 0
    bool constantSpeed = false;        // the arc length grows evenly, not the knots' time
    uint32_t pageSplines = 0;          // most splines per page; 0: as many as the device's limits allow
    std::vector<Shader> shaders = {};  // in place of the built-in ones, for experiments
  };

  SplineBatch(Device&, uint32_t splines, const Options&);
  ~SplineBatch();
  SplineBatch(SplineBatch&&) noexcept;
  SplineBatch& operator=(SplineBatch&&) noexcept;

  uint32_t splines() const;
  uint32_t points() const;  // a spline
  uint32_t keys() const;    // a spline: points, and if closed one more
  uint64_t memoryBytes() const;

  // From the host: `points` per spline, and keys() `knots` per spline or for all; empty: 0, 1, 2, ..
  // What may not be is refused with Error(input) naming the spline and the point, and nothing changes.
  // With SplineRule::given, set the tangents too. Prepares; these and the reads below wait for the device.
  void setPoints(std::span<const glm::vec3> points, std::span<const float> knots = {});
  // One a point; empty `leaving`: leaves as it arrives. Prepares. Only with SplineRule::given.
  void setTangents(std::span<const glm::vec3> arriving, std::span<const glm::vec3> leaving = {});
  // One per spline; a duration that is not more than 0 or a start that is not finite is refused likewise.
  void setClocks(std::span<const SplineClock>);
  // Records a tick, submits it and waits.
  void travel(double now);
  std::vector<SplineMotion> downloadMotions() const;
  std::vector<float> downloadLengths() const;  // one per spline, 0 where refused

  // In the caller's command buffer, outside a render pass; each begins and ends with barriers against compute
  // and transfer work before and after it. recordPrepare: keys (and given tangents) have changed on the
  // device: tangents and lengths are made anew. record: every spline's motion at the time `now`.
  void recordPrepare(VkCommandBuffer) const;
  void record(VkCommandBuffer, double now) const;

  // The device's own view, page by page: spline n is entry n % pageSplines() of page n / pageSplines().
  uint32_t pageSplines() const;
  uint32_t pages() const;
  Span keys(
      uint32_t page) const;  // keys() per spline: x, y, z, knot; if closed, the last one's knot alone counts
  Span tangents(
      uint32_t page) const;  // two a key, arriving and leaving: x, y, z, unused; with SplineRule::given
  Span clocks(uint32_t page) const;   // one: start, the rest of start, duration, 1 if active else 0
  Span motions(uint32_t page) const;  // two: position, length travelled; velocity, SplineState
  // The caller's buffers in place of the batch's, for a batch of one page: large enough, and bound until the
  // batch goes or others are given. Those left empty stay the batch's own. What they hold is
  // checked on the device: a spline that may not be is refused there (SplineState::refused).
  struct Buffers {
    Span keys = {}, tangents = {}, clocks = {}, motions = {};
  };
  void use(const Buffers&);

 private:
  struct SKITTER_LOCAL Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter
