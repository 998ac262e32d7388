#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "laws/bodies.h"
#include "laws/skin_judge.h"
#include "laws/tally.h"
#include "skitter/crowd.h"
#include "skitter/scene.h"

namespace skitter::app {

// An agent's body as it was looked at.
struct SeenBody {
  uint32_t herd, agent, run;  // `run` of the herd's sizes
  double footprint;           // metres, how far its feet reach
  laws::Body body;

  glm::dvec2 place() const { return {body.position.x, body.position.z}; }
};

// Judges a crowd by the laws of the visible world as it goes (docs/laws.md): now and then the bodies, and the
// skin of a few agents for three seconds at a time. Waits for the device in the ticks in which it looks.
class LawWatch {
 public:
  // In larger crowds poses are not made for the laws alone.
  static constexpr uint64_t mostPosed = 256;

  // `skins`: agents whose skin is judged at a time.
  LawWatch(const Crowd& crowd, const Scene& scene, double dt, uint32_t skins = 0);
  ~LawWatch();

  // After each tick.
  void look(const Crowd& crowd);
  // CPU time of the process that it took so far.
  double cpuSeconds() const { return cpuSeconds_; }
  // How the laws that were judged were kept so far, herd by herd.
  std::vector<laws::Figure> figures();

 private:
  struct Model {
    laws::Creature creature;
    laws::Anatomy anatomy;
  };
  // A herd by number and generation.
  using HerdKey = std::pair<uint32_t, uint32_t>;
  struct Judged {
    laws::Tally tally;
    std::optional<laws::BodyJudge> bodies;
    std::vector<const Model*> sizes;  // of its runs
  };
  using AgentKey = std::pair<uint32_t, uint32_t>;  // herd, agent

  void follow(const Crowd& crowd);
  void lookAtBodies(const Crowd& crowd);
  void survey(const Crowd& crowd, uint32_t herd, const HerdState& state, const laws::Ground& ground,
              const AgentSample& sample, std::vector<SeenBody>& seen);
  bool isInWindow(uint64_t tick);
  void lookAtSkins(const Crowd& crowd);
  void lookAtSkin(const Crowd& crowd, const AgentKey& key, uint32_t run, const HerdState& state,
                  size_t number, const laws::Ground& ground);
  void endWindow();
  Judged& judgedOf(const Crowd& crowd, uint32_t herd);

  const Scene scene_;
  const double dt_;
  uint64_t bodyTicks_, windowTicks_, pauseTicks_;
  uint32_t skins_;
  uint32_t bodyStride_ = 1, skinStride_ = 1;
  std::set<uint64_t> jumps_;  // ticks before which agents are put somewhere
  std::optional<uint32_t> revision_;
  std::map<uint32_t, std::unique_ptr<Model>> models_;  // by kind
  std::map<HerdKey, Judged> herds_;
  uint64_t bodyLooks_ = 0, windows_ = 0, windowBegan_ = 0;
  bool windowOpen_ = false;
  double cpuSeconds_ = 0;
  std::map<AgentKey, laws::SkinJudge> judges_;  // of the window
  std::set<AgentKey> unfit_;                    // who fell during the window
};

// Those that were broken.
std::vector<laws::Figure> brokenOf(std::vector<laws::Figure> figures);
// As --json has what was broken.
nlohmann::ordered_json warningsJson(std::span<const laws::Figure> broken);
// Each a line on stderr.
void warnOf(std::span<const laws::Figure> broken);
// The names of the laws, each once.
std::string namesOf(std::span<const laws::Figure> figures);
// Throws Error(check) where a law was broken.
void refuseBroken(std::span<const laws::Figure> broken);

}  // namespace skitter::app
