#include <fmt/format.h>

#include <charconv>
#include <map>
#include <string_view>

#include "assets/files/file.h"
#include "assets/heights/height_samples.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr size_t maxHeaderBytes = 65536;

struct NpyHeader {
  std::string descr;
  bool fortranOrder = false;
  std::vector<uint64_t> shape;
};

// The header is the text of a Python dictionary such as
// {'descr': '<f4', 'fortran_order': False, 'shape': (344, 403), }
// (NumPy Enhancement Proposal 1).
class HeaderText {
 public:
  HeaderText(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  NpyHeader read() {
    NpyHeader header;
    bool hasDescr = false, hasOrder = false, hasShape = false;
    const auto once = [&](bool& has, const char* key) {
      if (has) fail(fmt::format("{} appears twice", key));
      has = true;
    };
    expect('{');
    while (!accept('}')) {
      const std::string key = string();
      expect(':');
      if (key == "descr") {
        once(hasDescr, "descr");
        if (next() == '[') fail("descr is a structure");
        header.descr = string();
      } else if (key == "fortran_order") {
        once(hasOrder, "fortran_order");
        header.fortranOrder = boolean();
      } else if (key == "shape") {
        once(hasShape, "shape");
        header.shape = tuple();
      } else {
        fail(fmt::format("it has an unknown key of {} letters", key.size()));
      }
      if (!accept(',') && next() != '}') fail("a comma or } is missing");
    }
    if (next() != 0) fail("something follows its }");
    if (!hasDescr) fail("descr is missing");
    if (!hasOrder) fail("fortran_order is missing");
    if (!hasShape) fail("shape is missing");
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw inputError(fmt::format("{}: corrupt .npy header: {}", name_, what));
  }
  char next() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(char c) {
    if (next() != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(fmt::format("{} is missing", c));
  }
  std::string string() {
    const char quote = next();
    if (quote != '\'' && quote != '"') fail("a string is missing");
    const size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("a string does not end");
    const std::string value(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return value;
  }
  bool boolean() {
    next();
    for (const auto& [word, value] : {std::pair{"True", true}, {"False", false}}) {
      if (text_.substr(at_).starts_with(word)) {
        at_ += std::string_view(word).size();
        return value;
      }
    }
    fail("fortran_order is neither True nor False");
  }
  std::vector<uint64_t> tuple() {
    std::vector<uint64_t> values;
    expect('(');
    while (!accept(')')) {
      next();
      uint64_t value = 0;
      const char* from = text_.data() + at_;
      const auto [end, error] = std::from_chars(from, text_.data() + text_.size(), value);
      if (error != std::errc{}) fail("shape holds something that is no whole number");
      at_ += static_cast<size_t>(end - from);
      values.push_back(value);
      if (!accept(',') && next() != ')') fail("a comma or ) is missing");
    }
    return values;
  }

  std::string_view text_;
  std::string name_;
  size_t at_ = 0;
};

NpyHeader readHeader(FileStream& stream, const std::string& name, uint64_t& headerBytes) {
  constexpr size_t preamble = 8;
  uint8_t start[preamble + 4] = {};
  const std::string_view magic = "\x93NUMPY";
  if (stream.size() < preamble + 2) throw inputError(fmt::format("{}: is not a .npy file (too short)", name));
  stream.read(start, preamble);
  if (std::string_view(reinterpret_cast<const char*>(start), magic.size()) != magic) {
    throw inputError(fmt::format("{}: is not a .npy file (wrong signature)", name));
  }
  const int version = start[6];
  if (version < 1 || version > 3) {
    throw inputError(fmt::format("{}: is .npy version {}, expected 1 to 3", name, version));
  }
  const size_t lengthBytes = version == 1 ? 2 : 4;
  stream.read(start + preamble, lengthBytes);
  uint64_t length = 0;
  for (size_t k = 0; k < lengthBytes; ++k) length |= uint64_t{start[preamble + k]} << (8 * k);
  headerBytes = preamble + lengthBytes + length;
  if (length > maxHeaderBytes || headerBytes > stream.size()) {
    throw inputError(fmt::format("{}: corrupt .npy header: it claims {} bytes, expected at most {}", name,
                                 length,
                                 std::min<uint64_t>(maxHeaderBytes, stream.size() - preamble - lengthBytes)));
  }
  std::string text(length, '\0');
  stream.read(text.data(), text.size());
  return HeaderText(text, name).read();
}

SampleType typeOf(const std::string& descr, const std::string& name) {
  using Kind = SampleType::Kind;
  static const std::map<std::string_view, Kind> kinds = {{"u1", Kind::u1}, {"u2", Kind::u2},
                                                         {"i2", Kind::i2}, {"i4", Kind::i4},
                                                         {"f4", Kind::f4}, {"f8", Kind::f8}};
  const std::string_view order = "<>|";
  const auto found = descr.empty() ? kinds.end() : kinds.find(std::string_view(descr).substr(1));
  const bool isOrdered = !descr.empty() && order.find(descr[0]) != std::string_view::npos;
  // "|" stands for a type without byte order, which is a single byte.
  if (found == kinds.end() || !isOrdered || (descr[0] == '|' && found->second != Kind::u1)) {
    std::string printable;
    for (const char c : descr.substr(0, 16)) printable += c >= ' ' && c <= '~' ? c : '?';
    throw inputError(
        fmt::format("{}: holds samples of type \"{}\", expected u1, u2, i2, i4, f4 or f8 with a byte order",
                    name, printable));
  }
  return {found->second, descr[0] == '>'};
}

}  // namespace

StoredHeights readNpyHeights(const std::filesystem::path& file, std::optional<double> voidValue) {
  const std::string name = file.string();
  FileStream stream(file);
  uint64_t headerBytes = 0;
  const NpyHeader header = readHeader(stream, name, headerBytes);
  const SampleType type = typeOf(header.descr, name);
  checkVoidValue(name, type, voidValue);
  if (header.shape.size() != 2) {
    throw inputError(fmt::format("{}: is an array of {} dimensions, expected 2: rows and columns", name,
                                 header.shape.size()));
  }
  const uint64_t rows = header.shape[0], columns = header.shape[1];
  checkSampleCounts(name, columns, rows);
  const uint64_t expected = rows * columns * type.bytes(), found = stream.size() - headerBytes;
  if (found != expected) {
    throw inputError(fmt::format("{}: has {} bytes of samples, but {} x {} samples of {} bytes are {}", name,
                                 found, columns, rows, type.bytes(), expected));
  }

  StoredHeights samples{
      static_cast<uint32_t>(columns), static_cast<uint32_t>(rows), {}, type.isCode(), {}, {}};
  samples.values.resize(rows * columns);
  const uint64_t lines = header.fortranOrder ? columns : rows,
                 lineSamples = header.fortranOrder ? rows : columns;
  std::vector<uint8_t> bytes(lineSamples * type.bytes());
  std::vector<float> line(lineSamples);
  for (uint64_t j = 0; j < lines; ++j) {
    stream.read(bytes.data(), bytes.size());
    if (!header.fortranOrder) {
      decodeSamples(bytes.data(), lineSamples, type, voidValue, samples.values.data() + j * columns);
      continue;
    }
    decodeSamples(bytes.data(), lineSamples, type, voidValue, line.data());
    for (uint64_t i = 0; i < lineSamples; ++i) samples.values[i * columns + j] = line[i];
  }
  return samples;
}

}  // namespace skitter
