#include "app/ik/chain_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/common/values.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

constexpr uint64_t leastJoints = 2, mostJoints = ik::Chain::maxBones + 1;
constexpr double mostLength = 1e6, leastReach = 1e-6;
constexpr double leastAngle = 1e-3;             // degrees, of a cone or an ellipse
constexpr double largestRadians = 3.1;          // of any limit: what is wider is as wide as this
constexpr double mostAlongAxis = 0.999;         // share of a hinged bone's direction
constexpr double bentFrom = 60, bentBy = -140;  // degrees above +X, of the first bone and from it to the last

float radians(double degrees) {
  return static_cast<float>(std::clamp(glm::radians(degrees), -largestRadians, largestRadians));
}

std::vector<double> parseSome(const std::string& option, const std::string& text, size_t count, double least,
                              double most) {
  const std::vector<double> numbers = parseNumbers(option, text, least, most);
  if (numbers.size() == count) return numbers;
  throw inputError(
      fmt::format("{} is {}, expected {} numbers, found {}", option, text, count, numbers.size()));
}

// The first three of `numbers`, of any length but 0.
glm::vec3 directionOf(const std::string& option, const std::string& text,
                      const std::vector<double>& numbers) {
  const double length = std::hypot(numbers[0], numbers[1], numbers[2]);
  if (!(length > 0)) throw inputError(fmt::format("{} is {}, expected a direction", option, text));
  return glm::dvec3(numbers[0], numbers[1], numbers[2]) / length;
}

ik::Limit parseCone(const std::string& text) {
  return ik::Cone{radians(parseNumber("--limits cone", text, leastAngle, 180))};
}

ik::Limit parseEllipse(const std::string& text) {
  const std::vector<double> angles = parseSome("--limits ellipse", text, 4, leastAngle, 180);
  return ik::Ellipse{radians(angles[0]), radians(angles[1]), radians(angles[2]), radians(angles[3])};
}

ik::Limit parseHinge(const std::string& text) {
  const std::string option = "--limits hinge";
  const std::vector<double> numbers = parseSome(option, text, 5, -mostLength, mostLength);
  const double min = numbers[3], max = numbers[4];
  if (!(-180 <= min && min <= max && max <= 180)) {
    throw inputError(
        fmt::format("{} is {}, expected MIN to be at most MAX, both from -180 to 180", option, text));
  }
  return ik::Hinge{directionOf(option, text, numbers), radians(min), radians(max)};
}

ik::Limit parseLimit(const std::string& text) {
  const size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string values = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (text == "none") return ik::Free{};
  if (kind == "cone") return parseCone(values);
  if (kind == "ellipse") return parseEllipse(values);
  if (kind == "hinge") return parseHinge(values);
  throw inputError(fmt::format(
      "--limits is {}, expected none, cone:HALFDEG, ellipse:PX,PY,NX,NY or hinge:AX,AY,AZ,MIN,MAX",
      text.empty() ? "empty" : text));
}

// Refused here and not by the solver, which does not know what the user typed.
void checkAxis(const ik::Limit& limit, const glm::vec3& direction, size_t bone, const std::string& text) {
  const auto* hinge = std::get_if<ik::Hinge>(&limit);
  if (!hinge || std::abs(glm::dot(hinge->axis, direction)) <= mostAlongAxis) return;
  throw inputError(fmt::format("--limits {}: bone {} (from 0) lies along the axis at rest", text, bone));
}

glm::vec3 restDirection(const std::string& rest, size_t bone, size_t bones) {
  if (rest == "straight") return {1, 0, 0};
  const double share = bones > 1 ? static_cast<double>(bone) / static_cast<double>(bones - 1) : 0;
  const double angle = glm::radians(bentFrom + bentBy * share);
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
}

size_t boneCount(const IkChainOptions& options) {
  const size_t given = options.bones.size();
  if (!options.joints && given == 0) {
    throw inputError(
        fmt::format("--joints is missing, expected {} to {}, or --bones", leastJoints, mostJoints));
  }
  const size_t wanted = options.joints ? *options.joints - 1 : given;
  if (given != 0 && given != wanted) {
    throw inputError(
        fmt::format("--bones has {} lengths, expected {}: --joints is {}", given, wanted, *options.joints));
  }
  if (wanted >= mostJoints) {
    throw inputError(fmt::format("--bones has {} lengths, expected at most {}", given, mostJoints - 1));
  }
  return wanted;
}

