#include "skitter/enum_names.h"

#include "public/public.h"

namespace skitter::test {
namespace {

enum class Fruit { apple, pear };
constexpr std::array allFruits = {Fruit::apple, Fruit::pear};
constexpr const char* nameOf(Fruit fruit) { return fruit == Fruit::apple ? "apple" : "pear"; }
constexpr bool isEarlierName(Fruit fruit, std::string_view name) {
  return fruit == Fruit::pear && name == "quince";
}
enum class Colour { red };

TEST(PublicEnumNames, FindsEnumeratorsByTheirNamesAndEarlierOnes) {
  EXPECT_EQ(enumNamed(allFruits, "apple"), Fruit::apple);
  EXPECT_EQ(enumNamed(allFruits, "quince"), Fruit::pear);
  EXPECT_EQ(enumNamed(allFruits, "Apple"), std::nullopt);
  EXPECT_EQ(enumNamed(allFruits, ""), std::nullopt);
  EXPECT_FALSE(skitter::isEarlierName(Colour::red, "red"));
}

TEST(PublicEnumNames, ListsThem) {
  EXPECT_EQ(namesOf(allFruits), "apple, pear");
  EXPECT_EQ(namesOf(allFruits, "|"), "apple|pear");
}

}  // namespace
}  // namespace skitter::test
