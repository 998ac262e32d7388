#include <fmt/format.h>

#include <algorithm>

#include "embedded/lengths_comp_storage.h"
#include "embedded/lengths_comp_texel.h"
#include "embedded/tangents_comp_storage.h"
#include "embedded/tangents_comp_texel.h"
#include "embedded/travel_comp_storage.h"
#include "embedded/travel_comp_texel.h"
#include "gpu/context.h"
#include "gpu/kernel.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "shared/spline_batch.h"
#include "skitter/error.h"
#include "skitter/records.h"
#include "skitter/spline.h"
#include "spline/checks.h"

namespace skitter {
namespace {

constexpr uint32_t kMostPageSplines = 1u << 20;

// The caller's buffers, in the order of Buffers.
enum Given : size_t { givenKeys, givenTangents, givenClocks, givenMotions, givenNone };

glm::vec4 recordOf(const SplineClock& clock) {
  const auto start = static_cast<float>(clock.start);
  const auto rest = static_cast<float>(clock.start - static_cast<double>(start));
  return {start, rest, static_cast<float>(clock.duration), clock.active ? 1.0f : 0.0f};
}

void checkBatchCount(const char* name, size_t found, size_t expected) {
  if (found != expected)
    throw inputError(fmt::format("the batch of splines was given {} {}, expected {}", found, name, expected));
}

SplineBatch::Options checked(const SplineBatch::Options& options) {
  checkPointCount(options.points);
  checkTangentRule(options.tangents);
  return options;
}

}  // namespace

struct SplineBatch::Impl {
  struct Page {
    uint32_t splines = 0;
    gpu::Buffer key, given, tangent, length, summary, clock, motion;
    gpu::Bindings tangents, lengths, travel;
  };

  Impl(Device&, uint32_t splines, const Options&);

  const gpu::Context* context;
  Options options;
  uint32_t splines, keys;
  bool hasGiven;
  shared::SplineConstants constants = {};
  gpu::Kernel tangents, lengths, travel;
  gpu::Buffer unused;
  uint32_t pageSplines = 1;
  std::vector<Page> pages;
  gpu::Buffer given[givenNone + 1];  // the last never is

