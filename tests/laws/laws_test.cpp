#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <sstream>
#include <string>

#include "laws/law.h"
#include "puppet.h"

namespace skitter::test {
namespace {

using laws::Law;
using ::testing::HasSubstr;

std::string textsOf(const std::vector<laws::Figure>& findings) {
  std::string texts;
  for (const laws::Figure& finding : findings) texts += finding.text + "\n";
  return texts;
}

void expectOnly(Law law, const Fault& fault, const char* words, uint64_t agents = 1) {
  const std::vector<laws::Figure> findings = walk(9, fault);
  ASSERT_EQ(findings.size(), 1u) << textsOf(findings);
  EXPECT_STREQ(laws::nameOf(findings[0].law), laws::nameOf(law)) << textsOf(findings);
  EXPECT_EQ(findings[0].agents, agents) << textsOf(findings);
  EXPECT_THAT(findings[0].text, HasSubstr(words));
  EXPECT_FALSE(laws::infoOf(law).bound.isKept(findings[0].worst)) << textsOf(findings);
}

// A foot in the air on purpose is no foot that stands on air.
void flies(laws::Moment& moment) { moment.stands.assign(moment.stands.size(), false); }

TEST(Laws, AreKeptByAWalkThatKeepsThem) {
  const std::vector<laws::Figure> findings = walk(30);
  EXPECT_TRUE(findings.empty()) << textsOf(findings);
}

TEST(Laws, GroundedIsBrokenByABodyThatIsLifted) {
  expectOnly(Law::grounded,
             {.ofBody = [](double, laws::Body& body) { body.position.y += 1.5; },
              .ofFoot = [](size_t, double, glm::dvec3& foot) { foot.y += 1.5; },
              .ofMoment = flies},
             "left the ground, the first at tick 30; grounded 1.5 leg lengths, expected at most 1.2");
}
TEST(Laws, GroundedIsBrokenByABodyThatSank) {
  expectOnly(Law::grounded,
             {.ofBody = [](double, laws::Body& body) { body.position.y -= 0.4; },
              .ofFoot = [](size_t, double, glm::dvec3& foot) { foot.y -= 0.4; },
              .ofMoment = flies},
             "sank into the ground");
}
TEST(Laws, SoleSlideIsBrokenByAFootsSkinThatFollowsTheBody) {
  expectOnly(Law::soleSlide,
             {.ofModel =
                  [](laws::Creature& creature) {
                    for (laws::SkinVertex& vertex : creature.vertices)
                      if (vertex.rest.y < 0.05) vertex.bones[0] = 0;
                  }},
             "slide on standing feet");
}
TEST(Laws, SoleDepthIsBrokenByFeetInTheGround) {
  expectOnly(Law::soleDepth, {.ofFoot = [](size_t, double, glm::dvec3& foot) { foot.y -= 0.03; }},
             "in the ground");
}
TEST(Laws, SoleAirIsBrokenByFeetOverTheGround) {
  expectOnly(Law::soleAir, {.ofFoot = [](size_t, double, glm::dvec3& foot) { foot.y += 0.03; }},
             "stand on air");
}
TEST(Laws, BodyDepthIsBrokenByAKeelInTheGround) {
  expectOnly(Law::bodyDepth,
             {.ofModel =
                  [](laws::Creature& creature) {
                    addBox(creature, {-0.02, -0.05, -0.02}, {0.02, 0.65, 0.02}, 0);
                  }},
             "bodies in the ground");
}
TEST(Laws, KneesIsBrokenByAKneeThatIsTurnedOver) {
  expectOnly(Law::knees,
             {.bendsBack = [](size_t leg, double seconds) { return leg == 2 && seconds > 4 && seconds < 5; }},
             "bend a joint to the wrong side, the first at tick 241; knees 20 flips a minute");
}
TEST(Laws, UprightIsBrokenByABodyOnItsSide) {
  expectOnly(Law::upright,
             {.ofBody =
                  [](double, laws::Body& body) {
                    body.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0, 0, 1)));
                  }},
             "do not keep upright");
}
TEST(Laws, StretchIsBrokenByAVertexOfTheBodyThatFollowsAShin) {
  expectOnly(Law::stretch, {.ofModel = [](laws::Creature& creature) { creature.vertices[1].bones[0] = 2; }},
             "torn skin");
}
TEST(Laws, FacingIsBrokenByAForwardThatIsReversed) {
  expectOnly(Law::facing,
             {.ofModel =
                  [](laws::Creature& creature) {
                    creature.forward = {0, 0, -1};
                  }},
             "do not face the way they go");
}
TEST(Laws, ProgressIsBrokenByAClockThatIsHalved) {
  expectOnly(Law::progress, {.clock = 0.5}, "are slower than asked");
}
TEST(Laws, ProgressIsBrokenByAClockThatRunsFast) {
  expectOnly(Law::progress, {.clock = 1.2}, "are faster than asked");
}
TEST(Laws, JerkIsBrokenByABodyThatShakes) {
  expectOnly(
      Law::jerk,
      {.ofBody = [](double seconds,
                    laws::Body& body) { body.position.z += 0.02 * std::sin(62.8318530718 * seconds); }},
      "move by jerks");
}
TEST(Laws, JerkIsBrokenByFeetThatShake) {
  expectOnly(Law::jerk,
             {.ofFoot =
                  [](size_t, double seconds, glm::dvec3& foot) {
                    if (foot.y > 0.02) foot.x += 0.03 * std::sin(62.8318530718 * seconds);
                  }},
             "move by jerks");
}
TEST(Laws, ApartIsBrokenByTwoInEachOther) {
  expectOnly(Law::apart, {.other = glm::dvec3(0.3, 0, 0)}, "are in each other", 2);
}
TEST(Laws, ApartIsKeptByTwoBesideEachOther) {
  const std::vector<laws::Figure> findings = walk(9, {.other = glm::dvec3(0.42, 0, 0)});
  EXPECT_TRUE(findings.empty()) << textsOf(findings);
}
TEST(Laws, CrossingIsBrokenByTwoLegsInOnePlace) {
  expectOnly(Law::crossing,
             {.ofMoment =
                  [](laws::Moment& moment) {
                    for (const size_t bone : {3, 4}) moment.bones[bone][3].x += 0.4;
                  }},
             "legs through each other");
}
TEST(Laws, ANumberThatIsNoneBreaksThem) {
  laws::Tally tally(3, "beast", "adaptive");
  tally.add(Law::grounded, 7, 12, std::nan(""));
  ASSERT_EQ(tally.broken().size(), 1u);
  EXPECT_THAT(tally.broken()[0].text,
              HasSubstr("herd 3 (beast): 1 of 1 agents left the ground, the first at tick 12"));
}
// The 99th percentile of a law with a share, none of one without.
TEST(Laws, AllowAShareOfSamples) {
  for (const auto& [beyond, isKept] : {std::pair(2, true), std::pair(3, false)}) {
    laws::Tally tally(0, "beast", "adaptive");
    for (uint64_t i = 0; i < 200; ++i)
      tally.add(Law::soleSlide, 0, i, i < static_cast<uint64_t>(beyond) ? 0.5 : 0.0);
    EXPECT_EQ(tally.broken().empty(), isKept) << beyond;
  }
}

