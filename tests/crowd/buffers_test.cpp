// What a host may read by itself, held against what it can download.
#include "skitter/buffers.h"

#include <cstring>

#include "crowd/simulation.h"
#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/submit.h"
#include "skitter/decode.h"
#include "validation/convert.h"

extern "C" {
// tests/crowd/records_in_c.c
int legRecordInC(int agent, int leg, int legs);
float tileXInC(float tile);
float tileZInC(float tile);
float ticksInC(float packed);
float tileOfTicksInC(float packed);
float tilesApartInC(float step, float body);
int stridesInC(int bones);
}

namespace skitter::test {
namespace {

class BuffersTest : public GpuTest {
 protected:
  // The herd's records, copied by the host's own commands right after a tick, without a barrier of its own.
  std::vector<std::vector<float>> copied(Crowd& crowd, uint32_t herd) {
    std::vector<std::vector<RecordBuffer>> buffers;
    uint64_t bytes = 0;
    for (const Record record : allRecords)
      for (const RecordBuffer& each : buffers.emplace_back(crowd.buffers(herd, record))) bytes += each.bytes;
    const gpu::HostBuffer host(context(), bytes, gpu::HostUse::readback, "copy");
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      crowd.record(cmd, kTick);
      uint64_t end = 0;
      for (const auto& ofRecord : buffers)
        for (const RecordBuffer& each : ofRecord) {
          cmd.copyBuffer(each.buffer, host.handle(), vk::BufferCopy{each.offset, end, each.bytes});
          end += each.bytes;
        }
      // Nothing between the copies and the next tick, either.
      crowd.record(cmd, kTick);
      gpu::transferToHost(cmd);
    });
    std::vector<std::vector<float>> records;
    const float* floats = host.as<float>().data();
    for (const auto& ofRecord : buffers) {
      std::vector<float>& mine = records.emplace_back();
      for (const RecordBuffer& each : ofRecord) {
        for (uint32_t agent = each.firstAgent; agent < each.firstAgent + each.agents; ++agent)
          for (uint32_t leg = 0; leg < std::max(1u, each.legs); ++leg) {
            const float* from = floats + 4 * each.recordAt(agent, leg) - each.offset / 4;
            mine.insert(mine.end(), from, from + 4 * size_t{each.stride});
          }
        floats += each.bytes / 4;
      }
    }
    return records;
  }
};

TEST_F(BuffersTest, HoldWhatIsDownloaded) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    Scene scene = sceneOf(5, 1, 1, controller);
    scene.herds.resize(4, scene.herds[0]);
    scene.herds[1].agents = 0;
    scene.herds[2].agents = 61;
    scene.herds[2].sizes = {0.5f, 1};
    scene.herds[3].controller = controller == Controller::loop ? Controller::adaptive : Controller::loop;
    const CrowdOptions options{.feet = true, .footfalls = 10, .pageAgents = 24};
    Crowd crowd(device(), rollingGround(), scene, options), same(device(), rollingGround(), scene, options);
    simulate(device(), crowd, 20);
    simulate(device(), same, 20);
    for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd) {
      const std::vector<std::vector<float>> records = copied(crowd, herd);
      simulate(device(), same, 1);
      const HerdState state = same.download(herd);
      for (const Record record : allRecords)
        if (record != Record::watch) {
          EXPECT_EQ(records[static_cast<size_t>(record)], state.of(record)) << herd;
        }
      EXPECT_TRUE(crowd.buffers(herd, Record::watch).empty());
      simulate(device(), same, 1);
    }
    EXPECT_EQ(crowd.stateHash(), same.stateHash());
  }
}

TEST_F(BuffersTest, NoneOfWhatIsNotKept) {
  const Crowd crowd(device(), rollingGround(), sceneOf(3), CrowdOptions{.pose = false, .measure = false});
  EXPECT_TRUE(crowd.buffers(0, Record::pose).empty());
  EXPECT_TRUE(crowd.buffers(0, Record::play).empty());
  EXPECT_EQ(crowd.buffers(0, Record::body).size(), 1u);
}

