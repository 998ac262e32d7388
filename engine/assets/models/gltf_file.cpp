#include "assets/models/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "assets/files/file.h"
#include "assets/files/json.h"
#include "skitter/error.h"

namespace skitter::gltf {
namespace {

constexpr size_t maxBuffers = 1024;
constexpr uint64_t maxBufferBytes = uint64_t{1} << 31;  // of all buffers

uint32_t readWord(std::span<const uint8_t> bytes, size_t offset) {
  return static_cast<uint32_t>(bytes[offset]) | static_cast<uint32_t>(bytes[offset + 1]) << 8 |
         static_cast<uint32_t>(bytes[offset + 2]) << 16 | static_cast<uint32_t>(bytes[offset + 3]) << 24;
}

// The chunks of a binary file (glTF 2.0 specification, section 4.4).
struct Chunks {
  std::string_view json;
  std::span<const uint8_t> binary;
};

constexpr const char* olderFormat = ": gltf-pipeline converts glTF 1.0 to 2.0";

// Chunks say their own sizes. The header's may be wrong where a program has changed the file since.
Chunks splitChunks(std::span<const uint8_t> glb, const std::string& name, std::vector<std::string>& notes) {
  constexpr uint32_t jsonType = 0x4e4f534a, binaryType = 0x004e4942;
  if (glb.size() >= 8 && readWord(glb, 4) != 2) {
    throw inputError(fmt::format("{}: is glTF binary version {}, expected 2{}", name, readWord(glb, 4),
                                 readWord(glb, 4) == 1 ? olderFormat : ""));
  }
  if (glb.size() < 20) {
    throw inputError(fmt::format("{}: ends after {} bytes, within the header of {}", name, glb.size(),
                                 glb.size() < 12 ? "the file" : "its first chunk"));
  }
  const size_t length = readWord(glb, 8);
  const size_t end = length < 20 ? glb.size() : std::min(length, glb.size());
  Chunks chunks;
  size_t offset = 12;
  while (offset + 8 <= end) {
    const size_t size = readWord(glb, offset);
    const uint32_t type = readWord(glb, offset + 4);
    const bool first = offset == 12;
    offset += 8;
    if (size > glb.size() - offset) {
      throw inputError(
          fmt::format("{}: is cut off: a chunk of {} bytes has only {} left; its header says {} bytes, the "
                      "file has {}",
                      name, size, glb.size() - offset, length, glb.size()));
    }
    if (first != (type == jsonType)) {
      throw inputError(fmt::format("{}: its first chunk, and only that, must be JSON", name));
    }
    if (first) chunks.json = {reinterpret_cast<const char*>(glb.data()) + offset, size};
    if (type == binaryType && chunks.binary.empty()) chunks.binary = glb.subspan(offset, size);
    offset += size;
  }
  if (offset != length)
    notes.push_back(
        fmt::format("its header says {} bytes, its chunks end after {}: the chunks count", length, offset));
  return chunks;
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// RFC 4648; false where the text is something else.
bool decodeBase64(std::string_view text, std::vector<uint8_t>& bytes) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    int value = -1;
    if (c >= 'A' && c <= 'Z') value = c - 'A';
    if (c >= 'a' && c <= 'z') value = c - 'a' + 26;
    if (c >= '0' && c <= '9') value = c - '0' + 52;
    if (c == '+' || c == '-') value = 62;
    if (c == '/' || c == '_') value = 63;
    if (value < 0) return false;
    bits = bits << 6 | static_cast<uint32_t>(value);
    held += 6;
    if (held >= 8) bytes.push_back(static_cast<uint8_t>(bits >> (held -= 8)));
  }
  return held != 6;
}

void expectThere(uint64_t wanted, uint64_t there, const std::string& what) {
  if (wanted <= there) return;
  throw inputError(fmt::format("{} has {} bytes, its byteLength says {}", what, there, wanted));
}

// A model must not read what its user did not hand over with it, by ".." or by a symbolic link either.
bool leavesFolder(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code unresolved;  // FileStream says better what is wrong with such a file
  const auto root = std::filesystem::weakly_canonical(folder, unresolved);
  const auto inside = std::filesystem::weakly_canonical(folder / file, unresolved).lexically_relative(root);
  return !unresolved && (inside.empty() || *inside.begin() == "..");
}

// The escapes of an URI are undone, but for names that hold a % as it is. Its backslashes separate folders as
// its writer's system has them, unless a file has them in its name. Whether it may be read is not checked.
std::filesystem::path fileOf(const std::filesystem::path& folder, const std::string& uri) {
  const std::string decoded = decodeUri(uri);
  std::string slashed = decoded;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  std::error_code none;
  for (const std::string& name : {decoded, slashed, uri})
    if (name.find('\0') == std::string::npos && std::filesystem::exists(folder / name, none)) return name;
  return slashed;
}

FileStream openBeside(const std::filesystem::path& folder, const std::string& uri, const std::string& what) {
  const std::string refersTo = fmt::format("{} refers to {}", what, describeJson(uri));
  if (folder.empty()) throw inputError(refersTo + ", expected everything in one file");
  const std::filesystem::path file = fileOf(folder, uri);
  if (uri.find(':') != std::string::npos || file.is_absolute() ||
      file.native().find('\0') != std::string::npos || leavesFolder(folder, file)) {
    throw inputError(refersTo + ", expected a file in its folder");
  }
  try {
    return FileStream(folder / file);
  } catch (const Error& error) {
    throw inputError(fmt::format("{}: {}", refersTo, error.what()));
  }
}

bool isData(const std::string& uri) { return uri.rfind("data:", 0) == 0; }

std::vector<uint8_t> readData(const std::string& uri, const std::string& what) {
  std::vector<uint8_t> bytes;
  const size_t comma = uri.find(',');
  if (comma == std::string::npos || comma < 12 || uri.compare(comma - 7, 7, ";base64") != 0 ||
      !decodeBase64(std::string_view(uri).substr(comma + 1), bytes)) {
    throw inputError(fmt::format("{}: its data: URI is not base64", what));
  }
  return bytes;
}

// Where the bytes of one buffer come from.
class BufferReader {
 public:
  BufferReader(std::span<const uint8_t> binary, const std::string& name, const std::filesystem::path& folder)
      : binary_(binary), name_(name), folder_(folder) {}

