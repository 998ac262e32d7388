#include "verdict.h"

#include <gtest/gtest.h>

#include <chrono>

#include "skitter/error.h"
#include "skitter/heightfield.h"
#include "skitter/model.h"
#include "skitter/rig_setup.h"

namespace skitter::test {

Verdict verdictOf(const std::filesystem::path& file) {
  try {
    if (file.extension() == ".png") {
      loadHeightfield(file);
      return {"loads", ""};
    }
    const Model model = loadModel(file);
    proposeRig(model);
    std::string notes;
    for (const std::string& note : model.notes) notes += (notes.empty() ? "" : "; ") + note;
    return {notes.empty() ? "loads" : "notes", notes};
  } catch (const Error& refusal) {
    EXPECT_EQ(refusal.kind(), Error::Kind::input);
    return {"refused", refusal.what()};
  }
}

void expectVerdict(const std::filesystem::path& file, const Verdict& expected) {
  SCOPED_TRACE(file);
  const auto start = std::chrono::steady_clock::now();
  const Verdict got = verdictOf(file);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << "hangs";
  EXPECT_EQ(got.word, expected.word) << got.fault;
  EXPECT_NE(got.fault.find(expected.fault), std::string::npos)
      << got.fault << "\nexpected: " << expected.fault;
  EXPECT_EQ(got.fault.find('\n'), std::string::npos) << got.fault;
  if (got.word != "refused") return;
  EXPECT_NE(got.fault.find(file.filename().string()), std::string::npos) << got.fault;
}

}  // namespace skitter::test
