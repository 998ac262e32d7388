#include "bench/crowd/operations.h"

#include <spirv/unified1/GLSL.std.450.h>
#include <cstring>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>
#include <spirv/unified1/spirv.hpp11>
#include <unordered_map>

#include "skitter/error.h"

namespace skitter::bench {
namespace {

using Words = std::vector<uint32_t>;
constexpr size_t headerWords = 5;

// The passes unroll only loops that ask for it.
void askForUnrolling(Words& module) {
  for (size_t at = headerWords; at < module.size(); at += module[at] >> 16)
    if (spv::Op(module[at] & 0xffff) == spv::Op::OpLoopMerge)
      module[at + 3] = uint32_t(spv::LoopControlMask::Unroll);
}

Words specialised(Words module, const std::vector<gpu::SpecConstant>& constants) {
  std::unordered_map<uint32_t, Words> values;
  for (const gpu::SpecConstant& constant : constants) values[constant.id] = {constant.bits};
  askForUnrolling(module);
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
      .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
      .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
      .RegisterPass(spvtools::CreateCCPPass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateLoopUnrollPass(true))
      .RegisterPass(spvtools::CreateCCPPass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateSimplificationPass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass());
  Words result;
  if (!optimizer.Run(module.data(), module.size(), &result))
    throw Error(Error::Kind::check, "operations of a kernel: its SPIR-V cannot be specialised");
  return result;
}

class Counter {
 public:
  double count(const Words& module) {
    double sum = 0;
    for (size_t at = headerWords; at < module.size(); at += module[at] >> 16) sum += instruction(&module[at]);
    return sum;
  }

 private:
  double instruction(const uint32_t* word) {
    using spv::Op;
    const Op op = Op(word[0] & 0xffff);
    const auto components = [&] { return components_[word[1]]; };
    const auto columns = [&](uint32_t id) { return columns_[typeOf_[id]]; };
    const auto size = [&](uint32_t id) { return components_[typeOf_[id]]; };
    switch (op) {
      case Op::OpTypeFloat:
        components_[word[1]] = 1;
        return 0;
      case Op::OpTypeVector:
        components_[word[1]] = components_[word[2]] * word[3];
        return 0;
      case Op::OpTypeMatrix:
        components_[word[1]] = components_[word[2]] * word[3];
        columns_[word[1]] = word[3];
        return 0;
      case Op::OpFAdd:
      case Op::OpFSub:
      case Op::OpFMul:
      case Op::OpFDiv:
      case Op::OpFRem:
      case Op::OpFMod:
      case Op::OpVectorTimesScalar:
      case Op::OpMatrixTimesScalar:
        return define(word), components();
      case Op::OpDot:
        return define(word), 2 * size(word[3]) - 1;
      case Op::OpMatrixTimesVector:
        return define(word), components() * (2 * columns(word[3]) - 1);
      case Op::OpVectorTimesMatrix:
        return define(word), components() * (2 * size(word[3]) - 1);
      case Op::OpMatrixTimesMatrix:
        return define(word), components() * (2 * columns(word[3]) - 1);
      case Op::OpExtInst:
        return define(word), function(word[4], components(), size(word[5]));
      default:
        break;
    }
    // Whatever else has a type and a result may be an operand.
    if (const uint32_t length = word[0] >> 16; length > 2 && components_.count(word[1]) > 0) define(word);
    return 0;
  }

  static double function(uint32_t name, double components, double operand) {
    switch (name) {
      case GLSLstd450FAbs:
      case GLSLstd450FSign:
      case GLSLstd450PackHalf2x16:
      case GLSLstd450UnpackHalf2x16:
      case GLSLstd450FindILsb:
      case GLSLstd450FindUMsb:
      case GLSLstd450FindSMsb:
        return 0;
      case GLSLstd450FClamp:
      case GLSLstd450NClamp:
      case GLSLstd450Fma:
        return 2 * components;
      case GLSLstd450FMix:
        return 3 * components;
      case GLSLstd450Length:
        return 2 * operand;
      case GLSLstd450Distance:
        return 3 * operand;
      case GLSLstd450Normalize:
        return 3 * operand;
      case GLSLstd450Cross:
        return 9;
      default:
        return components;
    }
  }

  void define(const uint32_t* word) { typeOf_[word[2]] = word[1]; }

  std::unordered_map<uint32_t, double> components_, columns_;  // by type
  std::unordered_map<uint32_t, uint32_t> typeOf_;              // by result
};

}  // namespace

double operationsAnInvocation(std::span<const uint8_t> spirv,
                              const std::vector<gpu::SpecConstant>& constants) {
  Words module(spirv.size() / sizeof(uint32_t));
  std::memcpy(module.data(), spirv.data(), module.size() * sizeof(uint32_t));
  return Counter().count(specialised(std::move(module), constants));
}

}  // namespace skitter::bench
