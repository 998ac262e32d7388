#include "skitter/version.h"

namespace skitter {

const char* version() { return SKITTER_VERSION; }

}  // namespace skitter
