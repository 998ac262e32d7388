#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

// A glTF file taken apart: its JSON, and the bytes of its buffers wherever they lie.
namespace skitter::gltf {

struct File {
  nlohmann::json json;  // without `buffers` checked against anything
  std::vector<std::vector<uint8_t>>
      buffers;                     // one for each of the JSON's, as long as it says; empty: without data
  std::filesystem::path folder;    // of files that it refers to; empty: they are refused
  std::vector<std::string> notes;  // what is odd about the container
};

// Says of a file that is packed by an extension that is not read how to unpack it.
std::string unpackHint(const std::string& extension);

// A binary (.glb) or a text file (.gltf), told apart by its first bytes. Buffers are the binary chunk, data:
// URIs or files relative to `folder`; without a folder files are refused. Throws Error(input) that begins
// with `name`.
File openFile(std::span<const uint8_t> bytes, const std::string& name, const std::filesystem::path& folder);

// The bytes that an URI of the file refers to: a base64 data: URI, or a file in the folder, between whose
// names backslashes count as slashes. Throws Error(input) that begins with `what`.
std::vector<uint8_t> readUri(const File& file, const std::string& uri, const std::string& what);

// An URI with its %XX escapes undone.
std::string decodeUri(const std::string& uri);

}  // namespace skitter::gltf
