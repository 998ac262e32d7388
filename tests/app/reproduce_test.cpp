#include <csignal>
#include <fstream>
#include <sstream>

#include "process.h"

namespace skitter::test {
namespace {

// The command at a size at which its figures mean nothing; no time is judged.
struct Reproduce : AppTest {
  std::string text(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    std::stringstream all;
    all << in.rdbuf();
    return all.str();
  }
};

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// Cells of a line; quoted ones may hold commas.
size_t cells(const std::string& line) {
  size_t commas = 0;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) ++commas;
  }
  return commas + 1;
}

void expectTable(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line)) << name;
  const std::string manifest = "# manifest: ";
  ASSERT_TRUE(line.starts_with(manifest)) << name << ": " << line;
  EXPECT_EQ(nlohmann::json::parse(line.substr(manifest.size())).at("version"), "0.1.0") << name;
  ASSERT_TRUE(std::getline(lines, line)) << name;
  const size_t columns = cells(line);
  EXPECT_GT(columns, 1u) << name;
  while (std::getline(lines, line)) {
    if (line.starts_with("#")) continue;
    EXPECT_EQ(cells(line), columns) << name << ": " << line;
  }
  EXPECT_EQ(csv.find("nan"), std::string::npos) << name;
  EXPECT_EQ(csv.find("inf"), std::string::npos) << name;
}

// Keeps only the beginning of each picture and drawing: base64 may spell anything.
std::string withoutPictures(std::string html) {
  for (size_t at = html.find("base64,"); at != std::string::npos; at = html.find("base64,", at + 1))
    html.erase(at + 7, html.find('"', at) - at - 7);
  return html;
}

TEST_F(Reproduce, WritesOnePageAndItsRawFigures) {
  const Result result = skitter({"reproduce", "--frames", "20", "--out", file("page"), "--quiet"});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  // Other tests may run beside it.
  if (result.err.find("skitter: The machine did other work meanwhile") != 0) {
    EXPECT_EQ(result.err, "");
  }
  const std::string html = withoutPictures(text("page/index.html"));
  for (const char* section : {"conclusions", "setup", "figure-1", "figure-2", "figures-3-5", "figures-6-8",
                              "point-collection", "figures-9-11", "figures-12-14", "fidelity", "spiders"}) {
    EXPECT_EQ(count(html, std::string("<section id=\"") + section + "\">"), 1u) << section;
  }
  // The page is self-contained: it fetches nothing and runs nothing.
  for (const char* foreign : {"<script", "<link", "src=\"http", "href=\"http", "@import", "url("})
    EXPECT_EQ(html.find(foreign), std::string::npos) << foreign;
  for (const char* wrong : {">nan", "\"nan", ",nan", "nan,", ">inf", ",inf", "-nan"})
    EXPECT_EQ(html.find(wrong), std::string::npos) << wrong;
  EXPECT_EQ(count(html, "<svg"), count(html, "</svg>"));
  EXPECT_GT(count(html, "<svg"), 20u);
  EXPECT_EQ(count(html, "<img"), 5u);
  EXPECT_GT(count(html, "hold"), 5u);

  size_t tables = 0;
  for (const std::string& name : files()) {
    EXPECT_FALSE(name.ends_with(".part")) << name;
    if (!name.ends_with(".csv")) continue;
    ++tables;
    expectTable(text(name), name);
    EXPECT_NE(html.find(name.substr(5)), std::string::npos) << name << " is not told of";
  }
  EXPECT_GE(tables, 15u);
  for (const char* ground : {"flat", "rolling", "steep", "jacksboro", "everest"})
    EXPECT_EQ(count(text("page/fidelity.csv"), std::string("\n") + ground + ","), 5u) << ground;
}

TEST_F(Reproduce, RefusesAFolderThatIsNotEmpty) {
  write("mine.txt", "mine");
  expectRefusal(skitter({"reproduce", "--frames", "2", "--out", file("")}), 2,
                {"--out", "not empty", "--force"});
  EXPECT_EQ(files(), std::vector<std::string>{"mine.txt"});
}

TEST_F(Reproduce, RefusesWrongTerrains) {
  for (const char* terrain : {"hills", "=file.png", "hills="})
    expectRefusal(skitter({"reproduce", "--terrain", terrain, "--out", file("page")}), 2,
                  {"--terrain", "NAME=FILE"});
  expectRefusal(skitter({"reproduce", "--terrain", "hills=none.png", "--out", file("page")}), 2,
                {"none.png"});
  expectRefusal(skitter({"reproduce", "--terrain", "hills=none.png,0", "--out", file("page")}), 2, {"scale"});
  EXPECT_TRUE(files().empty());
}

TEST_F(Reproduce, InterruptedItLeavesNothing) {
  bool sent = false;
  const auto started = std::chrono::steady_clock::now();
  const Result result =
      skitter({"reproduce", "--quick", "--out", file("page"), "--quiet"}, {}, [&](int process) {
        // Signals are caught from the first line of main on; by then it surely runs.
        if (sent || std::chrono::steady_clock::now() - started < std::chrono::seconds(3)) return;
        kill(process, SIGINT);
        sent = true;
      });
  EXPECT_EQ(result.code, 130) << result.out;
  EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace skitter::test