TEST(LawGround, IsBilinearAndStaysBeyondItsEdge) {
  const std::vector<float> heights = {0, 1, 2, 5};
  const laws::Ground ground{.originX = -1, .originZ = 1, .spacingX = 2, .spacingZ = 4, .heights = heights};
  EXPECT_DOUBLE_EQ(ground.at(0, 3), 2);
  EXPECT_DOUBLE_EQ(ground.at(0.5, 2), 0.75 * (1 - 0.25) + 0.25 * (2 + 0.75 * 3));
  EXPECT_DOUBLE_EQ(ground.at(-50, -50), 0);
  EXPECT_DOUBLE_EQ(ground.at(50, 50), 5);
}
TEST(LawGround, LiesBelowAFootprintAsAPlane) {
  const std::vector<float> slope = {0, 2, 1, 3};
  const laws::Ground ground{.originX = -1, .originZ = -1, .spacingX = 2, .spacingZ = 2, .heights = slope};
  const laws::Footing footing = laws::footingOf(ground, 0, 0, 0.5);
  EXPECT_NEAR(footing.normal.x / footing.normal.y, -1, 1e-12);
  EXPECT_NEAR(footing.normal.z / footing.normal.y, -0.5, 1e-12);
  EXPECT_NEAR(footing.highest - footing.lowest, 2 * 0.5 * std::sqrt(0.5) * 1.5, 1e-12);
}

TEST(LawAnatomy, FindsFeetAndBodyInTheSkin) {
  const laws::Anatomy anatomy(puppet());
  EXPECT_EQ(anatomy.body.size(), 8u);
  for (const laws::Anatomy::Limb& limb : anatomy.limbs) {
    EXPECT_EQ(limb.foot.size(), 8u);
    ASSERT_EQ(limb.knees.size(), 1u);
    EXPECT_NEAR(std::abs(limb.knees[0].axis.x), 1, 1e-12);
  }
  EXPECT_NEAR(anatomy.footprint, std::hypot(0.2, 0.4), 1e-12);
}

std::string textOf(const laws::Bound& bound) {
  std::ostringstream text;
  if (bound.least > -laws::unbounded)
    text << bound.least << " to " << bound.most;
  else
    text << "at most " << bound.most;
  return text.str();
}

// The page has the tables as the code has them. After a change of laws/law.h the failure prints them again.
TEST(LawPage, HasEveryLawAndException) {
  std::ifstream file(SKITTER_ROOT "/docs/laws.md");
  const std::string page = std::string(std::istreambuf_iterator<char>(file), {}) + "\n";
  std::ostringstream laws, exceptions;
  for (const laws::LawInfo& info : laws::lawTable) {
    laws << "| `" << info.name << "` | " << info.measured << " | " << info.unit << " | "
         << textOf(info.bound);
    if (info.share > 0) laws << ", " << 100 * (1 - info.share) << " %";
    laws << " | " << info.reason << " | " << info.source << " |\n";
  }
  for (const laws::Exception& each : laws::exceptions)
    exceptions << "| `" << each.controller << "` | `" << laws::nameOf(each.law) << "` | "
               << textOf(each.bound) << " | " << each.reason << " |\n";
  EXPECT_NE(page.find("|\n" + laws.str() + "\n"), std::string::npos) << laws.str();
  EXPECT_NE(page.find("|\n" + exceptions.str() + "\n"), std::string::npos) << exceptions.str();
}

}  // namespace
}  // namespace skitter::test
