#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace skitter::test {

struct Result {
  int code = -1;  // exit code; 128 + signal where one ended it
  std::string out, err;
};

using Environment = std::map<std::string, std::string>;  // an empty value unsets

// Runs a program; `whileRunning` is called again and again with its process id until it ends. DISPLAY and
// WAYLAND_DISPLAY are unset unless given.
Result runProgram(const std::vector<std::string>& command, const Environment& environment = {},
                  const std::function<void(int)>& whileRunning = {});

// The command under test, on SKITTER_TEST_DEVICE where that is set.
Result skitter(std::vector<std::string> arguments, const Environment& environment = {},
               const std::function<void(int)>& whileRunning = {});

// Whether a process handles the signal by now: a test must not send it before.
bool catches(int process, int signal);

// A folder of its own for each test, gone afterwards.
class AppTest : public ::testing::Test {
 protected:
  AppTest();
  ~AppTest() override;

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const;
  nlohmann::json json(const std::string& name) const;
  std::vector<std::string> files() const;  // all of them, sorted, relative

 private:
  std::filesystem::path folder_;
};

// One line on stderr that begins with "skitter: " and holds every word; nothing on stdout.
void expectRefusal(const Result& result, int code, const std::vector<std::string>& words);

}  // namespace skitter::test
