// Files with one fault each, and odd ones without. Faults of references, bounds and numbers within the
// document are those of Rig.FaultsOfTheFile and of model_test.cpp; here is what else people's files have been
// seen to do.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstring>
#include <functional>
#include <limits>

#include "files.h"
#include "glb_builder.h"
#include "height_bytes.h"
#include "skitter/heightfield.h"
#include "verdict.h"

namespace skitter {
namespace {

using test::Glb;
using test::Verdict;
using Bytes = std::vector<uint8_t>;
using Json = nlohmann::json;

Json& primitive(Glb& glb) { return glb.json["meshes"][0]["primitives"][0]; }

void nod(Glb& glb) { glb.animate(3, "translation", "LINEAR", {0, 1}, {1, 0, 0, 2, 0, 0}); }

// A sparse accessor of positions: one is replaced, the one that `index` says.
void replacePosition(Glb& glb, uint16_t index) {
  glb.append(std::vector<uint16_t>{index}, "SCALAR");
  glb.append(std::vector<float>{7, 8, 9}, "VEC3");
  glb.json["accessors"][0]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", 4}}}};
}

TEST(BrokenFiles, Documents) {
  struct Case {
    const char* name;
    std::function<void(Glb&)> change;
    Verdict verdict;
  };
  const std::vector<Case> cases = {
      {"version",
       [](Glb& g) { g.json["asset"]["version"] = "1.0.1-dev"; },
       {"refused", "asset.version is \"1.0.1-dev\""}},
      {"accessor_empty",
       [](Glb& g) { g.json["accessors"].push_back(Json::object()); },
       {"refused", "'componentType' property is missing in Accessor"}},
      {"view_empty",
       [](Glb& g) { g.json["bufferViews"].push_back(Json::object()); },
       {"refused", "'buffer' property is missing in BufferView"}},
      {"stride_odd", [](Glb& g) { g.json["bufferViews"][0]["byteStride"] = 5; }, {"refused", "byteStride"}},
      {"stride_small",
       [](Glb& g) { g.json["bufferViews"][0]["byteStride"] = 8; },
       {"refused", "has a stride of 8, its elements 12 bytes"}},
      {"buffer_empty",
       [](Glb& g) { g.json["buffers"][0]["byteLength"] = 0; },
       {"refused", "bufferViews[0] is of buffers[0], which has no data"}},
      {"buffer_without_data",
       [](Glb& g) {
         g.json["buffers"].push_back({{"byteLength", 36}});
         g.json["bufferViews"][0]["buffer"] = 1;
       },
       {"refused", "bufferViews[0] is of buffers[1], which has no data"}},
      {"no_position",
       [](Glb& g) { primitive(g)["attributes"].erase("POSITION"); },
       {"notes", "has no POSITION: left out"}},
      {"counts_differ",
       [](Glb& g) { primitive(g)["attributes"]["COLOR_0"] = g.append(std::vector<float>(8), "VEC4"); },
       {"refused", "COLOR_0 has 2 vertices, POSITION 3"}},
      {"index_too_large",
       [](Glb& g) {
         primitive(g)["indices"] = g.append(std::vector<uint16_t>{0, 1, 5}, "SCALAR");
       },
       {"refused", "indices holds 5, but there are 3 vertices"}},
      {"indices_cut",
       [](Glb& g) {
         primitive(g)["indices"] = g.append(std::vector<uint16_t>{0, 1}, "SCALAR");
       },
       {"refused", "has 2 indices, no multiple of 3"}},
      {"indices_unresolved",
       [](Glb& g) { primitive(g)["indices"] = 77; },
       {"refused", "meshes[0].primitives[0].indices is 77, but there are 3 of these"}},
      {"mode_unknown", [](Glb& g) { primitive(g)["mode"] = 9; }, {"refused", "has mode 9, expected 0 to 6"}},
      {"skin_empty",
       [](Glb& g) { g.json["skins"][0] = Json::object(); },
       {"refused", "skins[0].joints is missing, expected an array of indices"}},
      {"bind_matrices_cut",
       [](Glb& g) { g.json["skins"][0]["inverseBindMatrices"] = g.append(std::vector<float>(16), "MAT4"); },
       {"refused", "has 1 inverse bind matrices for 4 joints"}},
      {"sparse_index", [](Glb& g) { replacePosition(g, 3); }, {"refused", "replaces element 3 of 3"}},
      {"sparse_count",
       [](Glb& g) {
         replacePosition(g, 2);
         g.json["accessors"][0]["sparse"]["count"] = 2;
       },
       {"refused", "reaches past"}},
      {"position_infinite",
       [](Glb& g) {
         const float infinity = std::numeric_limits<float>::infinity();
         std::memcpy(g.data(0), &infinity, 4);
       },
       {"refused", "holds inf in element 0"}},
      {"clip_input_unresolved",
       [](Glb& g) {
         nod(g);
         g.json["animations"][0]["samplers"][0]["input"] = 9;
       },
       {"notes", "animations[0].samplers[0].input is 9, but there are 5 of these: clip left out"}},
      {"clip_output_type",
       [](Glb& g) {
         nod(g);
         g.json["animations"][0]["samplers"][0]["output"] = 3;
       },
       {"notes", "has the wrong type: clip left out"}},
      {"clip_target_twice",
       [](Glb& g) {
         nod(g);
         nod(g);
       },
       {"notes", "animations[0] has two channels of the translation of nodes[3]: the later counts"}},
      {"clip_of_morphs",
       [](Glb& g) {
         nod(g);
         g.json["animations"][0]["channels"][0]["target"]["path"] = "weights";
         g.json["animations"][0]["samplers"][0]["output"] = 3;  // numbers, as weights are
       },
       {"notes", "animations[0] has 1 channels of morph weights: left out"}},
      {"morph_targets",
       [](Glb& g) {
         primitive(g)["targets"] = {{{"POSITION", 0}}};
       },
       {"notes", "meshes[0].primitives[0] has morph targets: not applied"}},
      {"points",
       [](Glb& g) {
         g.json["meshes"][0]["primitives"].push_back(primitive(g));
         primitive(g)["mode"] = 0;
       },
       {"notes", "is points or lines (mode 0): left out"}},
      {"roots",
       [](Glb& g) {
         g.json["nodes"][3].erase("children");
         g.json["scenes"][0]["nodes"].push_back(4);
       },
       {"notes", "the joints have 2 roots"}},
      {"unnamed",
       [](Glb& g) { g.node("foot").erase("name"); },
       {"notes", "1 joints have no name: #INDEX stands for it"}},
      // An accessor to which nothing refers is not read.
      {"unused_accessor",
       [](Glb& g) {
         g.json["accessors"].push_back(g.json["accessors"][0]), g.json["accessors"][3]["count"] = 99;
       },
       {"loads", ""}},
      {"unused_texture",
       [](Glb& g) {
         g.json["textures"] = {{{"source", 5}}};
       },
       {"loads", ""}},
      {"foreign_keys",
       [](Glb& g) { g.json["extras"] = 7, g.json["nodes"][1]["colour"] = "red"; },
       {"loads", ""}},
  };
  test::TemporaryFolder folder;
  for (const Case& broken : cases) {
    for (const char* kind : {".glb", ".gltf"}) {
      Glb glb = test::smallestRig();
      broken.change(glb);
      glb.write(folder / (broken.name + std::string(kind)));
      test::expectVerdict(folder / (broken.name + std::string(kind)), broken.verdict);
    }
  }
}

TEST(BrokenFiles, Containers) {
  struct Case {
    const char* name;
    std::function<void(Bytes&)> change;
    Verdict verdict;
  };
  const auto text = [](const char* words) {
    return [words](Bytes& bytes) { bytes.assign(words, words + std::strlen(words)); };
  };
  constexpr size_t versionAt = 4, lengthAt = 8, chunkAt = 12, typeAt = 16;
  const auto resize = [](Bytes& bytes, size_t size) {
    bytes.resize(size);
    bytes[lengthAt] = static_cast<uint8_t>(size);
    bytes[lengthAt + 1] = static_cast<uint8_t>(size >> 8);
  };
  const std::vector<Case> cases = {
      {"empty.glb", [](Bytes& b) { b.clear(); }, {"refused", "is empty"}},
      {"signature.glb", [](Bytes& b) { b[0] = 'G'; }, {"refused", "is not glTF"}},
      {"version.glb",
       [](Bytes& b) { b[versionAt] = 0; },
       {"refused", "is glTF binary version 0, expected 2"}},
      {"header.glb",
       [](Bytes& b) { b.resize(12); },
       {"refused", "ends after 12 bytes, within the header of its first chunk"}},
      {"length.glb", [](Bytes& b) { b.pop_back(); }, {"refused", "its header says"}},
      {"chunk.glb", [](Bytes& b) { b[chunkAt + 2] = 1; }, {"refused", "a chunk of"}},
      {"type.glb",
       [](Bytes& b) { b[typeAt] = 'B'; },
       {"refused", "its first chunk, and only that, must be JSON"}},
      {"tail.glb",
       [&](Bytes& b) { resize(b, b.size() + 4); },
       {"notes", "its header says 1048 bytes, its chunks end after 1044: the chunks count"}},
      {"two.glb",
       [&](Bytes& b) {
         const size_t at = b.size();
         resize(b, at + 8);
         std::memcpy(b.data() + at + 4, "JSON", 4);
       },
       {"refused", "its first chunk, and only that, must be JSON"}},
      {"json.glb", [](Bytes& b) { b[20] = '['; }, {"refused", "is not valid JSON:"}},
      {"behind.glb", [](Bytes& b) { b.push_back(0); }, {"loads", ""}},
      {"words.gltf", text("no model"), {"refused", "is not glTF"}},
      {"syntax.gltf", text("{\"asset\": {\"version\": \"2.0\"}"), {"refused", "is not valid JSON:"}},
      {"overflow.gltf",
       text("{\"asset\": {\"version\": \"2.0\"}, \"extras\": 1e309}"),
       {"refused", "number overflow"}},
      {"mark.gltf", text("\xef\xbb\xbf{\"asset\": {\"version\": \"2.0\"}}"), {"loads", ""}},
      {"bare.gltf", text("{}"), {"refused", "its asset.version is missing, expected 2.x"}},
  };
  test::TemporaryFolder folder;
  for (const Case& broken : cases) {
    Bytes bytes = test::smallestRig().bytes();
    broken.change(bytes);
    test::writeBytes(folder / broken.name, bytes);
    test::expectVerdict(folder / broken.name, broken.verdict);
  }
}

// A PNG, chunk by chunk.
struct Png {
  uint32_t columns = 8, rows = 8;
  uint8_t bits = 16, colour = 0, interlace = 0;
  Bytes before, between;  // chunks before the first and before the last part of the picture
  Bytes picture;          // rows, each after its filter

