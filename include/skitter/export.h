#pragma once

// Marks what the library shows. All else is hidden: engine and host may both hold Vulkan-Hpp, tinygltf or
// a JSON library, in versions of their own.
//
// SKITTER_API stands before the return type of a free function, and between `class` or `struct` and the name
// of a type whose functions are defined outside the header. SKITTER_LOCAL stands likewise at a type that is
// nested in one of these and that only the engine defines: else it would be shown with the type around it.
#define SKITTER_API __attribute__((visibility("default")))
#define SKITTER_LOCAL __attribute__((visibility("hidden")))