  std::vector<uint8_t> read(const nlohmann::json& buffer, size_t index) const {
    const std::string what = fmt::format("{}: buffers[{}]", name_, index);
    if (!buffer.is_object())
      throw inputError(fmt::format("{} is {}, expected an object", what, describeJson(buffer)));
    const auto length = buffer.find("byteLength");
    if (length == buffer.end() || !length->is_number_unsigned()) {
      throw inputError(fmt::format("{}.byteLength is {}, expected a whole number", what,
                                   length == buffer.end() ? "missing" : describeJson(*length)));
    }
    const auto wanted = length->get<uint64_t>();
    if (wanted == 0) return {};  // an empty buffer is legal until something reads it
    const auto uri = buffer.find("uri");
    if (uri == buffer.end()) {
      if (index > 0 || binary_.empty()) return {};
      expectThere(wanted, binary_.size(), what);
      return {binary_.begin(), binary_.begin() + static_cast<std::ptrdiff_t>(wanted)};
    }
    if (!uri->is_string()) {
      throw inputError(fmt::format("{}.uri is {}, expected a string", what, describeJson(*uri)));
    }
    const std::string& address = uri->get_ref<const std::string&>();
    if (!isData(address)) {
      FileStream stream = openBeside(folder_, address, what);
      expectThere(wanted, stream.size(), what);
      std::vector<uint8_t> bytes(wanted);
      stream.read(bytes.data(), bytes.size());
      return bytes;
    }
    std::vector<uint8_t> bytes = readData(address, what);
    expectThere(wanted, bytes.size(), what);
    bytes.resize(wanted);
    return bytes;
  }

 private:
  std::span<const uint8_t> binary_;
  const std::string& name_;
  const std::filesystem::path& folder_;
};

// glTF 1.0 has objects, keyed by names, where 2.0 has arrays, and may leave its version out.
void checkVersion(const nlohmann::json& json, const std::string& name) {
  const auto asset = json.find("asset");
  const auto version = asset != json.end() && asset->is_object() ? asset->find("version") : json.end();
  const bool has = asset != json.end() && asset->is_object() && version != asset->end();
  std::string number;
  if (has) number = version->is_string() ? version->get<std::string>() : version->dump();
  if (number == "2" || number.starts_with("2.")) return;
  const auto isKeyed = [&](const char* key) { return json.contains(key) && json.at(key).is_object(); };
  const bool older = number == "1" || number.starts_with("1.") ||
                     (!has && (isKeyed("buffers") || isKeyed("nodes") || isKeyed("meshes")));
  throw inputError(fmt::format("{}: its asset.version is {}, expected 2.x{}", name,
                               has ? describeJson(*version) : "missing", older ? olderFormat : ""));
}

// One file may serve every buffer, so that little on disk asks for much memory.
void checkTotal(const nlohmann::json& buffers, const std::string& name) {
  uint64_t total = 0;
  for (const nlohmann::json& buffer : buffers) {
    const auto length = buffer.is_object() ? buffer.find("byteLength") : buffer.end();
    if (!buffer.is_object() || length == buffer.end() || !length->is_number_unsigned()) continue;
    total += std::min(length->get<uint64_t>(), maxBufferBytes + 1);
  }
  if (total > maxBufferBytes) {
    throw inputError(fmt::format("{}: its buffers' byteLengths are over {} in all", name, maxBufferBytes));
  }
}

}  // namespace