// Far from the world's origin, where a float32 is coarse.
TEST_F(BuffersTest, DecodeAsTheReferenceReads) {
  const Heightfield wide = generateHeightfield({.columns = 129, .rows = 129, .spacing = 62});
  Scene scene = sceneOf(16, 2);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .centre = {-3890, 3901}, .heading = 2};
  Crowd crowd(device(), wide, scene, CrowdOptions{.feet = true});
  simulate(device(), crowd, 50);
  const HerdState state = crowd.download(0);
  const auto legs = static_cast<size_t>(crowd.rig(0).legCount());
  const auto recordOf = [](const std::vector<float>& records, size_t i, int stride) {
    const auto floats = 4 * static_cast<size_t>(stride);
    return std::span(records).subspan(i * floats, floats);
  };
  const glm::dvec3 origin(-3889.125, 5.5, 3899.75);
  size_t planted = 0;
  for (size_t agent = 0; agent < 16; ++agent) {
    const auto record = recordOf(state.body, agent, shared::BODY_STRIDE);
    const BodyState body = bodyOf(record, origin);
    const reference::AgentBody truth = validation::bodyOf(state, agent);
    const glm::dvec3 position =
        glm::dvec3(16 * truth.tileX + truth.localX, truth.y, 16 * truth.tileZ + truth.localZ) - origin;
    EXPECT_LT(glm::distance(body.position, position), 1e-9);
    EXPECT_LT(glm::distance(bodyOf(record).position, position + origin), 1e-9);
    EXPECT_EQ(glm::dquat(body.rotation), truth.orientation);
    EXPECT_LT(glm::distance(glm::dvec2(body.velocity.x, body.velocity.z), truth.speed * truth.heading), 1e-6);
    EXPECT_EQ(body.turnRate, truth.turnRate);
    for (size_t leg = agent * legs; leg < (agent + 1) * legs; ++leg) {
      const reference::Step step = validation::stepOf(state, leg);
      const StepState decoded = stepOf(recordOf(state.step, leg, shared::STEP_STRIDE), record, origin);
      const glm::dvec3 tile(16 * step.tileX, 0, 16 * step.tileZ);
      EXPECT_LT(glm::distance(decoded.landing, tile + step.landing - origin), 1e-9);
      EXPECT_LT(glm::distance(decoded.liftOff, tile + step.liftOff - origin), 1e-9);
      EXPECT_EQ(decoded.firstTick, step.firstTick);
      EXPECT_EQ(decoded.ticks, std::abs(step.duration));
      EXPECT_EQ(decoded.lastResort, step.duration < 0);

      const reference::Foot foot = validation::footOf(state, leg);
      const FootState aimed = footOf(recordOf(state.foot, leg, shared::FOOT_STRIDE), body);
      EXPECT_LT(glm::distance(aimed.place, position + foot.target), 1e-9);
      EXPECT_EQ(aimed.progress, foot.progress);
      EXPECT_EQ(aimed.planted(), foot.progress == 1);
      if (!aimed.planted()) continue;
      // A foot stands where it landed.
      EXPECT_LT(glm::distance(aimed.place, decoded.landing), 4e-6);
      ++planted;

      const reference::Chain chain = validation::chainOf(state, leg, crowd.rig(0).maxBones());
      const TipState tip = tipOf(recordOf(state.tip, leg, shared::TIP_STRIDE), body);
      EXPECT_LT(glm::distance(tip.place, position + chain.tip), 1e-9);
      EXPECT_EQ(tip.error, chain.reachError);
    }
    const auto entries = static_cast<uint32_t>(crowd.rig(0).paletteSize());
    const auto pose = recordOf(state.pose, agent, static_cast<int>(entries) * shared::POSE_STRIDE);
    for (uint32_t entry = 0; entry < entries; ++entry) {
      const reference::BonePose bone = validation::boneOf(state, agent * entries + entry);
      EXPECT_EQ(glm::dquat(bonePoseOf(pose, entry).rotation), bone.rotation);
      EXPECT_EQ(glm::dvec3(bonePoseOf(pose, entry).position), bone.position);
    }
  }
  EXPECT_GT(planted, 60u);
}

TEST(RecordsInC, AreThoseOfCpp) {
  for (int agent = 0; agent < 20; ++agent)
    for (int leg = 0; leg < 6; ++leg)
      EXPECT_EQ(legRecordInC(agent, leg, 6), shared::legRecord(agent, leg, 6));
  for (const float x : {-2048.0f, -7.0f, 0.0f, 2047.0f})
    for (const float z : {-2048.0f, -1.0f, 5.0f, 2047.0f}) {
      EXPECT_EQ(tileXInC(shared::packedTile(x, z)), x);
      EXPECT_EQ(tileZInC(shared::packedTile(x, z)), z);
      EXPECT_EQ(tilesApartInC(shared::stepTile(x, z), 3), shared::tilesApart(shared::stepTile(x, z), 3));
      for (const float ticks : {1.0f, -9.0f, 16383.0f}) {
        const float packed = shared::packedTicks(ticks, shared::stepTile(x, z));
        EXPECT_EQ(ticksInC(packed), std::abs(ticks));
        EXPECT_EQ(tileOfTicksInC(packed), shared::stepTile(x, z));
      }
    }
  EXPECT_EQ(stridesInC(5), shared::BODY_STRIDE + 100 * shared::chainStride(5) +
                               10000 * shared::poseStride(8, 5, 0) + 1000000 * shared::FOOTFALL_STRIDE);
}

}  // namespace
}  // namespace skitter::test
