#pragma once

// The one way to reach Vulkan-Hpp, so that every translation unit sees the same configuration; the macros are
// compile definitions of the skitter_gpu target, which also carries this header precompiled.
#include <vulkan/vulkan_raii.hpp>

#include <vulkan/vulkan_format_traits.hpp>

#if !defined(VULKAN_HPP_NO_STRUCT_CONSTRUCTORS) || !defined(VULKAN_HPP_NO_SETTERS)
#error "link skitter::gpu: its compile definitions configure Vulkan-Hpp"
#endif
