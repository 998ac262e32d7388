#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fuzz.h"
#include "skitter/heightfield.h"

namespace {

// Sets the check sums of a PNG's chunks right.
void repairChunks(std::vector<uint8_t>& png) {
  const auto word = [&](size_t at) {
    return uint32_t{png[at]} << 24 | uint32_t{png[at + 1]} << 16 | uint32_t{png[at + 2]} << 8 | png[at + 3];
  };
  for (size_t at = 8; at + 12 <= png.size();) {
    const size_t length = word(at);
    if (length > png.size() - at - 12) return;
    const uLong sum = crc32(0, png.data() + at + 4, static_cast<uInt>(length + 4));
    for (size_t k = 0; k < 4; ++k) png[at + 8 + length + k] = static_cast<uint8_t>(sum >> (24 - 8 * k));
    at += 12 + length;
  }
}

}  // namespace

// The first byte chooses the format, which a height file tells by its name alone, and whether what random
// bytes nearly never get right is put right; the second is the length of the sidecar that follows, before the
// file.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace skitter;
  if (size < 2) return 0;
  const char* endings[] = {".png", ".npy", ".r16", ".r32f", "_N27E086.hgt"};
  const size_t format = data[0] % 5, sidecarBytes = std::min<size_t>(data[1], size - 2);
  std::vector<uint8_t> bytes(data + 2 + sidecarBytes, data + size);
  if (data[0] < 128) {
    if (format == 0) repairChunks(bytes);
    if (format == 4) bytes.resize(2 * 1201 * 1201, 1);
  }
  const fuzz::ScratchFile file(bytes.data(), bytes.size(), endings[format]);
  std::optional<fuzz::ScratchFile> sidecar;
  if (sidecarBytes > 0) sidecar.emplace(data + 2, sidecarBytes, format == 4 ? "_N27E086.json" : ".json");
  // Without its ending, because a fault may be the sidecar's.
  const std::string name = file.path().parent_path() / file.path().stem();
  fuzz::refuseOrRead(name, [&] {
    const Heightfield field = loadHeightfield(file.path());
    fuzz::expect(field.columns >= 2 && field.rows >= 2, "a field without cells");
    fuzz::expect(field.heights.size() == size_t{field.columns} * field.rows, "a field that is not whole");
    fuzz::expect(field.spacingX > 0 && field.spacingZ > 0, "a field without spacing");
    const auto isFinite = [](float height) { return std::isfinite(height); };
    fuzz::expect(std::all_of(field.heights.begin(), field.heights.end(), isFinite),
                 "a height that is not finite");
  });
  return 0;
}