std::string unpackHint(const std::string& extension) {
  return fmt::format("is packed by {}, which is not read: `gltf-transform cp IN OUT` writes it unpacked",
                     extension);
}

std::string decodeUri(const std::string& uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool escape =
        uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0;
    text.push_back(escape ? static_cast<char>(hexDigit(uri[i + 1]) * 16 + hexDigit(uri[i + 2])) : uri[i]);
    if (escape) i += 2;
  }
  return text;
}

std::vector<uint8_t> readUri(const File& file, const std::string& uri, const std::string& what) {
  if (isData(uri)) return readData(uri, what);
  FileStream stream = openBeside(file.folder, uri, what);
  if (stream.size() > maxBufferBytes)
    throw inputError(
        fmt::format("{} has {} bytes, expected at most {}", what, stream.size(), maxBufferBytes));
  std::vector<uint8_t> bytes(stream.size());
  stream.read(bytes.data(), bytes.size());
  return bytes;
}

namespace {

// Names the format of a file that is no glTF, if its first bytes show it, and the way out.
const char* otherKind(std::string_view bytes) {
  constexpr std::pair<std::string_view, const char*> kinds[] = {
      {"\x1f\x8b", "gzip: unpack it"},
      {"PK\x03\x04", "ZIP: unpack it"},
      {"Kaydara FBX Binary", "FBX: Blender or FBX2glTF converts it"},
      {"; FBX", "FBX: Blender or FBX2glTF converts it"},
      {"BLENDER", "a Blender file: export it as glTF 2.0"},
      {"PXR-USDC", "USD: Blender converts it"},
      {"<", "HTML or XML, as a download may be that failed"},
      {"\xff\xfe", "UTF-16, expected UTF-8"},
      {"\xfe\xff", "UTF-16, expected UTF-8"}};
  for (const auto& [start, kind] : kinds)
    if (bytes.starts_with(start)) return kind;
  return nullptr;
}

}  // namespace

File openFile(std::span<const uint8_t> bytes, const std::string& name, const std::filesystem::path& folder) {
  File file;
  file.folder = folder;
  Chunks chunks;
  if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) {
    chunks = splitChunks(bytes, name, file.notes);
  } else {
    // A text file begins with the brace of its one object, after a byte order mark or blanks at most.
    chunks.json = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    if (chunks.json.rfind("\xef\xbb\xbf", 0) == 0) chunks.json.remove_prefix(3);
    const size_t start = chunks.json.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos || chunks.json[start] != '{') {
      if (const char* kind = otherKind(chunks.json.substr(std::min(start, chunks.json.size()))))
        throw inputError(fmt::format("{}: is not glTF but {}", name, kind));
      throw inputError(fmt::format(
          "{}: is not glTF: begins neither with a binary file's signature nor with a brace", name));
    }
  }
  file.json = parseJson(chunks.json, name);
  if (!file.json.is_object()) throw inputError(fmt::format("{}: its JSON is not an object", name));
  checkVersion(file.json, name);
  const auto buffers = file.json.find("buffers");
  if (buffers == file.json.end()) return file;
  if (!buffers->is_array() || buffers->size() > maxBuffers) {
    throw inputError(fmt::format("{}: buffers is {}, expected an array of up to {}", name,
                                 describeJson(*buffers), maxBuffers));
  }
  checkTotal(*buffers, name);
  const BufferReader reader(chunks.binary, name, folder);
  for (size_t i = 0; i < buffers->size(); ++i) file.buffers.push_back(reader.read((*buffers)[i], i));
  return file;
}

}  // namespace skitter::gltf
