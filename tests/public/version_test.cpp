#include "skitter/version.h"

#include <sstream>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicVersion, OfTheLibraryIsThatOfTheHeaders) {
  std::ostringstream numbers;
  numbers << SKITTER_VERSION_MAJOR << '.' << SKITTER_VERSION_MINOR << '.' << SKITTER_VERSION_PATCH;
  EXPECT_STREQ(version(), SKITTER_VERSION);
  EXPECT_EQ(version(), numbers.str());
}

}  // namespace
}  // namespace skitter::test
