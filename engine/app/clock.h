#pragma once

namespace skitter::app {

// CPU time of this process so far, of all its threads: a software device's are among them.
double processSeconds();

}  // namespace skitter::app
