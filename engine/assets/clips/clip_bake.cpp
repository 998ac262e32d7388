#include "assets/clips/clip_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "assets/models/clip_sampler.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double quarters[] = {0.5, 0.25, 0.75};  // the middle first: it errs most
// How many times its largest value at its ends and quarter points a cubic may reach: 1.0940 if it is 0 at
// both ends, as between two frames, else 1.2932. More than these, as frames are rounded (docs/clip.md,
// Frames).
constexpr double peakBetweenFrames = 1.095, peakBetweenKeys = 1.295;

void spend(BakeBudget& budget, size_t samples, const std::string& what) {
  if (samples > budget.samples) throw inputError(what + ": the clips of the file take too long to bake");
  budget.samples -= samples;
}

double inSingle(double value) { return static_cast<double>(static_cast<float>(value)); }

// docs/clip.md, Root motion and Frames.
class Baker {
 public:
  Baker(const gltf::Document& document, const BakeRange& range, const ClipSkin& skin,
        const std::vector<ClipLeg>& legs, double error, const std::string& what, BakeBudget& budget)
      : document_(document),
        skin_(skin),
        legs_(legs),
        allowed_(error),
        what_(what),
        budget_(budget),
        range_(range),
        sampler_(document, range.clip, skin.nodes, skin.creatureFromModel) {
    clip_.name = range.clip.name;
    clip_.seconds = inSingle(range.end - range.begin);
    clip_.channels = range.clip.channelCount;
  }

  Clip bake() {
    if (!(clip_.seconds <= Clip::maxSeconds))
      fail("lasts {} s, expected up to {}", clip_.seconds, Clip::maxSeconds);
    setRootVelocity();
    const std::vector<Knot> knots = findKnots();
    size_t first = 0;
    for (size_t k = 0; k < knots.size(); ++k) {
      const bool last = k + 1 == knots.size();
      if (!knots[k].jump && !last) continue;
      bakeStretch({knots.begin() + static_cast<std::ptrdiff_t>(first),
                   knots.begin() + static_cast<std::ptrdiff_t>(k) + 1});
      if (knots[k].jump && last) keep(frameAt(knots[k], Side::at));
      first = k;
    }
    addFeet();
    addBox();
    return std::move(clip_);
  }

