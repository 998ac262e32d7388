#include "skitter/host_space.h"

#include "public/public.h"

namespace skitter::test {
namespace {

using glm::dvec3;

TEST(PublicHostSpace, TurnsAsTheTableSays) {
  const struct {
    Axes axes;
    dvec3 faces, left;
  } table[] = {{Axes::rightYUp, {0, 0, 1}, {1, 0, 0}},
               {Axes::leftYUp, {0, 0, 1}, {-1, 0, 0}},
               {Axes::rightZUp, {0, -1, 0}, {1, 0, 0}},
               {Axes::leftZUp, {1, 0, 0}, {0, -1, 0}}};
  EXPECT_EQ(std::size(table), allAxes.size());
  for (const auto& [axes, faces, left] : table) {
    const HostSpace space{.axes = axes};
    EXPECT_EQ(space.turned() * dvec3(0, 0, 1), faces) << static_cast<int>(axes);
    EXPECT_EQ(space.turned() * dvec3(1, 0, 0), left) << static_cast<int>(axes);
    EXPECT_EQ(glm::determinant(space.turned()), space.isMirrored() ? -1 : 1) << static_cast<int>(axes);
  }
}

TEST(PublicHostSpace, CountsInItsUnit) {
  const HostSpace space{.axes = Axes::rightZUp, .metresPerUnit = 0.5f};
  EXPECT_EQ(space.from({1, 2, 3}), dvec3(2, -6, 4));
}

}  // namespace
}  // namespace skitter::test
