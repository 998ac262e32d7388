#include "experiments/page/page.h"

#include <gtest/gtest.h>

namespace skitter::experiments {
namespace {

std::string encoded(const std::string& text) { return base64(std::as_bytes(std::span(text))); }

// RFC 4648, section 10.
TEST(Page, Base64) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe\xfd"), "//79");
}

TEST(Page, NothingOfTheTextIsMarkup) {
  Page page("a < b", "c & d");
  page.section("one", "x > y");
  page.paragraph("<script>");
  page.table({{"<th>"}, {{"\"quoted\""}}});
  const std::string html = page.html();
  for (const char* words :
       {"a &lt; b", "c &amp; d", "x &gt; y", "&lt;script&gt;", "&lt;th&gt;", "&quot;quoted&quot;"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  EXPECT_EQ(html.find("<script"), std::string::npos);
}

TEST(Page, RawFilesAreLinksAndWarningsAreSeen) {
  Page page("t", "s");
  page.section("one", "first");
  page.warning("too < busy");
  page.raw("a&b.csv");
  const std::string html = page.html();
  EXPECT_NE(html.find("<a href=\"a&amp;b.csv\">a&amp;b.csv</a>"), std::string::npos);
  EXPECT_NE(html.find("<p class=\"warning\">too &lt; busy</p>"), std::string::npos);
}

TEST(Page, SectionsAreClosedAndLinkedTo) {
  Page page("t", "s");
  page.section("one", "first");
  page.section("two", "second");
  const std::string html = page.html();
  EXPECT_NE(html.find("<a href=\"#two\">second</a>"), std::string::npos);
  EXPECT_NE(html.find("<section id=\"one\">"), std::string::npos);
  const auto count = [&](const std::string& part) {
    size_t n = 0;
    for (size_t at = html.find(part); at != std::string::npos; at = html.find(part, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("<section"), count("</section>"));
}

}  // namespace
}  // namespace skitter::experiments