void addAnglesTo(CLI::App& command, IkChainOptions& options) {
  command
      .add_option(
          "--limits", options.limits,
          "of every bone, in degrees from its rest direction, in the frame that the bones before it "
          "carry along: none; a cone's half-angle; half-angles of an ellipse toward +x, +y, -x, -y; a "
          "hinge's axis and range (177.6 is the widest that any can be) [none]")
      ->type_name("none|cone:A|ellipse:PX,PY,NX,NY|hinge:AX,AY,AZ,MIN,MAX");
  command.add_flag("--free-base", options.freeBase, "leave the first bone without limit");
}

}  // namespace

void IkChainOptions::addTo(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--joints",
          [this](const std::string& text) { joints = parseWhole("--joints", text, leastJoints, mostJoints); },
          fmt::format("joints of a chain, base and tip among them, {} to {}", leastJoints, mostJoints))
      ->type_name("J");
  command
      .add_option_function<std::string>(
          "--bones",
          [this](const std::string& text) {
            bones = parseNumbers("--bones", text, 0, mostLength);
            if (std::accumulate(bones.begin(), bones.end(), 0.0) < leastReach) {
              throw inputError(
                  fmt::format("--bones is {}, expected a length of {} or more in all", text, leastReach));
            }
          },
          "lengths of its bones, one fewer than joints [equal, 1 in all]")
      ->type_name("L1,L2,..");
  command
      .add_option("--rest", rest,
                  "the rest pose, from which limits are measured: bent, from 60 degrees above +X to 80 below "
                  "it in the XY plane, or straight, along +X [bent]")
      ->check(CLI::IsMember({"bent", "straight"}));
  addAnglesTo(command, *this);
  command
      .add_option_function<std::string>(
          "--pole",
          [this](const std::string& text) {
            pole = directionOf("--pole", text, parseSome("--pole", text, 3, -mostLength, mostLength));
          },
          "to which side a chain shall bend, where it may bend two ways [either]")
      ->type_name("X,Y,Z");
}

ik::Chain IkChainOptions::chain() const {
  const size_t count = boneCount(*this);
  const ik::Limit limit = parseLimit(limits);
  ik::Chain result;
  for (size_t i = 0; i < count; ++i) {
    ik::Bone bone;
    bone.length = static_cast<float>(bones.empty() ? 1.0 / static_cast<double>(count) : bones[i]);
    bone.direction = restDirection(rest, i, count);
    if (i > 0 || !freeBase) {
      checkAxis(limit, bone.direction, i, limits);
      bone.limit = limit;
    }
    result.bones.push_back(bone);
  }
  result.pole = pole;
  ik::check(result);
  return result;
}

void checkSolver(ik::Solver solver, const ik::Chain& chain, const IkChainOptions& options) {
  const auto refuse = [&](const std::string& takes, const std::string& has) {
    throw inputError(fmt::format("--solver {} takes {}, {}", ik::nameOf(solver), takes, has));
  };
  const std::string limitsAre = fmt::format("--limits is {}", options.limits);
  const bool withoutLimits = solver == ik::Solver::twoBone || solver == ik::Solver::stretchAlign;
  const bool conesOnly = solver == ik::Solver::dissertationKeep || solver == ik::Solver::dissertationEdge;
  if (withoutLimits && !chain.isFree()) refuse("no limits", limitsAre);
  if (solver == ik::Solver::activeSet && chain.isFree()) refuse("a chain with limits", limitsAre);
  if (solver == ik::Solver::twoBone && chain.bones.size() != 2) {
    refuse("3 joints", fmt::format("the chain has {}", chain.bones.size() + 1));
  }
  const bool otherThanCones = std::any_of(chain.bones.begin(), chain.bones.end(), [](const ik::Bone& bone) {
    return !std::holds_alternative<ik::Free>(bone.limit) && !std::holds_alternative<ik::Cone>(bone.limit);
  });
  if (conesOnly && otherThanCones) refuse("no limits but cones", limitsAre);
}

}  // namespace skitter::app
