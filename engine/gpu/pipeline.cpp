#include "gpu/pipeline.h"

#include "gpu/kernel.h"

namespace skitter::gpu {

PipelineKey& PipelineKey::add(std::string_view text) {
  add(text.size());
  bytes_.append(text);
  return *this;
}

PipelineKey& PipelineKey::add(const Context& context, const ShaderCode& code) {
  const std::span<const uint8_t> bytes = code.pick(context);
  add(context.texelLoads()).add(context.wideStores());
  return add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

PipelineKey& PipelineKey::add(const std::vector<BindingDecl>& bindings) {
  add(bindings.size());
  for (const BindingDecl& each : bindings) add(each.binding).add(each.kind);
  return *this;
}

PipelineKey& PipelineKey::add(const std::vector<SpecConstant>& constants) {
  add(constants.size());
  for (const SpecConstant& each : constants) add(each.id).add(each.bits);
  return *this;
}

std::shared_ptr<const Pipeline> Pipelines::of(const PipelineKey& key, const std::function<Pipeline()>& make) {
  const auto found = [&]() -> std::shared_ptr<const Pipeline> {
    const auto at = byKey_.find(key.bytes());
    if (at == byKey_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, at->second);
    return at->second->pipeline;
  };
  {
    const std::lock_guard lock(mutex_);
    if (auto pipeline = found()) return pipeline;
  }
  auto made = std::make_shared<const Pipeline>(make());
  const std::lock_guard lock(mutex_);
  if (auto pipeline = found()) return pipeline;
  entries_.push_front({key.bytes(), made});
  byKey_.emplace(entries_.front().key, entries_.begin());
  if (entries_.size() > most) {
    byKey_.erase(entries_.back().key);
    entries_.pop_back();
  }
  return made;
}

}  // namespace skitter::gpu
