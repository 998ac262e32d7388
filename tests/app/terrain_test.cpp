#include <cmath>

#include "../assets/files.h"
#include "../assets/height_bytes.h"
#include "process.h"

// Terrain as users bring it: each kind walks, and what cannot be walked is refused by name.
namespace skitter::test {
namespace {

struct Terrain : AppTest {
  Result walk(const std::string& terrain, std::vector<std::string> flags = {}) {
    flags.insert(flags.begin(),
                 {"run", "--headless", "--agents", "4", "--frames", "2", "--quiet", "--terrain", terrain});
    return skitter(flags);
  }
  std::string fileOf(const std::string& name, const std::vector<uint8_t>& bytes) {
    writeBytes(file(name), bytes);
    return file(name);
  }
  void expectSummary(const Result& result, const std::string& words) {
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find(words), std::string::npos) << result.out;
  }
};

TEST_F(Terrain, EveryKindIsWalked) {
  expectSummary(walk("noise:columns=65,rows=33,spacing=1,amplitude=2,wavelength=20,seed=5"),
                "noise, 65 x 33 samples, 64 x 32 m");
  expectSummary(walk("noise"), "noise, 513 x 513 samples");

  const std::vector<float> metres = {0, 0.1f, 0.2f, 0.3f, NAN, 0.2f};
  const std::string floats = fileOf("a.r32f", r32f(metres));
  expectSummary(walk(floats, {"--terrain-size", "3x2", "--spacing", "20"}),
                "a, 3 x 2 samples, 40 x 20 m, voids filled: 1");
  const std::string codes = fileOf("b_3x2.r16", r16({0, 1, 2, 3, 4, 5}));
  expectSummary(walk(codes, {"--spacing", "20,10", "--heights", "0,1", "--exaggeration", "2"}), "40 x 10 m");
  expectSummary(walk(codes, {"--spacing", "20,10", "--void-value", "3"}), "voids filled: 1");
  expectSummary(walk(fileOf("c.npy", npy(1, "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }",
                                         r32f(metres))),
                     {"--spacing", "20"}),
                "c, 3 x 2 samples, 40 x 20 m, voids filled: 1");
  expectSummary(walk(fileOf("N27E086.hgt", hgt(1201, 100, {{600, 600, -32768}})), {"--scale", "0.01"}),
                "N27E086, 1201 x 1201 samples, 988.");
}

TEST_F(Terrain, AWorldTooLargeSuggestsAScale) {
  const Result result = walk(fileOf("N27E086.hgt", hgt(1201, 100)));
  expectRefusal(result, 2, {"8192 m", "--scale"});
}

TEST_F(Terrain, FaultsOfFilesAndOfNoiseAreNamed) {
  expectRefusal(walk(fileOf("odd.r16", r16({0, 1, 2}))), 2, {"odd.r16", "--terrain-size"});
  expectRefusal(walk(fileOf("a.hgt", r16({0, 1, 2}))), 2, {"a.hgt", "SRTM"});
  expectRefusal(walk(fileOf("a.npy", r16({0, 1, 2}))), 2, {"a.npy", ".npy"});
  expectRefusal(walk(fileOf("a.r32f", r32f({NAN, NAN, NAN, NAN}))), 2, {"a.r32f", "voids"});
  expectRefusal(walk(fileOf("a.xyz", r16({0, 1, 2}))), 2, {"a.xyz", ".hgt"});
  expectRefusal(walk("noise:"), 2, {"--terrain", "KEY=VALUE"});
  expectRefusal(walk("noise:height=3"), 2, {"--terrain", "height is no key of noise"});
  expectRefusal(walk("noise:amplitude=-1"), 2, {"--terrain", "amplitude", "-1"});
  expectRefusal(walk("noise:seed=1,seed=2"), 2, {"--terrain", "seed is given twice"});
  expectRefusal(walk("noise:seed"), 2, {"--terrain", "seed has no value"});
  expectRefusal(walk("noise:columns=1"), 2, {"--terrain", "columns"});
}

}  // namespace
}  // namespace skitter::test