  const Page& pageAt(uint32_t page) const {
    if (page < pages.size()) return pages[page];
    throw inputError(fmt::format("page {} of a batch, expected one of its {}", page, pages.size()));
  }
  gpu::ShaderCode code(const char* entry, gpu::ShaderCode builtin) const;
  gpu::Kernel makeKernel(const char* entry, gpu::ShaderCode builtin, std::vector<gpu::BindingDecl>) const;
  void makeKernels();
  void makePages();
  void bind(Page&);
  const gpu::Buffer& of(Given use, const gpu::Buffer& own) const { return given[use] ? given[use] : own; }
  // `each` vec4 a spline, from or to all pages.
  void upload(gpu::Buffer Page::*buffer, Given use, uint32_t each, std::span<const glm::vec4>);
  std::vector<glm::vec4> download(gpu::Buffer Page::*buffer, Given use, uint32_t each) const;
  void recordPrepare(vk::CommandBuffer) const;
  void prepare() const;
};

SplineBatch::Impl::Impl(Device& device, uint32_t count, const Options& wanted)
    : context(&device.context()),
      options(checked(wanted)),
      splines(count),
      keys(wanted.points + (wanted.closed ? 1 : 0)),
      hasGiven(wanted.tangents.rule == SplineRule::given) {
  constants.tension = options.tangents.tension;
  constants.continuity = options.tangents.continuity;
  constants.bias = options.tangents.bias;
  unused = gpu::Buffer(*context, 0, "spline unused");
  makeKernels();
  makePages();
  // Points all at 0, met at 0, 1, 2, ..
  std::vector<glm::vec4> still, idle;
  for (uint32_t n = 0; n < splines; ++n) {
    for (uint32_t k = 0; k < keys; ++k) still.emplace_back(0, 0, 0, k);
    idle.push_back(recordOf({}));
  }
  upload(&Page::key, givenKeys, keys, still);
  upload(&Page::clock, givenClocks, 1, idle);
  prepare();
}

gpu::ShaderCode SplineBatch::Impl::code(const char* entry, gpu::ShaderCode builtin) const {
  for (const Shader& other : options.shaders)
    if (other.entry == entry) return {other.texel, other.storage};
  return builtin;
}

gpu::Kernel SplineBatch::Impl::makeKernel(const char* entry, gpu::ShaderCode builtin,
                                          std::vector<gpu::BindingDecl> bindings) const {
  using namespace shared;
  return {*context,
          {.name = fmt::format("spline {}", entry),
           .code = code(entry, builtin),
           .bindings = std::move(bindings),
           .pushBytes = sizeof(SplineConstants),
           .constants = {{CONSTANT_KEYS, keys},
                         {CONSTANT_CLOSED, options.closed},
                         {CONSTANT_RULE, static_cast<uint32_t>(options.tangents.rule)},
                         {CONSTANT_ARC_LENGTH, options.arcLength},
                         {CONSTANT_CONSTANT_SPEED, options.constantSpeed}}}};
}

void SplineBatch::Impl::makeKernels() {
  using namespace shared;
  using namespace embedded;
  using enum gpu::BindingKind;
  tangents = makeKernel("tangents", {tangents_comp_texel(), tangents_comp_storage()},
                        {{SPLINE_KEY, load4}, {SPLINE_GIVEN, load4}, {SPLINE_TANGENT_OUT, store}});
  lengths = makeKernel("lengths", {lengths_comp_texel(), lengths_comp_storage()},
                       {{SPLINE_KEY, load4},
                        {SPLINE_TANGENT, load4},
                        {SPLINE_LENGTH_OUT, store},
                        {SPLINE_SUMMARY_OUT, store}});
  travel = makeKernel("travel", {travel_comp_texel(), travel_comp_storage()},
                      {{SPLINE_KEY, load4},
                       {SPLINE_TANGENT, load4},
                       {SPLINE_LENGTH, load4},
                       {SPLINE_SUMMARY, load4},
                       {SPLINE_CLOCK, load4},
                       {SPLINE_MOTION_OUT, store}});
}

void SplineBatch::Impl::makePages() {
  const DeviceLimits& limits = context->limits();
  uint64_t reach = limits.maxStorageBufferRange;
  if (context->texelLoads()) reach = std::min(reach, limits.maxTexelBufferElements * 16);
  const uint64_t tangentStride = uint64_t{shared::TANGENT_STRIDE} * keys;
  pageSplines = static_cast<uint32_t>(
      std::min<uint64_t>({kMostPageSplines, reach / (16 * tangentStride),
                          uint64_t{limits.maxComputeWorkGroupCountX} * shared::WORK_GROUP / keys}));
  if (options.pageSplines > 0) pageSplines = std::min(pageSplines, options.pageSplines);
  const uint64_t stride = 2 * uint64_t{keys} + (hasGiven ? 2 : 1) * tangentStride + 2 + shared::MOTION_STRIDE;
  const uint64_t needed = stride * 16 * splines;
  if (needed > limits.availableBytes)
    throw deviceError(fmt::format("{} splines of {} points need {} MiB, {} has {} MiB", splines,
                                  options.points, needed >> 20, context->report().name,
                                  limits.availableBytes >> 20));
  for (uint32_t first = 0; first < splines || first == 0; first += pageSplines) {
    Page& page = pages.emplace_back();
    page.splines = std::min(pageSplines, splines - first);
    const auto make = [&](uint64_t vec4s, const char* name) {
      return gpu::Buffer(*context, vec4s * 16 * page.splines, name);
    };
    page.key = make(keys, "spline keys");
    page.given = make(hasGiven ? tangentStride : 0, "spline tangents given");
    page.tangent = make(tangentStride, "spline tangents");
    page.length = make(keys, "spline lengths");
    page.summary = make(1, "spline summaries");
    page.clock = make(1, "spline clocks");
    page.motion = make(shared::MOTION_STRIDE, "spline motions");
    if (hasGiven) gpu::clear(*context, page.given);
    bind(page);
  }
}

void SplineBatch::Impl::bind(Page& page) {
  using namespace shared;
  const gpu::Buffer *key = &of(givenKeys, page.key), *clock = &of(givenClocks, page.clock),
                    *motion = &of(givenMotions, page.motion),
                    *from = hasGiven ? &of(givenTangents, page.given) : &unused;
  page.tangents =
      tangents.bind(*context, {{SPLINE_KEY, key}, {SPLINE_GIVEN, from}, {SPLINE_TANGENT_OUT, &page.tangent}});
  page.lengths = lengths.bind(*context, {{SPLINE_KEY, key},
                                         {SPLINE_TANGENT, &page.tangent},
                                         {SPLINE_LENGTH_OUT, &page.length},
                                         {SPLINE_SUMMARY_OUT, &page.summary}});
  page.travel = travel.bind(*context, {{SPLINE_KEY, key},
                                       {SPLINE_TANGENT, &page.tangent},
                                       {SPLINE_LENGTH, &page.length},
                                       {SPLINE_SUMMARY, &page.summary},
                                       {SPLINE_CLOCK, clock},
                                       {SPLINE_MOTION_OUT, motion}});
}

void SplineBatch::Impl::upload(gpu::Buffer Page::*buffer, Given use, uint32_t each,
                               std::span<const glm::vec4> data) {
  for (Page& page : pages) {
    const auto part = data.subspan(0, size_t{page.splines} * each);
    gpu::upload(*context, of(use, page.*buffer), part);
    data = data.subspan(part.size());
  }
}

std::vector<glm::vec4> SplineBatch::Impl::download(gpu::Buffer Page::*buffer, Given use,
                                                   uint32_t each) const {
  std::vector<glm::vec4> all;
  all.reserve(size_t{splines} * each);
  for (const Page& page : pages) {
    std::vector<glm::vec4> part(size_t{page.splines} * each);
    gpu::downloadBytes(*context, of(use, page.*buffer), std::as_writable_bytes(std::span(part)));
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

void SplineBatch::Impl::recordPrepare(vk::CommandBuffer cmd) const {
  gpu::computeToCompute(cmd);
  gpu::transferToCompute(cmd);
  const auto forEachPage = [&](const gpu::Kernel& kernel, gpu::Bindings Page::*bindings, uint32_t items) {
    for (const Page& page : pages) {
      shared::SplineConstants own = constants;
      own.count = page.splines;
      kernel.dispatch(cmd, page.*bindings, gpu::bytesOf(own),
                      gpu::groupsFor(page.splines * items, shared::WORK_GROUP));
    }
  };
  forEachPage(tangents, &Page::tangents, keys);
  gpu::computeToCompute(cmd);
  forEachPage(lengths, &Page::lengths, 1);
  gpu::computeToCompute(cmd);
  gpu::computeToTransfer(cmd);
}

void SplineBatch::Impl::prepare() const {
  gpu::submitAndWait(*context, [&](vk::CommandBuffer cmd) { recordPrepare(cmd); });
}

SplineBatch::SplineBatch(Device& device, uint32_t splines, const Options& options)
    : impl_(std::make_unique<Impl>(device, splines, options)) {}
SplineBatch::~SplineBatch() = default;
SplineBatch::SplineBatch(SplineBatch&&) noexcept = default;
SplineBatch& SplineBatch::operator=(SplineBatch&&) noexcept = default;

uint32_t SplineBatch::splines() const { return impl_->splines; }
uint32_t SplineBatch::points() const { return impl_->options.points; }
uint32_t SplineBatch::keys() const { return impl_->keys; }

uint64_t SplineBatch::memoryBytes() const {
  uint64_t bytes = 0;
  for (const Impl::Page& page : impl_->pages)
    for (const gpu::Buffer* buffer :
         {&page.key, &page.given, &page.tangent, &page.length, &page.summary, &page.clock, &page.motion})
      bytes += buffer->size();
  return bytes;
}

void SplineBatch::setPoints(std::span<const glm::vec3> points, std::span<const float> knots) {
  Impl& batch = *impl_;
  const uint32_t each = batch.options.points, keys = batch.keys;
  checkBatchCount("points", points.size(), size_t{batch.splines} * each);
  const bool own = knots.size() == size_t{batch.splines} * keys;
  std::vector<float> even(keys);
  for (uint32_t k = 0; k < keys; ++k) even[k] = static_cast<float>(k);
  if (knots.empty()) knots = even;
  if (!own) checkBatchCount("knots", knots.size(), keys);
  std::vector<glm::vec4> records;
  records.reserve(size_t{batch.splines} * keys);
  for (uint32_t n = 0; n < batch.splines; ++n) {
    const auto chain = points.subspan(size_t{n} * each, each);
    const auto times = knots.subspan(own ? size_t{n} * keys : 0, keys);
    const std::string what = fmt::format("spline {}", n);
    checkPoints(what, chain);
    checkKnots(what, times);
    for (uint32_t k = 0; k < keys; ++k) records.emplace_back(chain[k % each], times[k]);
  }
  batch.upload(&Impl::Page::key, givenKeys, keys, records);
  batch.prepare();
}

void SplineBatch::setTangents(std::span<const glm::vec3> arriving, std::span<const glm::vec3> leaving) {
  Impl& batch = *impl_;
  if (!batch.hasGiven) throw inputError("tangents were given to a batch of splines that makes them by rule");
  const uint32_t each = batch.options.points;
  checkBatchCount("arriving tangents", arriving.size(), size_t{batch.splines} * each);
  if (leaving.empty()) leaving = arriving;
  checkBatchCount("leaving tangents", leaving.size(), arriving.size());
  std::vector<glm::vec4> records;
  records.reserve(size_t{batch.splines} * batch.keys * shared::TANGENT_STRIDE);
  for (uint32_t n = 0; n < batch.splines; ++n) {
    const std::string what = fmt::format("spline {}", n);
    for (const auto& list : {arriving, leaving}) checkTangents(what, list.subspan(size_t{n} * each, each));
    for (uint32_t k = 0; k < batch.keys; ++k) {
      const size_t from = size_t{n} * each + k % each;
      records.emplace_back(arriving[from], 0.0f);
      records.emplace_back(leaving[from], 0.0f);
    }
  }
  batch.upload(&Impl::Page::given, givenTangents, shared::TANGENT_STRIDE * batch.keys, records);
  batch.prepare();
}

void SplineBatch::setClocks(std::span<const SplineClock> clocks) {
  checkBatchCount("clocks", clocks.size(), impl_->splines);
  std::vector<glm::vec4> records;
  for (size_t n = 0; n < clocks.size(); ++n) {
    checkClock(fmt::format("spline {}", n), clocks[n]);
    records.push_back(recordOf(clocks[n]));
  }
  impl_->upload(&Impl::Page::clock, givenClocks, 1, records);
}

void SplineBatch::recordPrepare(VkCommandBuffer cmd) const { impl_->recordPrepare(cmd); }

void SplineBatch::record(VkCommandBuffer commandBuffer, double now) const {
  const vk::CommandBuffer cmd(commandBuffer);
  gpu::computeToCompute(cmd);
  gpu::transferToCompute(cmd);
  // A motion may still be copied from.
  gpu::computeToTransfer(cmd);
  for (const Impl::Page& page : impl_->pages) {
    shared::SplineConstants own = impl_->constants;
    own.count = page.splines;
    own.now = static_cast<float>(now);
    own.nowRest = static_cast<float>(now - static_cast<double>(own.now));
    impl_->travel.dispatch(cmd, page.travel, gpu::bytesOf(own),
                           gpu::groupsFor(page.splines, shared::WORK_GROUP));
  }
  gpu::computeToCompute(cmd);
  gpu::computeToTransfer(cmd);
}

void SplineBatch::travel(double now) {
  gpu::submitAndWait(*impl_->context, [&](vk::CommandBuffer cmd) { record(cmd, now); });
}

std::vector<SplineMotion> SplineBatch::downloadMotions() const {
  const std::vector<glm::vec4> records =
      impl_->download(&Impl::Page::motion, givenMotions, shared::MOTION_STRIDE);
  std::vector<SplineMotion> motions;
  motions.reserve(impl_->splines);
  for (size_t r = 0; r < records.size(); r += shared::MOTION_STRIDE)
    motions.push_back({records[r], records[r + 1], records[r].w,
                       static_cast<SplineState>(static_cast<uint32_t>(records[r + 1].w))});
  return motions;
}

std::vector<float> SplineBatch::downloadLengths() const {
  std::vector<float> lengths;
  for (const glm::vec4& summary : impl_->download(&Impl::Page::summary, givenNone, 1))
    lengths.push_back(summary.w > 0 ? 0.0f : summary.x);
  return lengths;
}

uint32_t SplineBatch::pageSplines() const { return impl_->pageSplines; }
uint32_t SplineBatch::pages() const { return static_cast<uint32_t>(impl_->pages.size()); }

namespace {
SplineBatch::Span spanOf(const gpu::Buffer& buffer) { return {buffer.handle(), buffer.size()}; }
}  // namespace

SplineBatch::Span SplineBatch::keys(uint32_t page) const { return spanOf(impl_->pageAt(page).key); }
SplineBatch::Span SplineBatch::tangents(uint32_t page) const { return spanOf(impl_->pageAt(page).given); }
SplineBatch::Span SplineBatch::clocks(uint32_t page) const { return spanOf(impl_->pageAt(page).clock); }
SplineBatch::Span SplineBatch::motions(uint32_t page) const { return spanOf(impl_->pageAt(page).motion); }

void SplineBatch::use(const Buffers& buffers) {
  Impl& batch = *impl_;
  if (batch.pages.size() != 1)
    throw inputError(
        fmt::format("{} splines take {} pages; buffers can be given to a batch of one ({} splines)",
                    batch.splines, batch.pages.size(), batch.pageSplines));
  const uint64_t each = uint64_t{16} * batch.splines;
  const struct {
    Span span;
    uint64_t bytes;
    const char* name;
  } wanted[givenNone] = {{buffers.keys, each * batch.keys, "keys"},
                         {buffers.tangents, each * batch.keys * shared::TANGENT_STRIDE, "tangents"},
                         {buffers.clocks, each, "clocks"},
                         {buffers.motions, each * shared::MOTION_STRIDE, "motions"}};
  if (buffers.tangents.buffer && !batch.hasGiven)
    throw inputError("a buffer of tangents was given to a batch of splines that makes them by rule");
  for (const auto& [span, bytes, name] : wanted)
    if (span.buffer && span.bytes < bytes)
      throw inputError(fmt::format("the buffer for {} has {} bytes, {} splines need {}", name, span.bytes,
                                   batch.splines, bytes));
  batch.context->waitIdle();
  for (size_t use = 0; use < givenNone; ++use)
    batch.given[use] = wanted[use].span.buffer
                           ? gpu::Buffer::borrowed(*batch.context, wanted[use].span.buffer, wanted[use].bytes,
                                                   wanted[use].name)
                           : gpu::Buffer();
  batch.bind(batch.pages.front());
}

}  // namespace skitter
