#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "embedded/solve_free_comp_storage.h"
#include "embedded/solve_free_comp_texel.h"
#include "embedded/solve_limited_comp_storage.h"
#include "embedded/solve_limited_comp_texel.h"
#include "gpu/context.h"
#include "gpu/kernel.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "ik/limits.h"
#include "ik/records.h"
#include "ik/seeds.h"
#include "ik/skeleton.h"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "skitter/error.h"
#include "skitter/ik.h"
#include "skitter/records.h"

namespace skitter::ik {
namespace {

constexpr uint32_t kMostPageChains = 1u << 20;

// Whether a pose is joints: of free chains, and of the dissertation, which knows no frames.
bool isPositional(const Chain& chain, Solver solver) {
  return chain.isFree() || solver == Solver::dissertationKeep || solver == Solver::dissertationEdge;
}

template <class Kind>
bool any(const Chain& chain) {
  return std::any_of(chain.bones.begin(), chain.bones.end(),
                     [](const Bone& bone) { return std::holds_alternative<Kind>(bone.limit); });
}

void checkSolver(const Chain& chain, Solver solver) {
  const auto refuse = [&](const char* expected) {
    throw inputError(fmt::format("the solver {} takes {}", nameOf(solver), expected));
  };
  if (solver == Solver::twoBone && (!chain.isFree() || chain.bones.size() != 2))
    refuse("two bones (3 joints) without limits");
  if (solver == Solver::stretchAlign && !chain.isFree()) refuse("chains without limits");
  if (solver == Solver::activeSet && chain.isFree()) refuse("chains with limits");
  if (solver == Solver::dissertationKeep || solver == Solver::dissertationEdge) {
    for (const Bone& bone : chain.bones)
      if ((!std::holds_alternative<Free>(bone.limit) && !std::holds_alternative<Cone>(bone.limit)) ||
          bone.twistMin != 0 || bone.twistMax != 0)
        refuse("no limits other than cones");
  }
}

void checkOptions(const Chain& chain, uint32_t chains, const Options& options) {
  if (chains > Batch::maxChains)
    throw inputError(fmt::format("{} chains, expected at most {}", chains, Batch::maxChains));
  if (!(std::isfinite(options.tolerance) && options.tolerance > 0))
    throw inputError(fmt::format("the tolerance is {}, expected more than 0", options.tolerance));
  const float restPull = restPullOf(chain, options);
  if (!(restPull >= 0 && restPull <= 1))
    throw inputError(fmt::format("the rest pull is {}, expected 0 to 1", restPull));
}

void expectContinuing(const Options& options) {
  if (options.start != Start::previous)
    throw inputError("start poses were given to a batch that starts at rest, expected Start::previous");
}

// What BATCH_LIST begins with; the numbers of the chains follow.
struct ListHead {
  VkDispatchIndirectCommand dispatch;
  uint32_t count;
};
static_assert(offsetof(ListHead, count) == shared::LIST_COUNT * sizeof(uint32_t) &&
              sizeof(ListHead) == shared::LIST_FIRST * sizeof(uint32_t));

std::vector<glm::vec4> unpausedReports(uint32_t chains) {
  return std::vector<glm::vec4>(chains, {0, 0, 0, 1});
}

// The inverse of a base's rotation, stored xyzw.
glm::quat turnedBack(const glm::vec4& rotation) {
  return glm::conjugate(glm::quat(rotation.w, rotation.x, rotation.y, rotation.z));
}

// No chain listed: an empty dispatch.
void clearList(const gpu::Buffer& list, vk::CommandBuffer cmd) {
  constexpr ListHead none = {.dispatch = {.x = 0, .y = 1, .z = 1}, .count = 0};
  cmd.updateBuffer(list.handle(), 0, sizeof none, &none);
}

}  // namespace

struct Batch::Impl {
  struct Page {
    uint32_t chains = 0;
    gpu::Buffer target, base, state, joint, rotation, report, pace, list;
    gpu::Buffer sink;  // of what is not written; each page has its own, as dispatches of pages may overlap
    gpu::Bindings bindings;
  };

  Impl(Device&, const Chain&, uint32_t chains, const Options&);

  const gpu::Context* context;
  Chain chain;
  Options options;
  Solver solver;
  uint32_t chains, iterations;
  uint32_t bones;
  bool positional, twists, ownState;
  Skeleton skeleton;
  shared::BatchConstants constants = {};
  bool aimed = false;          // seeds are turned to the target
  bool quick = false;          // two dispatches: most chains are done by the first
  gpu::Kernel kernel, listed;  // the second one's, where there are two
  gpu::Buffer rig, seeds, unused;
  uint32_t pageChains = 1;
  std::vector<Page> pages;
  gpu::Buffer given[6];  // the caller's, in the order of Buffers; the last, the state, never is

