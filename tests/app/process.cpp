#include "process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

namespace skitter::test {
namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

fs::path makeFolder() {
  std::string name = (fs::temp_directory_path() / "skitter-app-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  return name;
}

[[noreturn]] void become(const std::vector<std::string>& command, const Environment& environment,
                         const fs::path& out, const fs::path& err) {
  if (!std::freopen(out.c_str(), "wb", stdout) || !std::freopen(err.c_str(), "wb", stderr)) _exit(126);
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  for (const auto& [name, value] : environment) {
    value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
  }
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

Result runProgram(const std::vector<std::string>& command, const Environment& environment,
                  const std::function<void(int)>& whileRunning) {
  const fs::path folder = makeFolder();
  const fs::path out = folder / "out", err = folder / "err";
  const pid_t child = fork();
  if (child == 0) become(command, environment, out, err);
  int status = 0;
  while (waitpid(child, &status, whileRunning ? WNOHANG : 0) == 0) {
    whileRunning(child);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  Result result{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readText(out),
                readText(err)};
  fs::remove_all(folder);
  return result;
}

Result skitter(std::vector<std::string> arguments, const Environment& environment,
               const std::function<void(int)>& whileRunning) {
  arguments.insert(arguments.begin(), SKITTER_BINARY);
  const bool choosesDevice = std::find(arguments.begin(), arguments.end(), "--device") != arguments.end();
  const char* device = std::getenv("SKITTER_TEST_DEVICE");
  if (device && !choosesDevice && arguments.size() > 1 && arguments[1][0] != '-') {
    arguments.insert(arguments.end(), {"--device", device});
  }
  return runProgram(arguments, environment, whileRunning);
}

bool catches(int process, int signal) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:"))
      return (std::stoull(line.substr(8), nullptr, 16) >> (signal - 1) & 1) != 0;
  return false;
}

AppTest::AppTest() : folder_(makeFolder()) {}
AppTest::~AppTest() { fs::remove_all(folder_); }

void AppTest::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

nlohmann::json AppTest::json(const std::string& name) const {
  return nlohmann::json::parse(readText(folder_ / name));
}

std::vector<std::string> AppTest::files() const {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder_).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void expectRefusal(const Result& result, int code, const std::vector<std::string>& words) {
  EXPECT_EQ(result.code, code) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err.rfind("skitter: ", 0), 0u) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  for (const std::string& word : words)
    EXPECT_NE(result.err.find(word), std::string::npos) << word << "\n" << result.err;
}

}  // namespace skitter::test
