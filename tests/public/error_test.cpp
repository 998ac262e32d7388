#include "skitter/error.h"

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicError, IsOneLineOfItsKind) {
  const Error error(Error::Kind::check, "a\nb\tc");
  EXPECT_STREQ(error.what(), "a b c");
  EXPECT_EQ(error.kind(), Error::Kind::check);
  EXPECT_EQ(inputError("x").kind(), Error::Kind::input);
  EXPECT_EQ(deviceError("x").kind(), Error::Kind::device);
  // A host may pass the kind on as an exit code.
  EXPECT_EQ(static_cast<int>(deviceError("x").kind()), 3);
}

TEST(PublicError, DetailLeavesOutTheName) {
  EXPECT_EQ(inputError("crab.glb: has no legs").detail("crab.glb"), "has no legs");
  EXPECT_EQ(inputError("crab.glb: has no legs").detail("ant.glb"), "crab.glb: has no legs");
}

// The library and the program have one type, although the library hides what is not marked.
TEST(PublicError, IsCaughtFromTheLibrary) {
  EXPECT_THROW(loadScene("nowhere.json"), Error);
  EXPECT_THROW(loadScene("nowhere.json"), std::runtime_error);
}

}  // namespace
}  // namespace skitter::test