 private:
  // A time of the baked clip, in single precision, and the file's, which may have more digits.
  struct Knot {
    double time = 0, source = 0;
    bool jump = false;
  };
  struct Frame {
    double time = 0;
    std::vector<glm::vec4> rows;
  };
  using Rows = std::array<glm::dvec4, 3>;

  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw inputError(what_ + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  // Begin, end and the keys between, each time once; where keys fall together in single precision the last.
  std::vector<Knot> findKnots() const {
    const std::vector<double> jumps = sampler_.jumpTimes();
    std::vector<Knot> knots{{0, range_.begin, false}};
    for (const double source : sampler_.keyTimes()) {
      if (source <= range_.begin || source > range_.end) continue;
      const double time = inSingle(source - range_.begin);
      const bool jump = std::binary_search(jumps.begin(), jumps.end(), source);
      if (time > knots.back().time) {
        knots.push_back({time, source, jump});
      } else {
        knots.back().source = source;
        knots.back().jump = knots.back().jump || jump;
      }
    }
    if (clip_.seconds > knots.back().time) knots.push_back({clip_.seconds, range_.end, false});
    return knots;
  }

  // The highest node that is translated and has most of the skin on it and below.
  void setRootVelocity() {
    int root = -1;
    size_t highest = 0;
    for (const int node : skin_.nodes) {
      const auto n = static_cast<size_t>(node);
      if (!sampler_.translates(node) || skin_.inLeg[n] || !(skin_.weightBelow[n] > 0.5)) continue;
      size_t above = 0;
      for (int i = node; i != -1; i = document_.nodes[static_cast<size_t>(i)].parent) ++above;
      if (root != -1 && above >= highest) continue;
      root = node;
      highest = above;
    }
    if (root == -1 || !(clip_.seconds > 0)) return;
    const auto n = static_cast<size_t>(root);
    const glm::dvec3 from(sampler_.sample(range_.begin)[n][3]), to(sampler_.sample(range_.end)[n][3]);
    rootVelocity_ = (to - from) / clip_.seconds;
    rootVelocity_.y = 0;
    // What is taken out is what is stored.
    clip_.rootVelocity = glm::vec3(rootVelocity_);
    rootVelocity_ = glm::dvec3(clip_.rootVelocity);
  }

  // M' of every entry at a time.
  const std::vector<Rows>& exact(const Knot& knot, Side side) {
    spend(budget_, skin_.nodes.size() + skin_.entries.size(), what_);
    const std::vector<glm::dmat4>& creatureFromNode = sampler_.sample(knot.source, side);
    exact_.resize(skin_.entries.size());
    for (size_t e = 0; e < skin_.entries.size(); ++e) {
      const ClipSkin::Entry& entry = skin_.entries[e];
      glm::dmat4 matrix = creatureFromNode[static_cast<size_t>(entry.node)] * entry.nodeFromBound;
      matrix[3] -= glm::dvec4(rootVelocity_ * knot.time, 0);
      for (int k = 0; k < 3; ++k) {
        exact_[e][static_cast<size_t>(k)] = {matrix[0][k], matrix[1][k], matrix[2][k], matrix[3][k]};
      }
    }
    return exact_;
  }

  Frame frameAt(const Knot& knot, Side side) {
    Frame frame{knot.time, {}};
    frame.rows.reserve(3 * skin_.entries.size());
    for (const Rows& rows : exact(knot, side)) {
      for (const glm::dvec4& row : rows) {
        for (int k = 0; k < 4; ++k) {
          if (!(std::fabs(row[k]) <= 1e12)) fail("has a matrix that holds {} at {} s", row[k], knot.source);
        }
        frame.rows.emplace_back(row);
      }
    }
    return frame;
  }

  void keep(const Frame& frame) {
    if (clip_.times.size() == Clip::maxFrames) {
      fail("takes over {} frames to err by {:.3g} m at most", Clip::maxFrames, allowed_);
    }
    if (skin_.entries.size() > budget_.matrices) fail("the clips of the file take too many matrices");
    budget_.matrices -= skin_.entries.size();
    clip_.times.push_back(static_cast<float>(frame.time));
    clip_.rows.insert(clip_.rows.end(), frame.rows.begin(), frame.rows.end());
  }

  // From the first to the last of `knots`; at both the clip may jump.
  void bakeStretch(std::vector<Knot> knots) {
    knots_ = std::move(knots);
    const Frame first = frameAt(knots_.front(), Side::at);
    keep(first);
    if (knots_.size() < 2) return;
    const Frame last = frameAt(knots_.back(), knots_.back().jump ? Side::before : Side::at);
    refine(0, knots_.size() - 1, first, last);
  }

  void refine(size_t first, size_t last, const Frame& from, const Frame& to) {
    double error = 0;
    if (fits(first, last, from, to, error)) {
      clip_.error = std::max(clip_.error, error);
      keep(to);
      return;
    }
    if (last - first < 2) {
      bisect(from, to);
      return;
    }
    const size_t middle = (first + last) / 2;
    const Frame frame = frameAt(knots_[middle], Side::at);
    refine(first, middle, from, frame);
    refine(middle, last, frame, to);
  }

  void bisect(const Frame& from, const Frame& to) {
    const Knot middle = between(from.time, to.time, 0.5);
    double error = 0;
    const bool whole = middle.time <= from.time || middle.time >= to.time;  // no time lies between
    if (whole || fitsWithin(from.time, to.time, from, to, peakBetweenFrames, error)) {
      clip_.error = std::max(clip_.error, error);
      keep(to);
      return;
    }
    const Frame frame = frameAt(middle, Side::at);
    bisect(from, frame);
    bisect(frame, to);
  }

  Knot between(double from, double to, double share) const {
    const double time = inSingle(from + share * (to - from));
    return {time, range_.begin + time, false};
  }

  // Whether an interval between two key times errs little enough there and between all key times within.
  bool fits(size_t first, size_t last, const Frame& from, const Frame& to, double& error) {
    if (!fitsWithin(from.time, to.time, from, to, peakBetweenFrames, error)) return false;
    if (last - first < 2) return true;
    for (size_t k = first; k < last; ++k) {
      if (k > first && !fitsAt(knots_[k], from, to, peakBetweenKeys, error)) return false;
      if (!fitsWithin(knots_[k].time, knots_[k + 1].time, from, to, peakBetweenKeys, error)) return false;
    }
    return true;
  }

  bool fitsWithin(double begin, double end, const Frame& from, const Frame& to, double peak, double& error) {
    for (const double share : quarters) {
      const Knot knot = between(begin, end, share);
      if (knot.time > begin && knot.time < end && !fitsAt(knot, from, to, peak, error)) return false;
    }
    return true;
  }

  bool fitsAt(const Knot& knot, const Frame& from, const Frame& to, double peak, double& error) {
    const double u = (knot.time - from.time) / (to.time - from.time);
    const std::vector<Rows>& rows = exact(knot, Side::at);
    for (size_t e = 0; e < rows.size(); ++e) {
      const ClipSkin::Entry& entry = skin_.entries[e];
      glm::dmat4 off(0);  // columns: the rows of what the frames lack
      for (size_t k = 0; k < 3; ++k) {
        off[static_cast<int>(k)] =
            glm::dvec4(from.rows[3 * e + k]) * (1 - u) + glm::dvec4(to.rows[3 * e + k]) * u - rows[e][k];
      }
      for (int corner = 0; corner < 8; ++corner) {
        const double miss = peak * glm::length(cornerOf(entry, corner) * off);
        if (!(miss <= allowed_)) return false;
        error = std::max(error, miss);
      }
    }
    return true;
  }

  static glm::dvec4 cornerOf(const ClipSkin::Entry& entry, int corner) {
    return {corner & 1 ? entry.most.x : entry.least.x, corner & 2 ? entry.most.y : entry.least.y,
            corner & 4 ? entry.most.z : entry.least.z, 1};
  }

  void addFeet() {
    const size_t joints = skin_.entries.size();
    for (size_t frame = 0; frame < clip_.frames(); ++frame) {
      for (const ClipLeg& leg : legs_) {
        const glm::vec4* rows = clip_.rows.data() + 3 * (frame * joints + leg.joints.back());
        const glm::vec4 start(leg.starts.back(), 1);
        clip_.feet.emplace_back(glm::dot(rows[0], start), glm::dot(rows[1], start), glm::dot(rows[2], start));
      }
    }
  }

  void addBox() {
    glm::dvec3 least(HUGE_VAL), most(-HUGE_VAL);
    for (size_t m = 0; m < clip_.frames() * skin_.entries.size(); ++m) {
      const ClipSkin::Entry& entry = skin_.entries[m % skin_.entries.size()];
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 bound = cornerOf(entry, corner);
        glm::dvec3 p;
        for (int k = 0; k < 3; ++k)
          p[k] = glm::dot(glm::dvec4(clip_.rows[3 * m + static_cast<size_t>(k)]), bound);
        least = glm::min(least, p);
        most = glm::max(most, p);
      }
    }
    for (int k = 0; k < 3; ++k) {
      if (!(least[k] >= -maxCoordinate && most[k] <= maxCoordinate)) {
        fail("carries skin from {:.3g} to {:.3g} m, expected within {} m", least[k], most[k], maxCoordinate);
      }
    }
    clip_.least = glm::vec3(least);
    clip_.most = glm::vec3(most);
  }

  const gltf::Document& document_;
  const ClipSkin& skin_;
  const std::vector<ClipLeg>& legs_;
  const double allowed_;
  const std::string& what_;
  BakeBudget& budget_;
  const BakeRange range_;
  ClipSampler sampler_;
  Clip clip_;
  glm::dvec3 rootVelocity_{0};
  std::vector<Knot> knots_;  // of the stretch
  std::vector<Rows> exact_;  // at the time asked for last
};

}  // namespace

Clip bakeClip(const gltf::Document& document, const BakeRange& range, const ClipSkin& skin,
              const std::vector<ClipLeg>& legs, double error, const std::string& what, BakeBudget& budget) {
  // What a clip takes however short it is.
  spend(budget, document.nodes.size(), what);
  return Baker(document, range, skin, legs, error, what, budget).bake();
}

}  // namespace skitter
