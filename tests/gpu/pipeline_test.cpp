#include "gpu/pipeline.h"

#include "embedded/along_frag.h"
#include "embedded/copy_comp_storage.h"
#include "embedded/copy_comp_texel.h"
#include "embedded/line_vert.h"
#include "gpu/graphics.h"
#include "gpu/kernel.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

#include <cstring>
#include <functional>
#include <list>
#include <set>

namespace skitter::gpu {
namespace {

class PipelinesTest : public ::testing::Test {
 protected:
  // Empty ones, which need no device.
  std::shared_ptr<const Pipeline> of(size_t number) {
    return pipelines_.of(PipelineKey().add(number), [&] {
      ++made_;
      return Pipeline{};
    });
  }

  Pipelines pipelines_;
  size_t made_ = 0;
};

TEST_F(PipelinesTest, OneOfAKeyIsMade) {
  const auto first = of(1), second = of(2);
  EXPECT_NE(first, second);
  EXPECT_EQ(of(1), first);
  EXPECT_EQ(of(2), second);
  EXPECT_EQ(made_, 2u);
}

TEST_F(PipelinesTest, ThoseThatWereNotAskedForAreForgotten) {
  for (size_t i = 0; i < Pipelines::most; ++i) of(i);
  of(0);
  const auto held = of(Pipelines::most);  // in place of 1
  EXPECT_EQ(made_, Pipelines::most + 1);
  of(0);
  EXPECT_EQ(of(Pipelines::most), held);
  EXPECT_EQ(made_, Pipelines::most + 1);
  of(1);
  EXPECT_EQ(made_, Pipelines::most + 2);
}

TEST_F(PipelinesTest, OneThatCannotBeMadeIsTriedAgain) {
  const PipelineKey key = PipelineKey().add("key");
  EXPECT_THROW(pipelines_.of(key, []() -> Pipeline { throw std::runtime_error("no memory"); }),
               std::runtime_error);
  EXPECT_NE(pipelines_.of(key, [] { return Pipeline{}; }), nullptr);
}

TEST(PipelineKeyTest, TextsDoNotRunTogether) {
  EXPECT_NE(PipelineKey().add("ab").add("c").bytes(), PipelineKey().add("a").add("bc").bytes());
}

using PipelineGpuTest = test::GpuTest;

// The same code but for the number of its generator, which says nothing.
class OtherCode {
 public:
  explicit OtherCode(std::span<const uint8_t> code) : words_(code.size() / sizeof(uint32_t)) {
    std::memcpy(words_.data(), code.data(), code.size());
    ++words_.at(2);
  }
  std::span<const uint8_t> bytes() const {
    return {reinterpret_cast<const uint8_t*>(words_.data()), words_.size() * sizeof(uint32_t)};
  }

 private:
  std::vector<uint32_t> words_;
};

// Each change makes a pipeline of its own, and without one there is one pipeline.
template <class Made, class Info>
void expectOneOfEach(const Context& context, const Info& sound,
                     const std::vector<std::function<void(Info&)>>& changes) {
  std::list<Made> all;
  std::set<const BindingLayout*> layouts;
  all.emplace_back(context, sound);
  layouts.insert(&all.back().layout());
  for (size_t i = 0; i < changes.size(); ++i) {
    Info changed = sound;
    changes[i](changed);
    all.emplace_back(context, changed);
    EXPECT_TRUE(layouts.insert(&all.back().layout()).second) << "change " << i;
  }
  EXPECT_EQ(&Made(context, sound).layout(), &all.front().layout());
}

TEST_F(PipelineGpuTest, KernelsAreOneWhereAllIsTheSame) {
  const OtherCode other(
      ShaderCode{embedded::copy_comp_texel(), embedded::copy_comp_storage()}.pick(context()));
  const KernelInfo sound{.name = "copy",
                         .code = {embedded::copy_comp_texel(), embedded::copy_comp_storage()},
                         .bindings = {{0, BindingKind::load4}, {1, BindingKind::store}},
                         .pushBytes = 8,
                         .constants = {{0, 3}}};
  expectOneOfEach<Kernel, KernelInfo>(
      context(), sound,
      {[](KernelInfo& info) { info.name = "move"; }, [&](KernelInfo& info) { info.code = {other.bytes()}; },
       [](KernelInfo& info) {
         info.bindings.push_back({2, BindingKind::store});
       },
       [](KernelInfo& info) {
         info.bindings.push_back({2, BindingKind::uniform});
       },
       [](KernelInfo& info) {
         info.bindings.push_back({3, BindingKind::uniform});
       },
       [](KernelInfo& info) { info.pushBytes = 12; },
       [](KernelInfo& info) {
         info.constants = {{0, 4}};
       },
       [](KernelInfo& info) {
         info.constants = {{1, 3}};
       },
       [](KernelInfo& info) { info.constants.clear(); }});
}

TEST_F(PipelineGpuTest, GraphicsPipelinesAreOneWhereAllIsTheSame) {
  const OtherCode vertex(embedded::line_vert()), fragment(embedded::along_frag());
  const VertexStream stream{
      .stride = 16, .rate = vk::VertexInputRate::eVertex, .attributes = {{0, vk::Format::eR32Sfloat, 0}}};
  const GraphicsInfo sound{.name = "line",
                           .vertex = embedded::line_vert(),
                           .fragment = embedded::along_frag(),
                           .bindings = {{0, BindingKind::uniform}},
                           .pushBytes = 8,
                           .streams = {stream},
                           .colour = vk::Format::eR8G8B8A8Unorm,
                           .depth = vk::Format::eD32Sfloat,
                           .constants = {{0, 0.5f}}};
  const auto inStream = [](auto change) { return [=](GraphicsInfo& info) { change(info.streams[0]); }; };
  expectOneOfEach<GraphicsPipeline, GraphicsInfo>(
      context(), sound,
      {[](GraphicsInfo& info) { info.name = "other"; },
       [&](GraphicsInfo& info) { info.vertex = vertex.bytes(); },
       [&](GraphicsInfo& info) { info.fragment = fragment.bytes(); },
       [](GraphicsInfo& info) { info.fragment.reset(); },
       [](GraphicsInfo& info) { info.bindings[0].binding = 1; },
       [](GraphicsInfo& info) { info.pushBytes = 12; },
       [](GraphicsInfo& info) { info.streams.clear(); },
       [&](GraphicsInfo& info) {
         info.streams.push_back({.stride = 4, .rate = stream.rate, .attributes = {}});
       },
       inStream([](VertexStream& s) { s.stride = 20; }),
       inStream([](VertexStream& s) { s.rate = vk::VertexInputRate::eInstance; }),
       inStream([](VertexStream& s) { s.attributes[0].location = 1; }),
       inStream([](VertexStream& s) { s.attributes[0].format = vk::Format::eR32G32Sfloat; }),
       inStream([](VertexStream& s) { s.attributes[0].offset = 4; }),
       [](GraphicsInfo& info) { info.colour = vk::Format::eR32Sfloat; },
       [](GraphicsInfo& info) { info.depth = vk::Format::eD16Unorm; },
       [](GraphicsInfo& info) { info.samples = vk::SampleCountFlagBits::e4; },
       [](GraphicsInfo& info) { info.depthUse = DepthUse::background; },
       [](GraphicsInfo& info) { info.cull = vk::CullModeFlagBits::eFront; },
       [](GraphicsInfo& info) { info.blended = true; },
       [](GraphicsInfo& info) {
         info.constants = {{0, 0.25f}};
       }});
}

}  // namespace
}  // namespace skitter::gpu
