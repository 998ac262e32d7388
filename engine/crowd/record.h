#pragma once

#include <optional>

#include "skitter/controller.h"
#include "skitter/records.h"

// What follows from the table of records (skitter/records.h), as plain data.
namespace skitter::crowd {

enum class Per { agent, leg, watched };
enum class Kept { always, bound, hurt, exchanged };

struct RecordInfo {
  const char* name;
  uint32_t binding;  // where a stage reads it; it writes it at the next
  Per per;
  Kept kept;
  bool spawned;
};
constexpr RecordInfo infoOf(Record record) {
  switch (record) {
#define SKITTER_RECORD(NAME, name, binding, per, stride, kept, spawned, hashed) \
  case Record::name:                                                            \
    return {#name, binding, Per::per, Kept::kept, spawned};
    SKITTER_RECORDS(SKITTER_RECORD)
#undef SKITTER_RECORD
  }
  return {};
}

// vec4 of a record where the herd has so many legs, bones in its longest leg, and joints in its clips'
// palette.
constexpr int strideOf(Record record, int legs, int bones, int joints) {
  using namespace shared;
  switch (record) {
#define SKITTER_RECORD(NAME, name, binding, per, stride, kept, spawned, hashed) \
  case Record::name:                                                            \
    return stride;
    SKITTER_RECORDS(SKITTER_RECORD)
#undef SKITTER_RECORD
  }
  return 0;
}

// Whether the next tick of a herd depends on it.
constexpr bool isHashed(Record record, Controller controller) {
  switch (record) {
#define SKITTER_RECORD(NAME, name, binding, per, stride, kept, spawned, hashed) \
  case Record::name:                                                            \
    return hashed;
    SKITTER_RECORDS(SKITTER_RECORD)
#undef SKITTER_RECORD
  }
  return false;
}

// The record that a stage reads or writes at that binding; none where something else is bound.
constexpr std::optional<Record> recordAt(uint32_t binding) {
  for (const Record record : allRecords) {
    const uint32_t first = infoOf(record).binding;
    if (binding == first || binding == first + 1) return record;
  }
  return {};
}
constexpr bool isWritten(uint32_t binding) {
  const std::optional<Record> record = recordAt(binding);
  return record && binding != infoOf(*record).binding;
}

}  // namespace skitter::crowd
