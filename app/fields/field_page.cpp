#include "app/fields/field_page.h"

#include <fmt/format.h>

namespace skitter::app {
namespace {

constexpr const char* pageStyle = R"(
body { font: 16px/1.5 system-ui, sans-serif; color: #222429; background: #f4f5f7; margin: 0 auto; padding: 1.5rem; max-width: 78rem; }
h1 { font-size: 1.7rem; margin: 0; } h2 { font-size: 1.2rem; margin: 0 0 .8rem; }
header p { margin: .2rem 0 1.5rem; color: #565a63; }
section { background: #fff; border: 1px solid #dcdfe4; border-radius: 8px; padding: 1.2rem; margin-bottom: 1.5rem; }
.row { display: flex; flex-wrap: wrap; gap: 1.2rem; }
.row a { flex: 3 1 32rem; } .row div { flex: 1 1 15rem; }
img { width: 100%; height: auto; display: block; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; }
th, td { text-align: left; padding: .25rem .4rem; border-bottom: 1px solid #e6e8ec; font-weight: normal; vertical-align: top; }
th { color: #565a63; } td { text-align: right; font-variant-numeric: tabular-nums; }
.caption { font-size: .92rem; color: #3c4048; }
)";

std::string forHtml(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '&'   ? "&amp;"
            : c == '<' ? "&lt;"
            : c == '>' ? "&gt;"
            : c == '"' ? "&quot;"
                       : std::string(1, c);
  return safe;
}

std::string sectionOf(const PageFigure& figure) {
  std::string rows;
  for (const auto& [name, value] : figure.facts)
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", forHtml(name), forHtml(value));
  return fmt::format(
      "<section>\n<h2>{0}</h2>\n<div class=\"row\">\n<a href=\"{1}\"><img src=\"{1}\" alt=\"{2}\"></a>\n"
      "<div><p class=\"caption\">{3}</p>\n<table>\n{4}</table></div>\n</div>\n</section>\n",
      forHtml(figure.heading), forHtml(figure.picture), forHtml(figure.alternative), forHtml(figure.caption),
      rows);
}

}  // namespace

std::string fieldPage(const std::string& title, const std::string& subtitle,
                      std::span<const PageFigure> figures) {
  std::string sections;
  for (const PageFigure& figure : figures) sections += sectionOf(figure);
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n"
      "<body>\n<header><h1>{0}</h1>\n<p>{2}</p></header>\n{3}</body>\n</html>\n",
      forHtml(title), pageStyle, forHtml(subtitle), sections);
}

}  // namespace skitter::app
