#include "experiments/page/page.h"

#include <fmt/format.h>

#include "experiments/page/svg.h"

namespace skitter::experiments {
namespace {

constexpr const char* style = R"(
body { font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin-bottom: 0.2rem; }
h2 { font-size: 1.3rem; margin-top: 2.8rem; border-bottom: 1px solid #ccc; }
h3 { font-size: 1.05rem; margin-top: 1.6rem; }
nav { columns: 2; font-size: 0.95rem; } nav a { display: block; }
a { color: #00558a; }
table { border-collapse: collapse; font-size: 0.82rem; margin: 0.8rem 0; }
th, td { padding: 0.22rem 0.45rem; text-align: left; border-bottom: 1px solid #ddd; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
thead th { border-bottom: 2px solid #888; }
tr.holds td.v { color: #00664a; font-weight: bold; } tr.fails td.v { color: #a33c00; font-weight: bold; }
.scroll { overflow-x: auto; }
figure { margin: 1rem 0; } figcaption { font-size: 0.9rem; color: #444; }
svg, img { max-width: 100%; height: auto; vertical-align: top; }
.raw { font-size: 0.85rem; color: #555; }
.warning { border-left: 4px solid #d55e00; padding-left: 0.6rem; }
)";

// Numbers are set flush right.
bool isNumber(const std::string& cell) {
  return !cell.empty() && cell.find_first_not_of("0123456789.+-e% <>,") == std::string::npos;
}

// Rows of verdicts are told by their words, and so are they coloured.
std::string rowClass(const std::vector<std::string>& row) {
  for (const std::string& cell : row) {
    if (cell == "holds") return " class=\"holds\"";
    if (cell == "does not hold") return " class=\"fails\"";
  }
  return "";
}

}  // namespace

Page::Page(std::string title, std::string subtitle)
    : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

void Page::section(const std::string& id, const std::string& text) {
  if (open_) body_ += "</section>\n";
  open_ = true;
  contents_ += fmt::format("<a href=\"#{}\">{}</a>\n", id, escaped(text));
  body_ += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", id, escaped(text));
}

void Page::heading(const std::string& text) { body_ += fmt::format("<h3>{}</h3>\n", escaped(text)); }
void Page::paragraph(const std::string& text) { body_ += fmt::format("<p>{}</p>\n", escaped(text)); }

void Page::facts(const std::vector<std::pair<std::string, std::string>>& rows) {
  body_ += "<table>\n";
  for (const auto& [name, value] : rows)
    body_ += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escaped(name), escaped(value));
  body_ += "</table>\n";
}

void Page::table(const Table& table) {
  body_ += "<div class=\"scroll\"><table>\n<thead><tr>";
  for (const std::string& name : table.head) body_ += fmt::format("<th scope=\"col\">{}</th>", escaped(name));
  body_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    body_ += fmt::format("<tr{}>", rowClass(row));
    for (const std::string& cell : row) {
      const bool verdict = cell == "holds" || cell == "does not hold";
      body_ += fmt::format("<td{}>{}</td>", verdict ? " class=\"v\"" : (isNumber(cell) ? " class=\"n\"" : ""),
                           escaped(cell));
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void Page::drawings(const std::vector<std::string>& svgs, const std::string& caption) {
  body_ += "<figure>\n";
  for (const std::string& svg : svgs) body_ += svg;
  body_ += fmt::format("<figcaption>{}</figcaption>\n</figure>\n", escaped(caption));
}

void Page::picture(std::span<const std::byte> png, const std::string& alternative,
                   const std::string& caption) {
  body_ += fmt::format(
      "<figure>\n<img alt=\"{}\" src=\"data:image/png;base64,{}\">\n<figcaption>{}</figcaption>\n</figure>\n",
      escaped(alternative), base64(png), escaped(caption));
}

void Page::warning(const std::string& text) {
  body_ += fmt::format("<p class=\"warning\">{}</p>\n", escaped(text));
}

void Page::raw(const std::string& file) {
  body_ += fmt::format("<p class=\"raw\">Raw figures: <a href=\"{0}\">{0}</a></p>\n", escaped(file));
}

std::string Page::html() const {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{}</title>\n<style>{}</style>\n</head>\n"
      "<body>\n<h1>{}</h1>\n<p>{}</p>\n<nav>\n{}</nav>\n{}{}</body>\n</html>\n",
      escaped(title_), style, escaped(title_), escaped(subtitle_), contents_, body_,
      open_ ? "</section>\n" : "");
}

std::string base64(std::span<const std::byte> bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t left = std::min<size_t>(3, bytes.size() - i);
    uint32_t three = 0;
    for (size_t k = 0; k < 3; ++k) three = three << 8 | (k < left ? static_cast<uint32_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= left ? digits[three >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

}  // namespace skitter::experiments