  const Page& pageAt(uint32_t page) const {
    if (page < pages.size()) return pages[page];
    throw inputError(fmt::format("page {} of a batch, expected one of its {}", page, pages.size()));
  }
  uint64_t stateStride() const {
    return positional ? bones : static_cast<uint64_t>(shared::stateStride(static_cast<int>(bones), twists));
  }
  gpu::ShaderCode code() const;
  int quickSteps() const;
  int chords(int pass) const;
  gpu::Kernel makeKernel(int pass) const;
  void makePages();
  void bind(Page&);
  const gpu::Buffer& stateOf(const Page& page) const { return ownState ? page.state : jointOf(page); }
  const gpu::Buffer& jointOf(const Page& page) const { return given[2] ? given[2] : page.joint; }
  const gpu::Buffer& reportOf(const Page& page) const { return given[4] ? given[4] : page.report; }
  void resetPage(Page&);
  void forgetPace();
  // One record of `each` vec4 a chain, from all pages.
  std::vector<glm::vec4> download(const gpu::Buffer Page::*buffer, size_t use, uint32_t each) const;
  void upload(const gpu::Buffer Page::*buffer, size_t use, uint32_t each, std::span<const glm::vec4> data);
};

Batch::Impl::Impl(Device& device, const Chain& of, uint32_t count, const Options& wanted)
    : context(&device.context()),
      chain((check(of), of)),
      options(wanted),
      solver(solverFor(of, wanted)),
      chains(count),
      iterations(wanted.iterations > 0 ? wanted.iterations : defaultIterations(of, wanted)),
      bones(static_cast<uint32_t>(of.bones.size())),
      positional(isPositional(of, solver)),
      skeleton(of) {
  checkSolver(chain, solver);
  checkOptions(chain, chains, options);
  twists = !positional && skeleton.hasTwists();
  // A free chain about a base at 0 goes on from the joints that it wrote.
  ownState = options.start == Start::previous && !(positional && !options.bases);
  constants.iterations = iterations;
  constants.tolerance = options.tolerance;
  constants.reach = chain.reach();
  constants.restPull = restPullOf(chain, options);
  // The dissertation's cones would not survive a turn about the line to the tip.
  if (chain.pole && (!positional || chain.isFree())) {
    const glm::vec3 pole = glm::normalize(*chain.pole);
    constants.poleX = pole.x;
    constants.poleY = pole.y;
    constants.poleZ = pole.z;
  }
  const std::vector<float> records = boneRecords(skeleton);
  rig = gpu::Buffer(*context, records.size() * sizeof(float), "ik rig");
  gpu::upload(*context, rig, records);
  std::vector<float> seedRecord;
  if (solver == Solver::activeSet && options.restarts) {
    const auto poses = seedPoses(skeleton, chain.pole, shared::SEEDS_MOST);
    aimed = aimsSeeds(skeleton, chain.pole);
    seedRecord = seedRecords(skeleton, poses, aimed);
    constants.seeds = static_cast<uint32_t>(poses.size());
    const std::vector<float> cells = seedCells(skeleton, poses, aimed);
    seedRecord.insert(seedRecord.end(), cells.begin(), cells.end());
  }
  seeds = gpu::Buffer(*context, seedRecord.size() * sizeof(float), "ik seeds");
  gpu::upload(*context, seeds, seedRecord);
  unused = gpu::Buffer(*context, 0, "ik unused");
  quick = solver == Solver::stretchAlign || constants.seeds > 0;
  kernel = makeKernel(quick ? shared::PASS_QUICK : shared::PASS_WHOLE);
  if (quick) listed = makeKernel(shared::PASS_LISTED);
  makePages();
}

gpu::ShaderCode Batch::Impl::code() const {
  for (const Shader& other : options.shaders)
    if (other.entry == (positional ? "solve_free" : "solve_limited")) return {other.texel, other.storage};
  if (positional) return {embedded::solve_free_comp_texel(), embedded::solve_free_comp_storage()};
  return {embedded::solve_limited_comp_texel(), embedded::solve_limited_comp_storage()};
}

// As many as most chains need: fewer leave more to the second dispatch, more cost all chains (and longer to
// compile).
int Batch::Impl::quickSteps() const {
  const bool tracks = options.start == Start::previous;
  if (positional) return tracks ? 2 : 4;
  if (tracks) return 1;
  if (aimed) return bones == 2 ? 2 : 1;
  return any<Free>(chain) ? 4 : 3;
}

// After a step of a solve that continues another. A step hardly ever leaves a chain of balls where it needs
// one.
int Batch::Impl::chords(int pass) const {
  if (options.start != Start::previous) return 0;
  if (pass != shared::PASS_QUICK) return shared::CHORDS_MOST;
  return any<Hinge>(chain) ? 1 : 0;
}

gpu::Kernel Batch::Impl::makeKernel(int pass) const {
  using namespace shared;
  using enum gpu::BindingKind;
  gpu::KernelInfo info{.name = fmt::format("ik {}", nameOf(solver)), .code = code()};
  info.bindings = {{BATCH_RIG, load4},          {BATCH_TARGET, load4},     {BATCH_BASE, load4},
                   {BATCH_STATE, load4},        {BATCH_STATE_OUT, store},  {BATCH_JOINT_OUT, store},
                   {BATCH_ROTATION_OUT, store}, {BATCH_REPORT_OUT, store}, {BATCH_LIST, store},
                   {BATCH_PACE, load4},         {BATCH_PACE_OUT, store}};
  if (!positional) {
    info.bindings.push_back({BATCH_SEED, load4});
    info.bindings.push_back({BATCH_REPORT, load4});
  }
  info.pushBytes = sizeof(BatchConstants);
  const auto [low, high] = limitWords(skeleton);
  info.constants = {{CONSTANT_BONES, bones},
                    {CONSTANT_LIMITS_LOW, low},
                    {CONSTANT_LIMITS_HIGH, high},
                    {CONSTANT_SOLVER, static_cast<uint32_t>(solver)},
                    {CONSTANT_PREVIOUS, options.start == Start::previous},
                    {CONSTANT_BASES, options.bases},
                    {CONSTANT_ROTATIONS, options.rotations},
                    {CONSTANT_TWISTS, twists},
                    {CONSTANT_STRAIGHT,
                     constants.seeds == 0 && (options.start == Start::previous || skeleton.restIsStraight())},
                    {CONSTANT_POLE, chain.pole.has_value()},
                    {CONSTANT_REST_LEGAL, skeleton.restIsLegal()},
                    {CONSTANT_PULL, solver == Solver::activeSet && constants.restPull > 0},
                    {CONSTANT_PASS, pass},
                    {CONSTANT_STEPS, pass == PASS_QUICK ? quickSteps() : 0},
                    {CONSTANT_CHORDS, chords(pass)},
                    {CONSTANT_AIMED, aimed},
                    {CONSTANT_PARALLEL, parallelWord(skeleton)},
                    {CONSTANT_PADDED, skeleton.isPadded()}};
  return {*context, info};
}

void Batch::Impl::makePages() {
  const DeviceLimits& limits = context->limits();
  uint64_t reach = limits.maxStorageBufferRange;
  if (context->texelLoads()) reach = std::min(reach, limits.maxTexelBufferElements * 16);
  const uint64_t largest = 16 * std::max<uint64_t>({stateStride(), bones, shared::BASE_STRIDE});
  pageChains = static_cast<uint32_t>(std::min<uint64_t>(
      {kMostPageChains, reach / largest, uint64_t{limits.maxComputeWorkGroupCountX} * shared::WORK_GROUP}));
  if (options.pageChains > 0) pageChains = std::min(pageChains, options.pageChains);
  uint64_t stride = 2 + bones;
  if (options.bases) stride += shared::BASE_STRIDE;
  if (options.rotations) stride += bones;
  if (options.start == Start::previous) ++stride;
  if (ownState) stride += stateStride();
  const uint64_t needed = stride * 16 * chains;
  if (needed > limits.availableBytes)
    throw deviceError(fmt::format("{} chains need {} MiB, {} has {} MiB", chains, needed >> 20,
                                  context->report().name, limits.availableBytes >> 20));
  for (uint32_t first = 0; first < chains || first == 0; first += pageChains) {
    Page& page = pages.emplace_back();
    page.chains = std::min(pageChains, chains - first);
    const auto make = [&](uint64_t vec4s, const char* name) {
      return gpu::Buffer(*context, vec4s * 16 * page.chains, name);
    };
    page.target = make(1, "ik targets");
    page.base = make(options.bases ? shared::BASE_STRIDE : 0, "ik bases");
    page.state = make(ownState ? stateStride() : 0, "ik states");
    page.joint = make(bones, "ik joints");
    page.rotation = make(options.rotations ? bones : 0, "ik rotations");
    page.report = make(1, "ik reports");
    page.pace = make(options.start == Start::previous ? 1 : 0, "ik paces");
    page.sink = make(0, "ik sink");
    page.list = gpu::Buffer(*context, (shared::LIST_FIRST + (quick ? page.chains : 0)) * 4, "ik list",
                            gpu::BufferUse::indirect);
    gpu::clear(*context, page.target);
    if (options.bases) {
      const std::vector<glm::vec4> still = {glm::vec4(0), glm::vec4(0, 0, 0, 1)};
      std::vector<glm::vec4> bases;
      for (uint32_t c = 0; c < page.chains; ++c) bases.insert(bases.end(), still.begin(), still.end());
      gpu::upload(*context, page.base, bases);
    }
    resetPage(page);
    bind(page);
  }
}

void Batch::Impl::bind(Page& page) {
  using namespace shared;
  const auto pick = [&](size_t use, const gpu::Buffer& own) { return given[use] ? &given[use] : &own; };
  std::vector<gpu::Binding> list = {
      {BATCH_RIG, &rig},
      {BATCH_TARGET, pick(0, page.target)},
      {BATCH_BASE, options.bases ? pick(1, page.base) : &unused},
      {BATCH_STATE, options.start == Start::previous ? &stateOf(page) : &unused},
      {BATCH_STATE_OUT, ownState ? &page.state : &page.sink},
      {BATCH_JOINT_OUT, pick(2, page.joint)},
      {BATCH_ROTATION_OUT, options.rotations ? pick(3, page.rotation) : &page.sink},
      {BATCH_REPORT_OUT, &reportOf(page)},
      {BATCH_LIST, &page.list},
      {BATCH_PACE, options.start == Start::previous ? &page.pace : &unused},
      {BATCH_PACE_OUT, options.start == Start::previous ? &page.pace : &page.sink},
  };
  if (!positional) {
    list.push_back({BATCH_SEED, &seeds});
    list.push_back({BATCH_REPORT, &reportOf(page)});
  }
  page.bindings = kernel.bind(*context, list);
}

void Batch::Impl::resetPage(Page& page) {
  std::vector<glm::vec4> joints;
  const std::vector<glm::dvec3> rest = skeleton.place(skeleton.rest());
  std::vector<float> pose;
  appendPose(skeleton, skeleton.rest(), pose);
  std::vector<float> states;
  for (uint32_t c = 0; c < page.chains; ++c) {
    for (const glm::dvec3& p : rest) joints.emplace_back(glm::vec3(p) * constants.reach, 0.0f);
    if (ownState && !positional) states.insert(states.end(), pose.begin(), pose.end());
  }
  gpu::upload(*context, jointOf(page), joints);
  gpu::upload(*context, reportOf(page), unpausedReports(page.chains));
  gpu::clear(*context, page.pace);
  if (!ownState) return;
  if (positional)
    gpu::upload(*context, page.state, joints);
  else
    gpu::upload(*context, page.state, states);
}

// A pose that is given is no last solve's.
void Batch::Impl::forgetPace() {
  for (const Page& page : pages) gpu::clear(*context, page.pace);
}

std::vector<glm::vec4> Batch::Impl::download(const gpu::Buffer Page::*buffer, size_t use,
                                             uint32_t each) const {
  std::vector<glm::vec4> all;
  all.reserve(size_t{chains} * each);
  for (const Page& page : pages) {
    std::vector<glm::vec4> part(size_t{page.chains} * each);
    gpu::downloadBytes(*context, given[use] ? given[use] : page.*buffer,
                       std::as_writable_bytes(std::span(part)));
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

void Batch::Impl::upload(const gpu::Buffer Page::*buffer, size_t use, uint32_t each,
                         std::span<const glm::vec4> data) {
  for (Page& page : pages) {
    const auto part = data.subspan(0, size_t{page.chains} * each);
    gpu::upload(*context, given[use] ? given[use] : page.*buffer, part);
    data = data.subspan(part.size());
  }
}

Batch::Batch(Device& device, const Chain& chain, uint32_t chains, const Options& options)
    : impl_(std::make_unique<Impl>(device, chain, chains, options)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

uint32_t Batch::chains() const { return impl_->chains; }
uint32_t Batch::joints() const { return impl_->bones + 1; }
Solver Batch::solver() const { return impl_->solver; }
uint32_t Batch::iterations() const { return impl_->iterations; }

uint64_t Batch::memoryBytes() const {
  uint64_t bytes = 0;
  for (const Impl::Page& page : impl_->pages)
    for (const gpu::Buffer* buffer :
         {&page.target, &page.base, &page.state, &page.joint, &page.rotation, &page.report, &page.pace})
      bytes += buffer->size();
  return bytes;
}

void Batch::setTargets(std::span<const glm::vec3> targets) {
  expectCount("targets", targets.size(), impl_->chains);
  impl_->upload(&Impl::Page::target, 0, 1, widened(targets));
}

void Batch::setBases(std::span<const Base> bases) {
  if (!impl_->options.bases)
    throw inputError("bases were given to a batch of chains at 0, expected Options::bases");
  expectCount("bases", bases.size(), impl_->chains);
  std::vector<glm::vec4> records;
  for (const Base& base : bases) {
    records.emplace_back(base.position, 0.0f);
    records.emplace_back(base.rotation.x, base.rotation.y, base.rotation.z, base.rotation.w);
  }
  impl_->upload(&Impl::Page::base, 1, shared::BASE_STRIDE, records);
}

void Batch::reset() {
  for (Impl::Page& page : impl_->pages) impl_->resetPage(page);
}

void Batch::setJoints(std::span<const glm::vec3> joints) {
  Impl& batch = *impl_;
  const uint32_t n = batch.bones;
  expectContinuing(batch.options);
  expectCount("joints", joints.size(), size_t{batch.chains} * (n + 1));
  std::vector<glm::vec4> records, bases;
  if (batch.options.bases) bases = batch.download(&Impl::Page::base, 1, shared::BASE_STRIDE);
  std::vector<float> states;
  for (uint32_t c = 0; c < batch.chains; ++c) {
    const auto own = joints.subspan(size_t{c} * (n + 1), n + 1);
    const glm::quat back =
        bases.empty() ? glm::quat(1, 0, 0, 0) : turnedBack(bases[size_t{c} * shared::BASE_STRIDE + 1]);
    std::vector<glm::dvec3> wanted = {glm::dvec3(0)};
    for (uint32_t i = 1; i <= n; ++i) {
      records.emplace_back(back * (own[i] - own[0]), 0.0f);
      wanted.emplace_back(records.back());
    }
    if (batch.positional) continue;
    appendPose(batch.skeleton, batch.skeleton.aim(wanted), states);
  }
  if (!batch.positional) {
    records.resize(states.size() / 4);
    std::memcpy(records.data(), states.data(), states.size() * sizeof(float));
  }
  setStates(records);
}

std::vector<glm::vec4> Batch::downloadStates() const {
  const auto stride = static_cast<uint32_t>(impl_->stateStride());
  return impl_->ownState ? impl_->download(&Impl::Page::state, 5, stride)
                         : impl_->download(&Impl::Page::joint, 2, stride);
}

void Batch::setStates(std::span<const glm::vec4> states) {
  const auto stride = static_cast<uint32_t>(impl_->stateStride());
  expectCount("vec4 of states", states.size(), size_t{impl_->chains} * stride);
  impl_->ownState ? impl_->upload(&Impl::Page::state, 5, stride, states)
                  : impl_->upload(&Impl::Page::joint, 2, stride, states);
  impl_->forgetPace();
}

std::vector<glm::vec4> Batch::downloadSeeds() const {
  std::vector<glm::vec4> records = gpu::download<glm::vec4>(*impl_->context, impl_->seeds);
  records.resize(impl_->constants.seeds *
                 static_cast<size_t>(shared::seedStride(static_cast<int>(impl_->bones), impl_->twists)));
  return records;
}

void Batch::record(VkCommandBuffer commandBuffer) const {
  const vk::CommandBuffer cmd(commandBuffer);
  const Impl& batch = *impl_;
  gpu::computeToTransfer(cmd);
  if (batch.quick)
    for (const Impl::Page& page : batch.pages) clearList(page.list, cmd);
  gpu::transferToCompute(cmd);
  gpu::computeToCompute(cmd);
  const auto forEachPage = [&](const auto& dispatch) {
    for (const Impl::Page& page : batch.pages) {
      shared::BatchConstants constants = batch.constants;
      constants.count = page.chains;
      dispatch(page, gpu::bytesOf(constants));
    }
  };
  forEachPage([&](const Impl::Page& page, std::span<const std::byte> constants) {
    batch.kernel.dispatch(cmd, page.bindings, constants, gpu::groupsFor(page.chains, shared::WORK_GROUP));
  });
  if (batch.quick) {
    gpu::computeToIndirectAndCompute(cmd);
    forEachPage([&](const Impl::Page& page, std::span<const std::byte> constants) {
      batch.listed.dispatchIndirect(cmd, page.bindings, constants, page.list);
    });
  }
  gpu::computeToCompute(cmd);
  gpu::computeToTransfer(cmd);
}

void Batch::solve() {
  gpu::submitAndWait(*impl_->context, [&](vk::CommandBuffer cmd) { record(cmd); });
}

std::vector<glm::vec3> Batch::downloadJoints() const {
  const uint32_t n = impl_->bones;
  const std::vector<glm::vec4> records = impl_->download(&Impl::Page::joint, 2, n);
  std::vector<glm::vec4> bases;
  if (impl_->options.bases) bases = impl_->download(&Impl::Page::base, 1, shared::BASE_STRIDE);
  std::vector<glm::vec3> joints(size_t{impl_->chains} * (n + 1));
  for (size_t c = 0; c < impl_->chains; ++c) {
    glm::vec3* chain = &joints[c * (n + 1)];
    chain[0] = bases.empty() ? glm::vec3(0) : glm::vec3(bases[c * shared::BASE_STRIDE]);
    for (uint32_t i = 0; i < n; ++i) chain[1 + i] = glm::vec3(records[c * n + i]);
  }
  return joints;
}

std::vector<glm::quat> Batch::downloadRotations() const {
  if (!impl_->options.rotations)
    throw inputError("rotations of a batch that writes none, expected Options::rotations");
  std::vector<glm::quat> rotations;
  for (const glm::vec4& q : impl_->download(&Impl::Page::rotation, 3, impl_->bones))
    rotations.emplace_back(q.w, q.x, q.y, q.z);
  return rotations;
}

std::vector<Report> Batch::downloadReports() const {
  std::vector<Report> reports;
  for (const glm::vec4& r : impl_->download(&Impl::Page::report, 4, 1))
    reports.push_back({r.x, static_cast<uint32_t>(r.y),
                       static_cast<Stop>(static_cast<uint32_t>(r.z) % static_cast<uint32_t>(shared::STOPS))});
  return reports;
}

uint32_t Batch::pageChains() const { return impl_->pageChains; }
uint32_t Batch::pages() const { return static_cast<uint32_t>(impl_->pages.size()); }

namespace {
Span spanOf(const gpu::Buffer& buffer) { return {buffer.handle(), buffer.size()}; }
}  // namespace

Span Batch::targets(uint32_t page) const { return spanOf(impl_->pageAt(page).target); }
Span Batch::bases(uint32_t page) const { return spanOf(impl_->pageAt(page).base); }
Span Batch::joints(uint32_t page) const { return spanOf(impl_->pageAt(page).joint); }
Span Batch::rotations(uint32_t page) const { return spanOf(impl_->pageAt(page).rotation); }
Span Batch::reports(uint32_t page) const { return spanOf(impl_->pageAt(page).report); }

void Batch::use(const Buffers& buffers) {
  Impl& batch = *impl_;
  if (batch.pages.size() != 1)
    throw inputError(
        fmt::format("{} chains take {} pages; buffers can be given to a batch of one ({} chains)",
                    batch.chains, batch.pages.size(), batch.pageChains));
  const uint64_t n = batch.bones, each = uint64_t{16} * batch.chains;
  const struct {
    Span span;
    uint64_t bytes;
    const char* name;
  } wanted[] = {{buffers.targets, each, "targets"},
                {buffers.bases, each * shared::BASE_STRIDE, "bases"},
                {buffers.joints, each * n, "joints"},
                {buffers.rotations, each * n, "rotations"},
                {buffers.reports, each, "reports"}};
  for (size_t use = 0; use < std::size(wanted); ++use) {
    const auto& [span, bytes, name] = wanted[use];
    if (!span.buffer) {
      batch.given[use] = {};
      continue;
    }
    if (span.bytes < bytes)
      throw inputError(fmt::format("the buffer for {} has {} bytes, {} chains need {}", name, span.bytes,
                                   batch.chains, bytes));
    batch.given[use] = gpu::Buffer::borrowed(*batch.context, span.buffer, bytes, name);
  }
  batch.context->waitIdle();
  batch.bind(batch.pages.front());
}

}  // namespace skitter::ik
