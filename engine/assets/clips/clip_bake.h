#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "assets/clips/clip_skin.h"

namespace skitter {

// What the clips of one file may take in all, so that no file takes minutes or gigabytes.
struct BakeBudget {
  size_t samples = size_t{1} << 26;   // of a node or an entry
  size_t matrices = size_t{1} << 21;  // stored
};

// What is baked of a file's clip: all of it, or from one time to another.
struct BakeRange {
  const gltf::Clip& clip;
  double begin = 0, end = 0;
};

// Frames, error, root velocity and box of a clip, and its feet; not yet its stance. `error` is what the
// frames may err, in metres. Throws Error(input) that begins with `what` where the clip cannot be had.
Clip bakeClip(const gltf::Document& document, const BakeRange& range, const ClipSkin& skin,
              const std::vector<ClipLeg>& legs, double error, const std::string& what, BakeBudget& budget);

}  // namespace skitter
