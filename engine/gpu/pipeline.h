#pragma once

#include "gpu/bindings.h"

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>

namespace skitter::gpu {

struct ShaderCode;
struct SpecConstant;

// A pipeline with its layouts.
struct Pipeline {
  BindingLayout layout;
  vk::raii::Pipeline handle = nullptr;
};

// All that a pipeline is made of, as bytes.
class PipelineKey {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T> PipelineKey& add(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  PipelineKey& add(std::string_view text);
  // The code that the context picks, and how it loads and stores.
  PipelineKey& add(const Context&, const ShaderCode&);
  PipelineKey& add(const std::vector<BindingDecl>&);
  PipelineKey& add(const std::vector<SpecConstant>&);

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// The pipelines of a context that were asked for last. A driver's own cache may hold nothing: lavapipe's
// translates every shader anew.
class Pipelines {
 public:
  // More than a crowd of a few herds and its renderer have.
  static constexpr size_t most = 256;

  // The one of that key, which `make` makes where it is not here. Threads may call it at once.
  std::shared_ptr<const Pipeline> of(const PipelineKey&, const std::function<Pipeline()>& make);

 private:
  struct Entry {
    std::string key;
    std::shared_ptr<const Pipeline> pipeline;
  };

  std::mutex mutex_;
  std::list<Entry> entries_;  // the last that was asked for first
  std::unordered_map<std::string_view, std::list<Entry>::iterator> byKey_;
};

}  // namespace skitter::gpu