  static Bytes chunk(const std::string& type, const Bytes& data) {
    Bytes body(type.begin(), type.end());
    body.insert(body.end(), data.begin(), data.end());
    Bytes bytes;
    test::append(bytes, static_cast<uint32_t>(data.size()), true);
    bytes.insert(bytes.end(), body.begin(), body.end());
    test::append(bytes, static_cast<uint32_t>(crc32(0, body.data(), static_cast<uInt>(body.size()))), true);
    return bytes;
  }
  Bytes header() const {
    Bytes data;
    test::append(data, columns, true);
    test::append(data, rows, true);
    data.insert(data.end(), {bits, colour, 0, 0, interlace});
    return chunk("IHDR", data);
  }
  Bytes deflated() const {
    uLongf size = compressBound(picture.size());
    Bytes packed(size);
    EXPECT_EQ(compress(packed.data(), &size, picture.data(), picture.size()), Z_OK);
    packed.resize(size);
    return packed;
  }
  Bytes bytes() const {
    return joined({header(), before, chunk("IDAT", deflated()), between, chunk("IEND", {})});
  }

  static Bytes joined(const std::vector<Bytes>& parts) {
    Bytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (const Bytes& part : parts) bytes.insert(bytes.end(), part.begin(), part.end());
    return bytes;
  }
};

uint16_t codeAt(uint32_t x, uint32_t y) { return static_cast<uint16_t>(7919 * (x + 8 * y)); }

// The picture of codeAt, sample by sample of `more` other values behind the grey.
Png ramp(size_t more = 0) {
  Png png;
  for (uint32_t y = 0; y < png.rows; ++y) {
    png.picture.push_back(0);
    for (uint32_t x = 0; x < png.columns; ++x) {
      test::append(png.picture, codeAt(x, y), true);
      png.picture.insert(png.picture.end(), 2 * more, 0x55);
    }
  }
  return png;
}

// The same in the seven passes of Adam7 (PNG specification, section 8.2).
Png interlaced() {
  struct Pass {
    uint32_t x, y, right, down;
  };
  Png png;
  png.interlace = 1;
  for (const Pass& pass : {Pass{0, 0, 8, 8}, Pass{4, 0, 8, 8}, Pass{0, 4, 4, 8}, Pass{2, 0, 4, 4},
                           Pass{0, 2, 2, 4}, Pass{1, 0, 2, 2}, Pass{0, 1, 1, 2}}) {
    for (uint32_t y = pass.y; y < png.rows; y += pass.down) {
      png.picture.push_back(0);
      for (uint32_t x = pass.x; x < png.columns; x += pass.right)
        test::append(png.picture, codeAt(x, y), true);
    }
  }
  return png;
}

Png withAlpha() {
  Png png = ramp(1);
  png.colour = 4;
  return png;
}

Bytes changed(Bytes bytes, size_t at) {
  bytes[at] ^= 1;
  return bytes;
}

TEST(BrokenFiles, Pictures) {
  const auto with = [](auto change, size_t more = 0) {
    Png png = ramp(more);
    change(png);
    return png.bytes();
  };
  const Bytes whole = ramp().bytes();
  const Bytes header = ramp().header(), data = Png::chunk("IDAT", ramp().deflated()),
              end = Png::chunk("IEND", {});
  constexpr size_t headerSumAt = 29, dataAt = 41;
  const auto lineEnds = [](Bytes bytes) {
    std::erase(bytes, '\r');
    return bytes;
  };
  struct Case {
    const char* name;
    Bytes bytes;
    Verdict verdict;
  };
  const std::vector<Case> cases = {
      {"whole", whole, {"loads", ""}},
      {"line_ends", lineEnds(whole), {"refused", "is not a PNG (wrong signature)"}},
      {"seven_bits", changed(whole, 0), {"refused", "is not a PNG (wrong signature)"}},
      {"header_sum", changed(whole, headerSumAt), {"refused", "corrupt PNG: IHDR: CRC error"}},
      {"data_sum", changed(whole, dataAt + data.size() - 12), {"refused", "corrupt PNG: "}},
      {"data_bit", changed(whole, dataAt + 20), {"refused", "corrupt PNG: "}},
      {"no_columns", with([](Png& p) { p.columns = 0; }), {"refused", "corrupt PNG: Invalid IHDR data"}},
      {"three_bits", with([](Png& p) { p.bits = 3; }), {"refused", "corrupt PNG: Invalid IHDR data"}},
      {"colour_type", with([](Png& p) { p.colour = 1; }), {"refused", "corrupt PNG: Invalid IHDR data"}},
      {"one_bit", with([](Png& p) { p.bits = 1; }), {"refused", "has 1-bit grey, expected 8 or 16"}},
      {"colour", with([](Png& p) { p.colour = 2; }, 2), {"refused", "is a colour PNG, expected grey"}},
      {"colour_alpha", with([](Png& p) { p.colour = 6; }, 3), {"refused", "is a colour PNG, expected grey"}},
      {"palette",
       with([](Png& p) {
         p.bits = 8;
         p.colour = 3;
         p.before = Png::chunk("PLTE", {1, 2, 3});
       }),
       {"refused", "is a palette colour PNG, expected grey"}},
      {"no_data", Png::joined({header, end}), {"refused", "corrupt PNG: IEND: out of place"}},
      {"no_end", Png::joined({header, data}), {"refused", "corrupt PNG: the file ends too early"}},
      {"chunk_cut",
       Bytes(whole.begin(), whole.end() - 20),
       {"refused", "corrupt PNG: the file ends too early"}},
      {"no_header", Png::joined({data, end}), {"refused", "corrupt PNG: "}},
      {"rows_missing",
       with([](Png& p) { p.picture.resize(p.picture.size() - 17); }),
       {"refused", "corrupt PNG: "}},
      {"filter",
       with([](Png& p) { p.picture[0] = 9; }),
       {"refused", "corrupt PNG: bad adaptive filter value"}},
      {"gamma",
       with([](Png& p) {
         p.before = Png::chunk("gAMA", {0, 0, 0x80, 0});
       }),
       {"loads", ""}},
      {"transparent",
       with([](Png& p) {
         p.before = Png::chunk("tRNS", {0, 7});
       }),
       {"loads", ""}},
      {"unknown",
       with([](Png& p) {
         p.between = Png::chunk("skIt", {1, 2, 3});
       }),
       {"loads", ""}},
      {"alpha", withAlpha().bytes(), {"loads", ""}},
      {"interlaced", interlaced().bytes(), {"loads", ""}},
  };
  test::TemporaryFolder folder;
  for (const Case& broken : cases) {
    const std::filesystem::path file = folder / (broken.name + std::string(".png"));
    test::writeBytes(file, broken.bytes);
    test::expectVerdict(file, broken.verdict);
  }
  const Heightfield plain = loadHeightfield(folder / "whole.png");
  for (const char* same : {"gamma.png", "transparent.png", "unknown.png", "alpha.png", "interlaced.png"})
    EXPECT_EQ(loadHeightfield(folder / same).heights, plain.heights) << same;
}

}  // namespace
}  // namespace skitter
